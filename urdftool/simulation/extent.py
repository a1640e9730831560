"""How far a link's shapes reach, and how much room they take: what its mass can be held against."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..formats.mjcf.extent import shape_points
from ..model.elements import Box, Capsule, Collision, Cylinder, Mesh, Robot, Sphere, Visual
from .recording import Array


@dataclass(frozen=True, eq=False)
class Extent:
    """Of a link.

    Attributes:
        points: Corners of its shapes in the link's frame [m], shape (n, 3).
        volume: Of its visual or its collision shapes, whichever is larger; of meshes their convex
            hulls [m³].
    """

    points: Array = field(default_factory=lambda: np.zeros((0, 3)))
    volume: float = 0.0

    def reach(self, centre: Array) -> float:
        """How far the farthest corner is from a point [m]; 0 where there is none."""
        if not len(self.points):
            return 0.0
        return float(np.linalg.norm(self.points - centre, axis=1).max())


def extent_of(robot: Robot, name: str, *, only_collisions: bool = False) -> Extent:
    """The extent of a link; shapes that cannot be read are left out.

    Args:
        robot: The robot, read from a description.
        name: Of the link.
        only_collisions: Leave out what is only seen, which may take long to read.
    """
    link = robot.link[name]
    groups: list[list[Collision] | list[Visual]] = [link.collisions]
    if not only_collisions:
        groups.append(link.visuals)
    points, volumes = [], [0.0]
    for group in groups:
        found = [(shape, shape_points(robot, shape)) for shape in group]
        points += [corners for _, corners in found if corners is not None]
        volumes.append(sum(_volume(shape, c) for shape, c in found if c is not None))
    if not points:
        return Extent()
    return Extent(np.concatenate(points), max(volumes))


def _volume(shape: Collision | Visual, points: Array) -> float:
    geometry = shape.geometry
    if isinstance(geometry, Box):
        x, y, z = geometry.size
        return abs(x * y * z)
    if isinstance(geometry, Sphere):
        return float(4 / 3 * np.pi * geometry.radius**3)
    if isinstance(geometry, (Cylinder, Capsule)):
        ends = 4 / 3 * geometry.radius if isinstance(geometry, Capsule) else 0.0
        return float(np.pi * geometry.radius**2 * (geometry.length + ends))
    if not isinstance(geometry, Mesh):
        return 0.0
    from scipy.spatial import ConvexHull, QhullError

    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0
