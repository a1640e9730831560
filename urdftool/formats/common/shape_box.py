"""Axis-aligned bounding boxes of shapes."""

from __future__ import annotations

import math
import os
from math import hypot

from ...errors import SourceError
from ...geometry.convex_points import ConvexPoints, read_convex_points
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Ellipsoid,
    Mesh,
    Robot,
    Sphere,
    UnknownShape,
    Vector,
    Visual,
)
from ...model.pose import Pose, make_pose, rotate, transpose
from ...model.read import number

Bounds = tuple[Vector, Vector]
"""Minimum and maximum corner [m]."""


class ShapeBoxes:
    """Bounding boxes of the shapes of a robot; each mesh file is read once."""

    def __init__(self, robot: Robot) -> None:
        """Initialize for a robot; meshes are read on demand."""
        self._robot = robot
        self._outlines: dict[str, ConvexPoints | None] = {}

    def compute_box(self, shape: Visual | Collision, frame: Pose) -> Bounds | None:
        """Compute the bounding box of a shape.

        Returns:
            The box along the axes of the frame's parent, exact except for meshes of more than
            50,000 points; None if the shape has no size or its mesh cannot be read.
        """
        geometry = shape.geometry
        pose = frame @ make_pose(shape.origin)
        if isinstance(geometry, Mesh):
            points = self._make_outline(geometry.filename)
            if points is None:
                return None
            return points.compute_box(geometry.scale, pose.rotation, pose.translation)
        size = None if geometry is None else get_shape_size(geometry)
        if size is None or not min(size[1]) >= 0:
            return None
        a, b, c = (_compute_reach(*size, row) for row in pose.rotation)
        x, y, z = pose.translation
        return (x - a, y - b, z - c), (x + a, y + b, z + c)

    def find_outermost(
        self, shape: Visual | Collision, frame: Pose, direction: Vector
    ) -> Vector | None:
        """Find the point of a shape that is farthest in a direction.

        Args:
            shape: A shape of a link.
            frame: Pose of the link.
            direction: A unit vector in the frame's parent.

        Returns:
            The point in the frame's parent [m], exact as in ``compute_box``; None without one.
        """
        geometry = shape.geometry
        pose = frame @ make_pose(shape.origin)
        way = rotate(transpose(pose.rotation), direction)
        if isinstance(geometry, Mesh):
            points = self._make_outline(geometry.filename)
            if points is None:
                return None
            return pose.transform(points.find_outermost(geometry.scale, way))
        size = None if geometry is None else get_shape_size(geometry)
        if size is None or not min(size[1]) >= 0:
            return None
        return pose.transform(_find_corner(*size, way))

    def _make_outline(self, name: str) -> ConvexPoints | None:
        if name not in self._outlines:
            self._outlines[name] = self._read(name)
        return self._outlines[name]

    def _read(self, name: str) -> ConvexPoints | None:
        source = self._robot.source
        if source is None or not name:
            return None
        try:
            return read_convex_points(os.path.realpath(source.resolve(name)), source.gltf_up)
        except SourceError:
            return None


def _compute_reach(kind: str, size: tuple[float, ...], way: Vector) -> float:
    """Compute the support function [m] of a primitive of MuJoCo's type and half sizes [m]."""
    x, y, z = way
    if kind == "box":
        return sum(abs(part) * half for part, half in zip(way, size, strict=True))
    if kind == "ellipsoid":
        return hypot(*(part * half for part, half in zip(way, size, strict=True)))
    if kind == "cylinder":
        return size[0] * hypot(x, y) + size[1] * abs(z)
    if kind == "capsule":
        return size[0] + size[1] * abs(z)
    return size[0]


def _find_corner(kind: str, size: tuple[float, ...], way: Vector) -> Vector:
    """Return the point [m] of a primitive that is farthest in a direction of its frame."""
    x, y, z = way
    if kind == "box":
        a, b, c = (math.copysign(half, part) for half, part in zip(size, way, strict=True))
        return a, b, c
    if kind == "ellipsoid":
        length = _compute_reach(kind, size, way) or 1.0
        a, b, c = (half * half * part / length for half, part in zip(size, way, strict=True))
        return a, b, c
    radius, flat = size[0], hypot(x, y)
    if kind == "cylinder":
        part = radius / flat if flat else 0.0
        return part * x, part * y, math.copysign(size[1], z)
    length = hypot(x, y, z) or 1.0
    end = math.copysign(size[1], z) if kind == "capsule" else 0.0
    return radius * x / length, radius * y / length, radius * z / length + end


def get_shape_size(shape: object) -> tuple[str, tuple[float, ...]] | None:
    """Return MuJoCo's type and half sizes [m] of a primitive; None for other geometry."""
    if isinstance(shape, Box):
        return "box", tuple(edge / 2 for edge in shape.size)
    if isinstance(shape, Cylinder):
        return "cylinder", (shape.radius, shape.length / 2)
    if isinstance(shape, Capsule):
        return "capsule", (shape.radius, shape.length / 2)
    if isinstance(shape, Sphere):
        return "sphere", (shape.radius,)
    if isinstance(shape, Ellipsoid):
        return "ellipsoid", shape.radii
    if isinstance(shape, UnknownShape):
        return _get_drake_size(shape)
    return None


def _get_drake_size(shape: UnknownShape) -> tuple[str, tuple[float, ...]] | None:
    """Return type and half sizes [m] of Drake's extra shapes; None for others."""
    if shape.xml is None:
        return None
    read = {
        name: number(shape.element.get(name)) or 0.0 for name in ("a", "b", "c", "radius", "length")
    }
    if shape.element.tag == "drake:ellipsoid":
        return "ellipsoid", (read["a"], read["b"], read["c"])
    if shape.element.tag == "drake:capsule":
        return "capsule", (read["radius"], read["length"] / 2)
    return None
