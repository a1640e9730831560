"""Names that MuJoCo takes: one of a kind, and good for a file where they name one."""

from __future__ import annotations

import re
from collections.abc import Iterator


class Names:
    """Names of one kind that are taken."""

    def __init__(self, taken: Iterator[str] | tuple[str, ...] = (), *, fold: bool = False) -> None:
        """Start with what is taken.

        Args:
            taken: Names that nothing else may have.
            fold: Whether case makes no difference, as in some file systems.
        """
        self._fold = fold
        self._taken = {self._key(name) for name in taken}

    def _key(self, name: str) -> str:
        return name.casefold() if self._fold else name

    def take(self, *candidates: str) -> str:
        """The first candidate that is free, or the last one with a number; it is taken now."""
        for name in candidates:
            if name and self._key(name) not in self._taken:
                self._taken.add(self._key(name))
                return name
        stem = next((name for name in reversed(candidates) if name), "unnamed")
        number = 1
        while self._key(f"{stem}_{number}") in self._taken:
            number += 1
        return self.take(f"{stem}_{number}")


def file_name(text: str) -> str:
    """A name as it may stand in a file's: letters, digits, dots, dashes and underscores."""
    return re.sub(r"[^\w.-]+", "_", text).strip("._-") or "unnamed"
