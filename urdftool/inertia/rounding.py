"""Rounding of mass properties: twelve significant digits, without arithmetic noise.

The last few of the sixteen digits of a double are noise: 0.18 · 0.0225 / … gives
0.00028350000000000003. Numbers are rounded to twelve digits; :mod:`urdftool.model.numbers` writes
them as the shortest text that reads back as the same number. Products of inertia and coordinates
below 1e-12 of the body's size are remnants of rotations and become zero. If rounding would violate
the triangle inequality, as for a thin plate, more digits are kept.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import ROUNDING, SymmetricTensor, as_tensor, measure_consistency, trace_of
from .requirements import require_consistent

DIGITS = 12
"""Number of significant digits."""

NOISE = 1e-12
"""Threshold, relative to the body's size, below which a number becomes zero."""

_EXACT = 2e-15
"""Relative rounding of sums of doubles: about nine times the distance of 1 from the next."""


def round_properties(properties: SpatialInertia, what: str = "the result") -> SpatialInertia:
    """Round mass properties to numbers that can be written.

    Raises:
        InertiaError: They are not physically consistent.
    """
    require_consistent(properties, what)
    tensor = as_tensor(_remove_noise(properties.tensor, 0.0))
    gyration = math.sqrt(trace_of(tensor) / properties.mass)
    x, y, z = _round_values(_remove_noise(properties.com, gyration), DIGITS)
    return require_consistent(
        SpatialInertia(round_number(properties.mass), (x, y, z), _make_consistent(tensor)), what
    )


def _remove_noise(values: Sequence[float], size: float) -> list[float]:
    """Replace values below the noise of the largest value, or of a size, by zeros."""
    least = NOISE * max(size, *map(abs, values))
    return [0.0 if abs(value) < least else value for value in values]


def round_number(value: float, digits: int = DIGITS) -> float:
    """Round a number to significant digits; the result is never a negative zero."""
    return float(f"{value:.{digits}g}") + 0.0


def _make_consistent(tensor: SymmetricTensor) -> SymmetricTensor:
    allowed = max(_EXACT, measure_consistency(tensor).excess)
    for digits in range(DIGITS, 17):
        rounded = as_tensor(_round_values(tensor, digits))
        found = measure_consistency(rounded)
        if found.size > 0 and found.excess <= allowed and found.negativity <= ROUNDING:
            return rounded
    return tensor


def _round_values(values: Sequence[float], digits: int) -> list[float]:
    return [round_number(value, digits) for value in values]
