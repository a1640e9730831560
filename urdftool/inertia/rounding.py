"""Numbers as they are written: twelve significant digits, without the noise of arithmetic.

A double has some sixteen digits, of which the last few are noise: 0.18 · 0.0225 / … comes out as
0.00028350000000000003. Twelve are kept, and then the shortest text that reads back as the same
number; products of inertia and coordinates below 1e-12 of the body's size are zeros that a rotation
has left over. Where such rounding would break the triangle inequality, as it can for a thin plate,
more digits are kept.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import SymmetricTensor, as_tensor, consistency, trace_of
from .requirements import ROUNDING, require_consistent

DIGITS = 12
"""Significant digits that are kept."""

NOISE = 1e-12
"""Part of the body's own size below which a number off the diagonal is zero."""

_EXACT = 2e-15


def round_properties(properties: SpatialInertia, what: str = "the result") -> SpatialInertia:
    """The same properties in numbers that can be written.

    Raises:
        InertiaError: A rigid body cannot have them.
    """
    require_consistent(properties, what)
    tensor = as_tensor(_without_noise(properties.tensor, 0.0))
    gyration = math.sqrt(trace_of(tensor) / properties.mass)
    x, y, z = _rounded(_without_noise(properties.com, gyration), DIGITS)
    return require_consistent(
        SpatialInertia(round_number(properties.mass), (x, y, z), _possible(tensor)), what
    )


def _without_noise(values: Sequence[float], size: float) -> list[float]:
    """Replace what is below the noise of the largest value, or of a size, by zeros."""
    least = NOISE * max(size, *map(abs, values))
    return [0.0 if abs(value) < least else value for value in values]


def round_number(value: float, digits: int = DIGITS) -> float:
    """A number with so many significant digits; never a negative zero."""
    return float(f"{value:.{digits}g}") + 0.0


def number_text(value: float) -> str:
    """The shortest text of a number; whole numbers have no point."""
    if value == int(value) and abs(value) < 1e16:
        return str(int(value))
    return repr(float(value))


def numbers_text(values: Iterable[float]) -> str:
    """Numbers with blanks between."""
    return " ".join(number_text(float(value)) for value in values)


def _possible(tensor: SymmetricTensor) -> SymmetricTensor:
    allowed = max(_EXACT, consistency(tensor).excess)
    for digits in range(DIGITS, 17):
        rounded = as_tensor(_rounded(tensor, digits))
        found = consistency(rounded)
        if found.size > 0 and found.excess <= allowed and found.negativity <= ROUNDING:
            return rounded
    return tensor


def _rounded(values: Sequence[float], digits: int) -> list[float]:
    return [round_number(value, digits) for value in values]
