"""Numbers as text: the shortest that reads back as the same double.

xacro expressions and rotations of inertia tensors leave rounding errors: ``2.375e-06`` becomes
``2.3749999999999997e-06``. A number within a few units in the last place of one with at most ten
digits may be replaced by that one: a relative change below 2e-15.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

DIGITS = 10
"""Maximum number of significant digits of a number that a person wrote."""

NOISE = 8
"""Units in the last place that are attributed to rounding."""


def round_noise(value: float) -> float:
    """Round a number to ten significant digits if the change is within rounding noise."""
    if not math.isfinite(value) or value == 0:
        return value
    short = float(f"{value:.{DIGITS}g}")
    return short if abs(short - value) <= NOISE * math.ulp(value) else value


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
