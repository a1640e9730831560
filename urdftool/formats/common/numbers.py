"""Numbers as text: the shortest that reads back as the same double."""

from __future__ import annotations

from collections.abc import Iterable


def number_text(value: float) -> str:
    """Format a number as the shortest text that reads back as the same double.

    Whole numbers have no decimal point; -0 is written as 0.
    """
    if value == 0:
        return "0"
    if value == int(value) and abs(value) < 1e16:
        return str(int(value))
    return repr(float(value))


def format_numbers_text(values: Iterable[float]) -> str:
    """Format numbers, separated by blanks."""
    return " ".join(map(number_text, values))
