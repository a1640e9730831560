"""The box around a shape along the axes of the root, for its lowest point and its size."""

from __future__ import annotations

import os
from math import hypot

from ...errors import SourceError
from ...geometry.convex_points import ConvexPoints, read_convex_points
from ...model.elements import Collision, Mesh, Robot, Vector, Visual
from ...model.pose import Pose, pose_of
from .geom import shape_size

Box = tuple[Vector, Vector]
"""The smallest and the largest corner [m]."""


class ShapeBoxes:
    """Boxes around the shapes of a robot; a mesh file is read once."""

    def __init__(self, robot: Robot) -> None:
        """Take the robot; its meshes are read when they are asked for."""
        self._robot = robot
        self._outlines: dict[str, ConvexPoints | None] = {}

    def box(self, shape: Visual | Collision, frame: Pose) -> Box | None:
        """Compute the box around a shape.

        Args:
            shape: A shape of a link.
            frame: The pose of the link.

        Returns:
            The box along the axes of the frame's parent, exact but for meshes of over 50,000
            points; None where the shape has no size or its mesh cannot be read.
        """
        geometry = shape.geometry
        pose = frame @ pose_of(shape.origin)
        if isinstance(geometry, Mesh):
            points = self._outline(geometry.filename)
            if points is None:
                return None
            return points.box(geometry.scale, pose.rotation, pose.translation)
        size = None if geometry is None else shape_size(geometry)
        if size is None or not min(size[1]) >= 0:
            return None
        a, b, c = (_reach(*size, row) for row in pose.rotation)
        x, y, z = pose.translation
        return (x - a, y - b, z - c), (x + a, y + b, z + c)

    def _outline(self, name: str) -> ConvexPoints | None:
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


def _reach(kind: str, size: tuple[float, ...], way: Vector) -> float:
    """How far a shape of MuJoCo's type and half sizes [m] reaches along a unit vector [m]."""
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
