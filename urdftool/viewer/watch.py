"""Detection of file changes."""

from __future__ import annotations

import os
from collections.abc import Iterable

State = tuple[int, int, int] | None


class Watch:
    """A set of watched files, some of which may not exist.

    Editors write a file in several steps, so a change is reported once two consecutive checks see
    the same state.
    """

    def __init__(self, paths: Iterable[str | os.PathLike[str]] = ()) -> None:
        """Record the current state of the files."""
        self._seen: dict[str, State] = {}
        self._moving: dict[str, State] | None = None
        self.take(paths)

    @property
    def paths(self) -> tuple[str, ...]:
        """Return the watched files."""
        return tuple(self._seen)

    def take(self, paths: Iterable[str | os.PathLike[str]]) -> None:
        """Watch these files from now on.

        A file that was watched already keeps its recorded state, so that a write during reading
        counts as a change.
        """
        watched = {os.path.abspath(path) for path in paths}
        self._seen = {
            path: self._seen[path] if path in self._seen else _state(path)
            for path in sorted(watched)
        }
        self._moving = None

    def find_changes(self) -> list[str]:
        """Return the files that have changed and come to rest, each change once."""
        now = {path: _state(path) for path in self._seen}
        if now == self._seen:
            self._moving = None
            return []
        if now != self._moving:
            self._moving = now
            return []
        different = [path for path, state in now.items() if state != self._seen[path]]
        self._seen, self._moving = now, None
        return different


def _state(path: str) -> State:
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
