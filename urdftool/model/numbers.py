"""Numbers in URDF syntax, and values of settings as text."""

from __future__ import annotations

import math


def number(text: str | None) -> float | None:
    """Return a finite number in URDF syntax, or None."""
    if text is None:
        return None
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) and "_" not in text else None


def parse_numbers(text: str | None, count: int) -> tuple[float, ...] | None:
    """Return exactly ``count`` finite numbers separated by whitespace, or None."""
    if text is None:
        return None
    words = text.split()
    if len(words) != count:
        return None
    try:
        values = tuple(map(float, words))
    except ValueError:
        return None
    return values if all(map(math.isfinite, values)) and "_" not in text else None


def describe_content(content: bool | str | float | tuple[float, ...]) -> str | float:
    """Return a number; a flag, word or vector as text."""
    if isinstance(content, tuple):
        return " ".join(f"{part:g}" for part in content)
    return str(content).lower() if isinstance(content, bool) else content
