"""Numbers of things, in words."""

from __future__ import annotations


def counted(count: int, one: str, many: str = "") -> str:
    """``1 file``, ``2 files``; ``many`` is for words that do not just take an s."""
    return f"{count} {one if count == 1 else many or one + 's'}"
