"""Results kept for the next time, by what they were made of: the file's bytes and the settings."""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path

from ..store import Store, cache_folder
from .compute import Result, Task, result_of

_VERSION = 9
"""To be raised whenever the same settings give another result."""


class Cache(Store):
    """A folder of results; None keeps nothing."""

    def read(self, key: str) -> Result | None:
        """What is known of a task."""
        data = self.get(key)
        try:
            return None if data is None else result_of(data, cached=True)
        except ValueError:
            return None

    def write(self, key: str, data: bytes) -> None:
        """Keep a result; where that is not possible, go on without."""
        self.put(key, data)


def default_folder() -> Path:
    """Where results are kept unless the user names a folder."""
    return cache_folder("collision")


def key_of(task: Task) -> str | None:
    """What a task's result hangs on, in one word; None where its file cannot be read."""
    facts = [_VERSION, task.path.suffix.lower(), list(task.scale), task.settings.as_dict()]
    if task.path.suffix.lower() in (".gltf", ".glb"):
        facts.append(task.gltf_up)
    digest = sha256(json.dumps(facts, sort_keys=True).encode())
    try:
        digest.update(task.path.read_bytes())
        if task.path.suffix.lower() == ".gltf":  # its buffers are files beside it
            for path in sorted(task.path.parent.glob("*.bin")):
                digest.update(path.name.encode() + b"\0" + path.read_bytes())
    except OSError:
        return None
    return digest.hexdigest()
