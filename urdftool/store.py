"""Results kept for the next time, a file each, in a folder that several processes may use.

An entry is written beside its place and moved there whole, and carries a digest of itself; one that
is damaged counts as absent. Where nothing can be written, work goes on without.
"""

from __future__ import annotations

import os
import sys
import time
from hashlib import sha256
from pathlib import Path

_HEAD = 65
_DAY = 24 * 3600.0


class Store:
    """A folder of entries by key.

    Attributes:
        folder: Where they are; None keeps nothing.
        trouble: Why the last entry could not be kept; empty where it was.
    """

    def __init__(self, folder: str | Path | None) -> None:
        """Take the folder, which need not exist."""
        self.folder = None if folder is None else str(folder)
        self.trouble = ""

    def get(self, key: str) -> bytes | None:
        """The bytes of an entry; None where it is absent or damaged."""
        if self.folder is None:
            return None
        try:
            with open(self._place(key), "rb") as stream:
                data = stream.read()
        except OSError:
            return None
        if data[: _HEAD - 1] != sha256(data[_HEAD:]).hexdigest().encode():
            return None
        return data[_HEAD:]

    def put(self, key: str, data: bytes) -> None:
        """Keep an entry, if that is possible."""
        if self.folder is None:
            return
        place = self._place(key)
        folder, name = os.path.split(place)
        neighbour = os.path.join(folder, f".{name}.{os.getpid()}.tmp")
        try:
            os.makedirs(folder, exist_ok=True)
            with open(neighbour, "wb") as stream:
                stream.write(sha256(data).hexdigest().encode() + b"\n" + data)
            os.replace(neighbour, place)
        except OSError as error:
            self.trouble = error.strerror or str(error)
        finally:
            try:
                Path(neighbour).unlink(missing_ok=True)
            except OSError as error:
                self.trouble = error.strerror or str(error)

    def trim(self, *, days: float, most: int) -> int:
        """Remove entries that nobody has read or written for long, and the oldest of too many.

        It is done once a day, however often it is asked for.

        Args:
            days: How old an entry may be.
            most: How many bytes all of them may have.

        Returns:
            How many were removed.
        """
        if self.folder is None:
            return 0
        mark = os.path.join(self.folder, "trimmed")
        now = time.time()
        try:
            if os.path.exists(mark) and now - os.stat(mark).st_mtime < _DAY:
                return 0
            with open(mark, "wb"):
                os.utime(mark)
        except OSError:
            return 0
        return self._remove(now - days * _DAY, most)

    def _remove(self, oldest: float, most: int) -> int:
        entries = []
        assert self.folder is not None
        for where, _, names in os.walk(self.folder):
            for name in names:
                path = os.path.join(where, name)
                try:
                    status = os.stat(path)
                except OSError:
                    continue
                if name != "trimmed":
                    entries.append((max(status.st_mtime, status.st_atime), status.st_size, path))
        removed = size = 0
        for used, length, path in sorted(entries, reverse=True):
            size += length
            if used < oldest or size > most:
                try:
                    os.unlink(path)
                    removed += 1
                except OSError:
                    continue
        return removed

    def _place(self, key: str) -> str:
        assert self.folder is not None
        return os.path.join(self.folder, key[:2], key)


def cache_folder(room: str) -> Path:
    """Where a room keeps results unless the user names a folder, as the platform has it.

    ``XDG_CACHE_HOME`` counts everywhere; without it ``~/.cache``, on macOS ``~/Library/Caches``, on
    Windows ``%LOCALAPPDATA%``.
    """
    base = os.environ.get("XDG_CACHE_HOME")
    if not base and sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA")
    if not base:
        base = os.path.expanduser("~/Library/Caches" if sys.platform == "darwin" else "~/.cache")
    return Path(base, "urdftool", room)
