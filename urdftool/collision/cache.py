"""Results kept for the next time, by what they were made of: the file's bytes and the settings.

Several processes may use one folder: an entry is written beside its place and moved there whole,
carries a digest of itself, and one that is damaged counts as absent.
"""

from __future__ import annotations

import json
import os
from hashlib import sha256
from pathlib import Path

from .compute import Result, Task, result_of

_VERSION = 1
"""To be raised whenever the same settings give another result."""

_HEAD = 65


class Cache:
    """A folder of results.

    Attributes:
        folder: Where they are; None keeps nothing.
        trouble: Why the last result could not be kept; empty where it was.
    """

    def __init__(self, folder: str | Path | None) -> None:
        """Take the folder, which need not exist."""
        self.folder = None if folder is None else Path(folder)
        self.trouble = ""

    def read(self, key: str) -> Result | None:
        """What is known of a task."""
        if self.folder is None:
            return None
        try:
            data = self._place(key).read_bytes()
            if data[: _HEAD - 1] != sha256(data[_HEAD:]).hexdigest().encode():
                return None
            return result_of(data[_HEAD:], cached=True)
        except (OSError, ValueError):
            return None

    def write(self, key: str, data: bytes) -> None:
        """Keep a result; where that is not possible, go on without."""
        if self.folder is None:
            return
        place = self._place(key)
        neighbour = place.with_name(f".{key}.{os.getpid()}.tmp")
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            with open(neighbour, "wb") as stream:
                stream.write(sha256(data).hexdigest().encode() + b"\n" + data)
            os.replace(neighbour, place)
        except OSError as error:
            self.trouble = error.strerror or str(error)
        finally:
            try:
                neighbour.unlink(missing_ok=True)
            except OSError as error:
                self.trouble = error.strerror or str(error)

    def _place(self, key: str) -> Path:
        assert self.folder is not None
        return self.folder / key[:2] / key


def default_folder() -> Path:
    """Where results are kept unless the user names a folder."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(base) / "urdftool" / "collision"


def key_of(task: Task) -> str | None:
    """What a task's result hangs on, in one word; None where its file cannot be read."""
    facts = [_VERSION, task.path.suffix.lower(), list(task.scale), task.settings.as_dict()]
    digest = sha256(json.dumps(facts, sort_keys=True).encode())
    try:
        digest.update(task.path.read_bytes())
        if task.path.suffix.lower() == ".gltf":  # its buffers are files beside it
            for path in sorted(task.path.parent.glob("*.bin")):
                digest.update(path.name.encode() + b"\0" + path.read_bytes())
    except OSError:
        return None
    return digest.hexdigest()
