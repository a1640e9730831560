"""Numbers as text: the shortest that reads back as the same double."""

from __future__ import annotations

from collections.abc import Iterable


def number_text(value: float) -> str:
    """The shortest text of a number; whole numbers have no point, and there is no ``-0``."""
    if value == 0:
        return "0"
    if value == int(value) and abs(value) < 1e16:
        return str(int(value))
    return repr(float(value))


def numbers_text(values: Iterable[float]) -> str:
    """Numbers with blanks between."""
    return " ".join(map(number_text, values))
