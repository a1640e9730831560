"""Convex shapes and their penetration depth, in plain Python: lint of primitives has no numpy.

A convex shape is known by how far it reaches in each direction (its support function). Two shapes
are apart if along some direction the one ends before the other begins; if they overlap, the least
overlap of all directions is the distance by which one has to move to be free: the penetration
depth. It is looked for among the directions that decide in most cases and then by smaller and
smaller steps from the best of them, so what is returned is an upper bound, and close.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from ..model.elements import Box, Capsule, Cylinder, Geometry, Sphere, Vector
from ..model.pose import Pose, cross, norm, transpose

SupportFunction = Callable[[float, float, float], float]
"""How far a shape reaches along a direction [m], in its own frame."""


class Convex(NamedTuple):
    """A convex shape.

    Attributes:
        pose: Of its own frame.
        reach: Its support function in that frame.
        radius: Of a sphere about the origin of that frame that holds it [m].
        filled: Whether it is the shape itself, not the hull of something hollow.
    """

    pose: Pose
    reach: SupportFunction
    radius: float
    filled: bool = True

    def moved(self, pose: Pose) -> Convex:
        """The same in the frame in which ``pose`` is that of its present one."""
        return Convex(pose @ self.pose, self.reach, self.radius, self.filled)


def convex_of(geometry: Geometry | None, pose: Pose) -> Convex | None:
    """A primitive in the frame of its link; None for any other shape, or one without a size."""
    made = _reach_of(geometry)
    if made is None or not 0 < made[1] < math.inf:
        return None
    return Convex(pose, *made)


def _reach_of(geometry: Geometry | None) -> tuple[SupportFunction, float] | None:
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
    return None


def overlap(one: Convex, other: Convex, enough: float = 0.0) -> float:
    """How deep two shapes overlap [m]; ``enough`` or less as soon as it cannot be more."""
    apart = _difference(other.pose.translation, one.pose.translation)
    distance = norm(apart)
    if distance >= one.radius + other.radius - enough:
        return enough
    turn, turned = transpose(one.pose.rotation), transpose(other.pose.rotation)
    x, y, z = apart
    reach, reached = one.reach, other.reach

    def along(d: Vector) -> float:
        """Where the one ends less where the other begins."""
        a, b, c = d
        (p, q, r), (s, t, u), (v, w, k) = turn
        first = reach(p * a + q * b + r * c, s * a + t * b + u * c, v * a + w * b + k * c)
        (p, q, r), (s, t, u), (v, w, k) = turned
        a, b, c = -a, -b, -c
        second = reached(p * a + q * b + r * c, s * a + t * b + u * c, v * a + w * b + k * c)
        return first + second + a * x + b * y + c * z

    best, way = math.inf, (0.0, 0.0, 1.0)
    for direction in _directions(one, other, apart, distance):
        value = along(direction)
        if value < best:
            best, way = value, direction
            if best <= enough:
                return best
    step = 0.4
    while step > 0.02:
        better = False
        for direction in _around(way, step):
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


def _directions(one: Convex, other: Convex, apart: Vector, distance: float) -> Iterator[Vector]:
    """Those that most probably decide first."""
    if distance > 1e-9:
        yield _scaled(apart, 1 / distance)
    for shape in (one, other):
        for axis in transpose(shape.pose.rotation):
            yield axis
            yield _scaled(axis, -1.0)
    yield from CORNER_DIRECTIONS


def _around(way: Vector, step: float) -> Iterator[Vector]:
    """Eight unit vectors at an angle to one [rad]."""
    least = min(range(3), key=lambda axis: abs(way[axis]))
    first = cross(way, tuple(float(axis == least) for axis in range(3)))  # type: ignore[arg-type]
    first = _scaled(first, 1 / norm(first))
    second = cross(way, first)
    for number in range(8):
        c, s = math.cos(number * math.pi / 4), math.sin(number * math.pi / 4)
        moved = [w + step * (c * f + s * g) for w, f, g in zip(way, first, second, strict=True)]
        length = math.hypot(*moved)
        yield moved[0] / length, moved[1] / length, moved[2] / length


def _scaled(vector: Sequence[float], factor: float) -> Vector:
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _difference(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]
