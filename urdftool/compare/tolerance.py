"""Equality of numbers, vectors, poses and tensors within a tolerance."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..model.elements import Vector
from ..model.part import Origin
from ..model.pose import Pose, Rotation, make_pose, multiply_matrices, transpose
from ..model.settings import Value

TOLERANCE = 1e-9
"""Relative tolerance, absolute for positions [m] and angles [rad]; above rounding errors in xacro
files.
"""

_NOTHING = 1e-12
"""Largest absolute difference that is rounding, in the unit of the numbers; chosen, no source."""


def close(a: float | None, b: float | None, tolerance: float) -> bool:
    """Tell whether two numbers are equal, relative to the larger; None equals only None."""
    if a is None or b is None:
        return a is b
    return math.isclose(a, b, rel_tol=tolerance, abs_tol=_NOTHING)


def are_close(a: Sequence[float] | None, b: Sequence[float] | None, tolerance: float) -> bool:
    """Tell whether two vectors or tensors are equal, relative to their largest element."""
    if a is None or b is None:
        return a is b
    largest = max(map(abs, (*a, *b)), default=0.0)
    return len(a) == len(b) and all(
        abs(x - y) <= tolerance * largest for x, y in zip(a, b, strict=True)
    )


def is_same(a: object, b: object, tolerance: float) -> bool:
    """Tell whether two values of a description are equal.

    Args:
        a: The first: a number, text, vector, origin, setting, or a mapping of these.
        b: The second.
        tolerance: Relative tolerance of numbers and vectors, absolute one of origins.
    """
    if isinstance(a, Value) and isinstance(b, Value):
        return is_same(a.content, b.content, tolerance)
    if isinstance(a, Origin) or isinstance(b, Origin):
        one, two = (side if isinstance(side, Origin) else None for side in (a, b))
        return is_same_pose(make_pose(one), make_pose(two), tolerance)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_same(a[key], b[key], tolerance) for key in a)
    if isinstance(a, tuple) and isinstance(b, tuple) and a != b:
        numbers = all(isinstance(value, int | float) for value in (*a, *b))
        return numbers and are_close(a, b, tolerance)
    if isinstance(a, int | float) and isinstance(b, int | float):
        return close(a, b, tolerance)
    return bool(a == b)


def compute_distance(a: Vector, b: Vector) -> float:
    """Return the distance of two points [m]."""
    return math.dist(a, b)


def compute_angle(a: Rotation, b: Rotation) -> float:
    """Return the angle between two rotations [rad], from 0 to π, accurate near 0."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = multiply_matrices(transpose(a), b)
    sine = math.hypot(zy - yz, xz - zx, yx - xy) / 2
    return math.atan2(sine, (xx + yy + zz - 1) / 2)


def is_same_pose(a: Pose, b: Pose, tolerance: float) -> bool:
    """Tell whether two poses are equal, in position [m] and angle [rad]."""
    return (
        compute_distance(a.translation, b.translation) <= tolerance
        and compute_angle(a.rotation, b.rotation) <= tolerance
    )


def format_motion(a: Pose, b: Pose) -> str:
    """Return the distance and angle between two poses as text."""
    far, turned = (
        compute_distance(a.translation, b.translation),
        compute_angle(a.rotation, b.rotation),
    )
    parts = []
    if far > _NOTHING:
        parts.append(f"moved {far * 1000:.4g} mm")
    if turned > _NOTHING:
        parts.append(f"rotated {math.degrees(turned):.4g}°")
    return ", ".join(parts)
