"""Lists of names in a sentence: the first ones, and how many more there are."""

from __future__ import annotations

from collections.abc import Sequence


def list_first(items: Sequence[str], most: int) -> str:
    """Return items as ``a, b and 7 more``."""
    shown = ", ".join(items[:most])
    return f"{shown} and {len(items) - most} more" if len(items) > most else shown


def quote_first(names: Sequence[str], most: int) -> str:
    """Return names as ``'a', 'b' and 7 more``."""
    return list_first([f"'{name}'" for name in names], most)
