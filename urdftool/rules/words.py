"""Format lists for messages."""

from __future__ import annotations

from collections.abc import Iterable

from ..suggestions import find_nearest as find_nearest
from ..suggestions import fold as fold
from ..suggestions import suggest_name as suggest_name


def quote(names: Iterable[str], most: int = 4) -> str:
    """Format names as ``'a', 'b' and 'c'``; above ``most``, the first and the number of others."""
    words = [f"'{name}'" for name in names]
    if len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} others"]
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""


def join_some(items: list[str], kind: str, most: int = 12) -> str:
    """Join items with commas; above ``most``, the first ones and the number of others."""
    if len(items) <= most + 1:
        return ", ".join(items)
    return f"{', '.join(items[:most])} and {len(items) - most} more {kind}"


def split_words(text: str) -> frozenset[str]:
    """Split a text into a set of words, for tables."""
    return frozenset(text.split())
