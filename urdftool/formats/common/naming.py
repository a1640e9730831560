"""Unique names, and names that are valid in file names."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator
from itertools import chain, count


def list_numbered_names(stem: str, first: int = 2, suffix: str = "") -> Iterator[str]:
    """Yield a name with increasing numbers from ``first``: ``arm_2``, ``arm_3``."""
    for number in count(first):
        yield f"{stem}_{number}{suffix}"


def get_first_free(candidates: Iterable[str], taken: Container[str | None]) -> str:
    """Return the first candidate that is not taken."""
    return next(name for name in candidates if name not in taken)


def get_free_name(name: str, taken: Container[str | None]) -> str:
    """Return a name that is not taken: the name itself, or with the least number from 2."""
    return get_first_free(chain((name,), list_numbered_names(name)), taken)


class UniqueNames:
    """Set of the names of a kind that are taken."""

    def __init__(self, taken: Iterable[str] = (), *, fold: bool = False) -> None:
        """Start with taken names; ``fold`` ignores case, as some file systems do."""
        self._fold = fold
        self._taken = {self._format_key(name) for name in taken}
        self._free: dict[str, int] = {}  # least number that may be free, by stem

    def __contains__(self, name: object) -> bool:
        """Return whether a name is taken."""
        return self._format_key(str(name)) in self._taken

    def _format_key(self, name: str) -> str:
        return name.casefold() if self._fold else name

    def take(self, *candidates: str) -> str:
        """Take the first candidate that is free, or the last one with the least number from 1."""
        names = [name for name in candidates if name]
        stem = names[-1] if names else "unnamed"
        name = next((name for name in names if name not in self), "")
        if not name:
            number = self._free.get(stem, 1)
            while (name := f"{stem}_{number}") in self:
                number += 1
            self._free[stem] = number + 1
        self._taken.add(self._format_key(name))
        return name


_LONGEST = 200
"""Largest number of bytes of a file's name without its ending. File systems allow 255 with the
ending and that of a temporary file; chosen below it, no source."""


def shorten_file_name(name: str) -> str:
    """Return the beginning of a name that file systems accept."""
    return name.encode("utf-8", "replace")[:_LONGEST].decode("utf-8", "ignore")


def replace_file_name(text: str) -> str:
    """Replace characters other than letters, digits, dots, dashes and underscores in a name."""
    return re.sub(r"[^\w.-]+", "_", text).strip("._-") or "unnamed"
