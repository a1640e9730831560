"""Counts with nouns."""

from __future__ import annotations


def format_count(count: int, one: str, many: str = "") -> str:
    """Format a count, such as ``1 file`` or ``2 files``; ``many`` is an irregular plural."""
    return f"{count} {one if count == 1 else many or one + 's'}"
