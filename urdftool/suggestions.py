"""Suggestions for mistyped names, and errors for values that are not allowed."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable
from functools import lru_cache
from numbers import Real

from .errors import ConfigError

_NUMBER = re.compile(r"([0-9]+)")


MAX_COMPARISONS = 200_000
"""Number of comparisons with the same candidates, about 2 s; later names get no suggestion."""


def find_nearest(name: str, known: Iterable[str], cutoff: float = 0.7) -> str:
    """Return the known name nearest to an unknown one; empty if none is near.

    Names that differ only in case, ``_`` and ``-`` are nearest. Names that differ only by a number
    are not near: ``joint_1`` is not a typo of ``joint_2``.

    Args:
        name: The unknown name.
        known: Candidates.
        cutoff: Least similarity, 0 to 1, of ``difflib.get_close_matches``.
    """
    return _find_nearest(name, tuple(dict.fromkeys(known)), cutoff)


@lru_cache(4096)  # robots of one family have the same typos
def _find_nearest(name: str, known: tuple[str, ...], cutoff: float) -> str:
    return _get_candidates(known).find_nearest(name, cutoff)


@lru_cache(64)
def _get_candidates(known: tuple[str, ...]) -> _Candidates:
    return _Candidates(known)


class _Candidates:
    """Known names, compared with unknown ones at most :data:`MAX_COMPARISONS` times."""

    def __init__(self, known: tuple[str, ...]) -> None:
        self._names = [name for name in known if name]
        self._by_folded: dict[str, list[str]] = {}
        for name in self._names:
            self._by_folded.setdefault(fold(name), []).append(name)
        self._comparisons = 0

    def find_nearest(self, name: str, cutoff: float) -> str:
        from difflib import get_close_matches

        folded = fold(name)
        for other in self._by_folded.get(folded, ()):
            if other != name:
                return other
        self._comparisons += len(self._names)
        if self._comparisons > MAX_COMPARISONS:
            return ""
        names = [
            other
            for other in self._names
            if other != name and not _is_numbered_alike(folded, fold(other))
        ]
        near = get_close_matches(name, names, 1, cutoff)
        return near[0] if near else ""


def _is_numbered_alike(name: str, other: str) -> bool:
    """Tell whether two names differ only by the numbers in them."""
    texts, others = _NUMBER.split(name), _NUMBER.split(other)
    if texts[::2] != others[::2]:
        return False
    return [text.lstrip("0") for text in texts[1::2]] != [text.lstrip("0") for text in others[1::2]]


def suggest_name(name: str, known: Iterable[str], cutoff: float = 0.7) -> str:
    """Return ``; did you mean 'x'?`` with the nearest known name; empty if none is near."""
    near = find_nearest(name, known, cutoff)
    return f"; did you mean '{near}'?" if near else ""


def require_word(name: str, value: object, words: Collection[str]) -> None:
    """Raise ConfigError if the value of an option is not one of the allowed words."""
    if value not in words:
        hint = suggest_name(str(value), words)
        raise ConfigError(f"{name} is {value!r}, which is not one of {', '.join(words)}{hint}")


def require_positive(name: str, value: object) -> None:
    """Raise ConfigError if the value of an option is not a finite number above zero."""
    if not (isinstance(value, int | float) and 0 < value < math.inf):
        raise ConfigError(f"{name} is {value!r}, which is not a finite number above zero")


def require_number(
    name: str, value: object, least: float = -math.inf, most: float = math.inf
) -> None:
    """Raise ConfigError if the value of an option is not a finite number of a range."""
    if isinstance(value, Real) and math.isfinite(value) and least <= float(value) <= most:
        return
    bounds = "" if least == -math.inf else f" of at least {least:g}"
    if most < math.inf:
        bounds = f" from {least:g} to {most:g}"
    raise ConfigError(f"{name} is {value!r}, which is not a finite number{bounds}")


def fold(name: str) -> str:
    """Return a name without case, ``_`` and ``-``."""
    return name.replace("_", "").replace("-", "").lower()
