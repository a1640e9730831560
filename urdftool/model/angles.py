"""Multiples of 15° as people write them in radians: 1.5708 for π/2."""

from __future__ import annotations

import math
from collections.abc import Iterable

STEP = math.pi / 12
"""Angles that people round: multiples of 15° [rad]. Chosen, no source."""

DECIMALS = 4
"""Decimals of such an angle, at least: 1.5708. Chosen, no source."""

_SAME = 1e-8
"""Difference [rad] below which a computed angle is a multiple of 15°; chosen, no source."""


def restore_angle(value: float) -> float:
    """Return the multiple of 15° that an angle [rad] is, rounded to four or more decimals.

    Other angles are returned as they are.
    """
    if not math.isfinite(value) or abs(value) > 1e3:
        return value
    exact = round(value / STEP) * STEP
    if abs(value - exact) > 10**-DECIMALS:
        return value
    rounded = (round(exact, decimals) for decimals in range(DECIMALS, 16))
    return exact if value in rounded else value


def format_angles(values: Iterable[float], digits: int = 9) -> str:
    """Format angles [rad]: multiples of 15° with four decimals, others with significant digits."""
    return " ".join(_format_angle(value + 0.0, digits) for value in values)


def _format_angle(value: float, digits: int) -> str:
    exact = round(value / STEP) * STEP
    text = f"{value:.{digits}g}"
    if abs(value - exact) >= _SAME:
        return text
    short = f"{exact:.{DECIMALS}f}".rstrip("0").rstrip(".")
    return short if len(short) < len(text) else text
