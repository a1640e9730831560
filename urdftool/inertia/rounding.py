"""Rounding of computed mass properties: six significant digits, as a person writes them.

Masses, sizes and meshes of 32 bits have no more. A center of mass is rounded to a micrometer, or
to a millionth of the radius of gyration of a body below 1 m, so that remnants of rotations become
zero, and small bodies far from the origin keep their place. Products of inertia below 1e-12 of the
moments become zero. If rounding would violate the triangle inequality, as for a thin plate, more
digits are kept. :mod:`urdftool.model.numbers` writes the numbers as text.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import ROUNDING, SymmetricTensor, as_tensor, measure_consistency, trace_of
from ..model.numbers import round_number
from .requirements import require_consistent

DIGITS = 6
"""Number of significant digits; chosen: 32-bit meshes have seven, tables of this tool show six."""

NOISE = 1e-12
"""Part of the largest moment below which a product of inertia becomes zero."""

_EXACT = 2e-15
"""Relative rounding of sums of doubles: about nine times the distance of 1 from the next."""


def round_properties(properties: SpatialInertia, what: str = "the result") -> SpatialInertia:
    """Round mass properties to numbers that can be written.

    Raises:
        InertiaError: They are not physically consistent.
    """
    require_consistent(properties, what)
    tensor = as_tensor(_remove_noise(properties.tensor))
    gyration = math.sqrt(trace_of(tensor) / properties.mass)
    x, y, z = (_round_position(value, gyration) for value in properties.com)
    return require_consistent(
        SpatialInertia(round_number(properties.mass, DIGITS), (x, y, z), _make_consistent(tensor)),
        what,
    )


def _round_position(value: float, size: float) -> float:
    """Round a coordinate to 1e-6 m, or to a millionth of a size [m] below 1; 0 rounds digits."""
    if size == 0:
        return round_number(value, DIGITS)
    return round(value, max(DIGITS, DIGITS - math.ceil(math.log10(size)))) + 0.0


def _remove_noise(values: Sequence[float]) -> list[float]:
    """Replace values below the noise of the largest value by zeros."""
    least = NOISE * max(map(abs, values))
    return [0.0 if abs(value) < least else value for value in values]


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
