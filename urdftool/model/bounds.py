"""Dimensions and bounding boxes of primitive geometry."""

from __future__ import annotations

import math
from typing import NamedTuple

from .elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Mesh,
    Sphere,
    Vector,
    Visual,
)
from .pose import Pose, Rotation, make_pose, rotate


class Bounds(NamedTuple):
    """Axis-aligned bounding box in a link frame [m], given by two opposite corners."""

    low: Vector
    high: Vector

    @property
    def size(self) -> Vector:
        """Return the lengths along x, y and z [m]."""
        (a, b, c), (d, e, f) = self
        return d - a, e - b, f - c

    @property
    def center(self) -> Vector:
        """Return the center [m]."""
        (a, b, c), (d, e, f) = self
        return (a + d) / 2, (b + e) / 2, (c + f) / 2

    def join(self, other: Bounds) -> Bounds:
        """Return the bounding box of both boxes."""
        low = tuple(map(min, self.low, other.low))
        high = tuple(map(max, self.high, other.high))
        return Bounds(low, high)  # type: ignore[arg-type]

    def rotate(self, rotation: Rotation) -> Bounds:
        """Return the bounding box of this box after a rotation about the origin."""
        x, y, z = rotate(rotation, self.center)
        a, b, c = (
            sum(abs(part) * length for part, length in zip(row, self.size, strict=True)) / 2
            for row in rotation
        )
        return Bounds((x - a, y - b, z - c), (x + a, y + b, z + c))

    def measure_distance(self, point: Vector) -> float:
        """Measure the distance of a point outside of the box from it [m]; 0 inside."""
        sides = zip(self.low, point, self.high, strict=True)
        return math.hypot(*(max(low - value, 0.0, value - high) for low, value, high in sides))

    def meets(self, other: Bounds) -> bool:
        """Tell whether two boxes have a common point."""
        return all(
            a <= d and b >= c
            for a, b, c, d in zip(self.low, self.high, other.low, other.high, strict=True)
        )


def compute_size(geometry: Geometry | None) -> Vector | None:
    """Return the lengths of a primitive along its own axes [m]; None for other geometry."""
    if isinstance(geometry, Box):
        x, y, z = geometry.size
        return abs(x), abs(y), abs(z)
    if isinstance(geometry, Sphere):
        across = 2 * abs(geometry.radius)
        return across, across, across
    if isinstance(geometry, Ellipsoid):
        x, y, z = geometry.radii
        return 2 * abs(x), 2 * abs(y), 2 * abs(z)
    if isinstance(geometry, Cylinder | Cone):
        across = 2 * abs(geometry.radius)
        return across, across, abs(geometry.length)
    if isinstance(geometry, Capsule):
        across = 2 * abs(geometry.radius)
        return across, across, abs(geometry.length) + across
    return None


def compute_bounds(shape: Visual | Collision) -> Bounds | None:
    """Return the bounding box of a primitive in its link frame; None for other geometry."""
    return compute_bounds_at(shape.geometry, make_pose(shape.origin))


def compute_bounds_at(geometry: Geometry | None, pose: Pose) -> Bounds | None:
    """Return the bounding box [m] of a primitive in its parent frame; None for other geometry."""
    size = compute_size(geometry)
    if size is None:
        return None
    if isinstance(geometry, Box):
        half: list[float] = [
            sum(abs(part) * length for part, length in zip(row, size, strict=True)) / 2
            for row in pose.rotation
        ]
    elif isinstance(geometry, Sphere):
        half = [size[0] / 2] * 3
    elif isinstance(geometry, Ellipsoid):
        half = [
            math.hypot(*(part * length / 2 for part, length in zip(row, size, strict=True)))
            for row in pose.rotation
        ]
    elif isinstance(geometry, Cone):
        return _get_bounds_of_cone(size[0] / 2, size[2] / 2, pose)
    else:  # half extent of a disc of radius r along an axis: r·sin(angle to the disc's axis)
        rounded = isinstance(geometry, Capsule)
        radius, along = size[0] / 2, (size[2] - size[0] * rounded) / 2
        half = [
            abs(row[2]) * along
            + radius * (1.0 if rounded else math.sqrt(max(0.0, 1.0 - row[2] * row[2])))
            for row in pose.rotation
        ]
    x, y, z = pose.translation
    a, b, c = half
    return Bounds((x - a, y - b, z - c), (x + a, y + b, z + c))


def _get_bounds_of_cone(radius: float, half: float, pose: Pose) -> Bounds:
    """Return the bounding box of a disc at -half and a tip at +half along z, at a pose."""
    low, high = [], []
    for row, shift in zip(pose.rotation, pose.translation, strict=True):
        around = radius * math.sqrt(max(0.0, 1.0 - row[2] * row[2]))
        tip, base = row[2] * half, -row[2] * half
        low.append(shift + min(tip, base - around))
        high.append(shift + max(tip, base + around))
    return Bounds((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def has_extent(geometry: Geometry) -> bool:
    """Tell whether all dimensions of a shape are positive, and no scale factor is zero."""
    if isinstance(geometry, Box):
        return all(size > 0 for size in geometry.size)
    if isinstance(geometry, Cylinder | Capsule | Cone):
        return geometry.radius > 0 and geometry.length > 0
    if isinstance(geometry, Sphere):
        return geometry.radius > 0
    if isinstance(geometry, Ellipsoid):
        return all(radius > 0 for radius in geometry.radii)
    if isinstance(geometry, Mesh):
        return all(geometry.scale)
    return False
