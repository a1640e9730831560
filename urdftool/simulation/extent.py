"""Measure the extent, bounding box and volume of the shapes of a link."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..geometry.hull import compute_convex_hull
from ..geometry.link_extent import get_shape_points, transform_to_link
from ..model.elements import Box, Capsule, Collision, Cylinder, Mesh, Robot, Sphere, Visual
from .mesh_cache import get_outermost_points
from .recording import Array


@dataclass(frozen=True, eq=False)
class Extent:
    """Extent of the shapes of a link.

    Attributes:
        points: Corners of the shapes in the link's frame [m], shape (n, 3).
        groups: Collisions, then visuals, each with its corners.
    """

    points: Array = field(default_factory=lambda: np.zeros((0, 3)))
    groups: tuple[tuple[tuple[Collision | Visual, Array], ...], ...] = ()

    @cached_property
    def volume(self) -> float:
        """Compute the larger volume of visuals and collisions, with meshes as hulls [m³]."""
        return max(
            (sum(_compute_volume(*shape) for shape in group) for group in self.groups), default=0.0
        )

    def measure_reach(self, center: Array) -> float:
        """Measure the distance of the farthest corner from a point [m]; 0 without corners."""
        if not len(self.points):
            return 0.0
        return float(np.linalg.norm(self.points - center, axis=1).max())


def measure_extent(robot: Robot, name: str, *, only_collisions: bool = False) -> Extent:
    """Measure the extent of a link; shapes that cannot be read are skipped."""
    link = robot.link[name]
    groups: list[list[Collision] | list[Visual]] = [link.collisions]
    if not only_collisions:
        groups.append(link.visuals)
    read = []
    for group in groups:
        found = [(shape, get_shape_corners(robot, shape)) for shape in group]
        read.append(tuple((shape, corners) for shape, corners in found if corners is not None))
    points = [corners for shapes in read for _, corners in shapes]
    return Extent(np.concatenate(points), tuple(read)) if points else Extent()


def get_shape_corners(robot: Robot, shape: Visual | Collision) -> Array | None:
    """Return the points of a shape in its link's frame [m]; of a mesh, only the extreme points."""
    if not isinstance(shape.geometry, Mesh):
        return get_shape_points(robot, shape)
    points = get_outermost_points(robot, shape.geometry)
    return None if points is None else transform_to_link(points, shape)


def compute_bounding_box(
    robot: Robot, shapes: Sequence[Collision] | Sequence[Visual]
) -> tuple[Array, Array] | None:
    """Compute the bounding box of shapes in their link's frame: lower and upper corner [m].

    None if no shape can be read.
    """
    found = [
        corners for shape in shapes if (corners := get_shape_corners(robot, shape)) is not None
    ]
    if not found:
        return None
    points = np.concatenate(found)
    return points.min(axis=0), points.max(axis=0)


def _compute_volume(shape: Collision | Visual, points: Array) -> float:
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
    found = compute_convex_hull(points)
    return 0.0 if found is None else found.volume()
