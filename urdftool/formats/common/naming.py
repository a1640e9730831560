"""Unique names of a kind, and names that may stand in a file's."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator
from itertools import chain, count


def numbered(stem: str, first: int = 2, suffix: str = "") -> Iterator[str]:
    """Yield a name with each number from ``first`` on: ``arm_2``, ``arm_3``."""
    for number in count(first):
        yield f"{stem}_{number}{suffix}"


def first_free(candidates: Iterable[str], taken: Container[str | None]) -> str:
    """Return the first of some names that is not taken."""
    return next(name for name in candidates if name not in taken)


def free_name(name: str, taken: Container[str | None]) -> str:
    """Return a name that is not taken: itself, or itself with the least number from 2 on."""
    return first_free(chain((name,), numbered(name)), taken)


class UniqueNames:
    """The names of a kind that are taken."""

    def __init__(self, taken: Iterable[str] = (), *, fold: bool = False) -> None:
        """Start with the names that are taken.

        Args:
            taken: Names that nothing else may have.
            fold: Whether case makes no difference, as in some file systems.
        """
        self._fold = fold
        self._taken = {self._key(name) for name in taken}

    def __contains__(self, name: object) -> bool:
        """Return whether a name is taken."""
        return self._key(str(name)) in self._taken

    def _key(self, name: str) -> str:
        return name.casefold() if self._fold else name

    def take(self, *candidates: str) -> str:
        """Take the first candidate that is free, or the last one with the least number from 1."""
        names = [name for name in candidates if name]
        stem = names[-1] if names else "unnamed"
        name = first_free(chain(names, numbered(stem, 1)), self)
        self._taken.add(self._key(name))
        return name


def file_name(text: str) -> str:
    """Return a name with letters, digits, dots, dashes and underscores alone."""
    return re.sub(r"[^\w.-]+", "_", text).strip("._-") or "unnamed"
