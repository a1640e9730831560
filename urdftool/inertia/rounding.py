"""Numbers as they are written: twelve significant digits, without the noise of arithmetic.

A double has some sixteen digits, of which the last few are noise: 0.18 · 0.0225 / … comes out as
0.00028350000000000003. Twelve are kept, and then the shortest text that reads back as the same
number; products of inertia and coordinates below 1e-12 of the body's size are zeros that a rotation
has left over. Where such rounding would break the triangle inequality, as it can for a thin plate,
more digits are kept.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from .tensor import Array, MassProperties, is_positive, require_possible, triangle_excess

DIGITS = 12
"""Significant digits that are kept."""

NOISE = 1e-12
"""Part of the body's own size below which a number off the diagonal is zero."""

_EXACT = 2e-15


def round_properties(properties: MassProperties, what: str = "the result") -> MassProperties:
    """The same properties in numbers that can be written.

    Raises:
        InertiaError: A rigid body cannot have them.
    """
    require_possible(properties, what)
    inertia = properties.inertia.copy()
    inertia[np.abs(inertia) < NOISE * np.abs(inertia).max()] = 0.0
    com = properties.com.copy()
    gyration = float(np.sqrt(np.trace(inertia) / properties.mass))
    com[np.abs(com) < NOISE * max(gyration, float(np.abs(com).max()))] = 0.0
    return require_possible(
        MassProperties(round_number(properties.mass), _rounded(com, DIGITS), _possible(inertia)),
        what,
    )


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


def _possible(inertia: Array) -> Array:
    allowed = max(_EXACT, triangle_excess(inertia))
    for digits in range(DIGITS, 17):
        rounded = _rounded(inertia, digits)
        if triangle_excess(rounded) <= allowed and is_positive(rounded):
            return rounded
    return inertia


def _rounded(values: Array, digits: int) -> Array:
    flat = [round_number(value, digits) for value in values.reshape(-1)]
    return np.array(flat, dtype=np.float64).reshape(values.shape)
