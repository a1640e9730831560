"""Penetration depth of convex shapes, in plain Python, so that lint of primitives needs no numpy.

A convex shape is described by its support function. Two shapes are separate if they do not overlap
along some direction. Otherwise the smallest overlap over all directions is the penetration depth:
the distance by which one shape must move to be free. The search starts from the directions that
usually decide and refines the best of them by decreasing steps. The result is therefore a close
upper bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from ..model.elements import Box, Capsule, Cone, Cylinder, Ellipsoid, Geometry, Sphere, Vector
from ..model.pose import Pose, compute_cross, compute_norm, transpose

SupportFunction = Callable[[float, float, float], float]
"""Support function: the largest extent of a shape along a direction [m], in its own frame."""


class Convex(NamedTuple):
    """A convex shape.

    Attributes:
        pose: Pose of the shape's frame.
        reach: Support function in that frame.
        radius: Radius of a bounding sphere about the origin of that frame [m].
        filled: Whether it is the shape itself, not the hull of a shape with cavities.
    """

    pose: Pose
    reach: SupportFunction
    radius: float
    filled: bool = True

    def transform(self, pose: Pose) -> Convex:
        """Express the shape in the parent frame, in which its present frame has this pose."""
        return Convex(pose @ self.pose, self.reach, self.radius, self.filled)


def make_convex(geometry: Geometry | None, pose: Pose) -> Convex | None:
    """Return a primitive as a convex shape; None for other geometry or without a size."""
    support = _make_support_function(geometry)
    if support is None or not 0 < support[1] < math.inf:
        return None
    return Convex(pose, *support)


def _make_support_function(geometry: Geometry | None) -> tuple[SupportFunction, float] | None:
    if isinstance(geometry, Box):
        a, b, c = (abs(side) / 2 for side in geometry.size)
        return lambda x, y, z: a * abs(x) + b * abs(y) + c * abs(z), math.hypot(a, b, c)
    if isinstance(geometry, Sphere):
        r = abs(geometry.radius)
        return lambda x, y, z: r * math.hypot(x, y, z), r
    if isinstance(geometry, Cylinder):
        r, h = abs(geometry.radius), abs(geometry.length) / 2
        return lambda x, y, z: r * math.hypot(x, y) + h * abs(z), math.hypot(r, h)
    if isinstance(geometry, Capsule):
        r, h = abs(geometry.radius), abs(geometry.length) / 2
        return lambda x, y, z: r * math.hypot(x, y, z) + h * abs(z), r + h
    if isinstance(geometry, Ellipsoid):
        a, b, c = map(abs, geometry.radii)
        return lambda x, y, z: math.hypot(a * x, b * y, c * z), max(a, b, c)
    if isinstance(geometry, Cone):
        r, h = abs(geometry.radius), abs(geometry.length) / 2
        return lambda x, y, z: max(h * z, r * math.hypot(x, y) - h * z), math.hypot(r, h)
    return None


def compute_overlap(one: Convex, other: Convex, enough: float = 0.0) -> float:
    """Compute the penetration depth of two shapes [m], an upper bound.

    Args:
        one: A shape.
        other: A shape in the same frame.
        enough: The search stops as soon as the depth is known to be at most this [m], and returns
            ``enough`` or less.
    """
    offset = _subtract(other.pose.translation, one.pose.translation)
    distance = compute_norm(offset)
    if distance >= one.radius + other.radius - enough:
        return enough
    turn, turned = transpose(one.pose.rotation), transpose(other.pose.rotation)
    x, y, z = offset
    reach, reached = one.reach, other.reach

    def along(d: Vector) -> float:
        """Return the overlap along a unit direction [m]."""
        a, b, c = d
        (p, q, r), (s, t, u), (v, w, k) = turn
        first = reach(p * a + q * b + r * c, s * a + t * b + u * c, v * a + w * b + k * c)
        (p, q, r), (s, t, u), (v, w, k) = turned
        a, b, c = -a, -b, -c
        second = reached(p * a + q * b + r * c, s * a + t * b + u * c, v * a + w * b + k * c)
        return first + second + a * x + b * y + c * z

    best, way = math.inf, (0.0, 0.0, 1.0)
    for direction in _list_directions(one, other, offset, distance):
        value = along(direction)
        if value < best:
            best, way = value, direction
            if best <= enough:
                return best
    step = 0.4
    while step > 0.02:
        better = False
        for direction in _list_neighbors(way, step):
            value = along(direction)
            if value < best:
                best, way, better = value, direction, True
                if best <= enough:
                    return best
        if not better:
            step /= 2.5
    return best


CORNER_DIRECTIONS = tuple(
    (x / n, y / n, z / n)
    for x in (-1, 0, 1)
    for y in (-1, 0, 1)
    for z in (-1, 0, 1)
    if (n := math.hypot(x, y, z))
)
"""Unit vectors to the faces, edges and corners of a cube."""


def _list_directions(
    one: Convex, other: Convex, offset: Vector, distance: float
) -> Iterator[Vector]:
    """Yield the directions that usually decide, the most probable first."""
    if distance > 1e-9:
        yield _scale(offset, 1 / distance)
    for shape in (one, other):
        for axis in transpose(shape.pose.rotation):
            yield axis
            yield _scale(axis, -1.0)
    yield from CORNER_DIRECTIONS


def _list_neighbors(way: Vector, step: float) -> Iterator[Vector]:
    """Yield eight unit vectors around a direction, at about ``step`` [rad] from it."""
    least = min(range(3), key=lambda axis: abs(way[axis]))
    first = compute_cross(way, tuple(float(axis == least) for axis in range(3)))  # type: ignore[arg-type]
    first = _scale(first, 1 / compute_norm(first))
    second = compute_cross(way, first)
    for number in range(8):
        c, s = math.cos(number * math.pi / 4), math.sin(number * math.pi / 4)
        moved = [w + step * (c * f + s * g) for w, f, g in zip(way, first, second, strict=True)]
        length = math.hypot(*moved)
        yield moved[0] / length, moved[1] / length, moved[2] / length


def _scale(vector: Sequence[float], factor: float) -> Vector:
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _subtract(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]
