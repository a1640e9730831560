"""Suggestions for mistyped names."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

_NUMBER = re.compile(r"([0-9]+)")


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
    from difflib import get_close_matches

    names = [other for other in known if other and other != name]
    folded = fold(name)
    for other in names:
        if fold(other) == folded:
            return other
    names = [other for other in names if not _is_numbered_alike(folded, fold(other))]
    near = get_close_matches(name, names, 1, cutoff)
    return near[0] if near else ""


def _is_numbered_alike(name: str, other: str) -> bool:
    """Tell whether two names differ only by the numbers in them."""
    texts, others = _NUMBER.split(name), _NUMBER.split(other)
    if texts[::2] != others[::2]:
        return False
    return [int(text) for text in texts[1::2]] != [int(text) for text in others[1::2]]


def suggest_name(name: str, known: Iterable[str], cutoff: float = 0.7) -> str:
    """Return ``; did you mean 'x'?`` with the nearest known name; empty if none is near."""
    near = find_nearest(name, known, cutoff)
    return f"; did you mean '{near}'?" if near else ""


def fold(name: str) -> str:
    """Return a name without case, ``_`` and ``-``."""
    return name.replace("_", "").replace("-", "").lower()
