"""Numbers as text without the noise of floating point: ``2.375e-06``, not its neighbor.

xacro computes ``2.3749999999999997e-06`` of a mass and a size, and a rotation of an inertia tensor
leaves the like. A number within a few units in the last place of one with at
most ten digits is that one: it changes by less than 2e-15 of itself.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from ..common import numbers

DIGITS = 10
"""The most digits of a number that somebody wrote."""

NOISE = 8
"""Units in the last place that rounding explains."""


def snapped(value: float) -> float:
    """Return the number of at most ten digits that a number is, up to rounding; or itself."""
    if not math.isfinite(value) or value == 0:
        return value
    short = float(f"{value:.{DIGITS}g}")
    return short if abs(short - value) <= NOISE * math.ulp(value) else value


def number_text(value: float) -> str:
    """Format a number as the shortest text that reads back as it, without noise."""
    return numbers.number_text(snapped(value))


def numbers_text(values: Iterable[float]) -> str:
    """Format numbers with blanks between."""
    return " ".join(map(number_text, values))
