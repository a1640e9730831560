"""Measure interpenetration: the penetration depth of links, by the triangles of their meshes.

Engines use the convex hull of a mesh, which fills concave parts such as a gripper's jaw. The depth
is that of points of one surface inside the other, by the winding number of its triangles.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property

import numpy as np

from ..errors import UrdftoolError
from ..inertia.winding import Boxes, compute_winding_numbers, sort_into_boxes
from ..model.elements import Collision, Mesh, Plane, Robot, Visual
from ..model.pose import Pose, make_pose
from .mesh_cache import compute_once, load_triangles
from .recording import Array
from .shapes import compute_hull
from .state import StateSnapshot

POINTS = 1500
"""Maximum number of corners of a surface that are tested, and half the number of other points.
Chosen, no source.
"""

_BLOCK = 64  # points whose distances to all others fit in the processor cache
_FIRST = 32
"""Points in the first batch of winding numbers. Chosen, no source."""


def measure_penetration_depth(
    robot: Robot, snapshot: StateSnapshot, one: str, other: str, least: float = 0.0
) -> float | None:
    """Measure the penetration depth of two links [m]; None if that of the engine is exact."""
    pairs = [robot.link[name].collisions for name in (one, other)]
    if not any(isinstance(shape.geometry, Mesh) for shapes in pairs for shape in shapes):
        return None
    poses = {name: snapshot.link_pose(name) for name in (one, other)}
    return measure_triangle_penetration(robot, poses, one, other, least)


def measure_triangle_penetration(
    robot: Robot, poses: Mapping[str, Pose], one: str, other: str, least: float = 0.0
) -> float | None:
    """Measure the penetration depth of two links by triangles [m]; None if a mesh cannot be read.

    Planes, which have no triangles, are left out.
    """
    try:
        mine, others = (
            [
                (_make_surface(robot, shape), poses[name] @ make_pose(shape.origin))
                for shape in robot.link[name].collisions
                if not isinstance(shape.geometry, Plane)
            ]
            for name in (one, other)
        )
    except UrdftoolError:
        return None
    return max((_measure_deepest(*a, *b, least) for a in mine for b in others), default=0.0)


class Surface:
    """Triangles of a shape, in its own frame.

    Attributes:
        triangles: Corners of the triangles [m], shape (n, 3, 3).
        low: Lower corner of their bounding box [m].
        high: Upper corner of their bounding box [m].
    """

    def __init__(self, triangles: Array) -> None:
        """Store the triangles, and compute their bounding box."""
        self.triangles = triangles
        self.low, self.high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))

    @cached_property
    def points(self) -> Array:
        """Return points spread over the triangles [m], shape (n, 3)."""
        return _spread_points(self.triangles)

    @cached_property
    def boxes(self) -> Boxes:
        """Return the triangles, sorted for the computation of winding numbers."""
        return sort_into_boxes(self.triangles)


def _make_surface(robot: Robot, shape: Collision) -> Surface:
    geometry = shape.geometry
    if not isinstance(geometry, Mesh):
        return Surface(tessellate_primitive_triangles(shape))

    def make() -> Surface:
        mesh = load_triangles(robot, geometry)
        return Surface(mesh.vertices[mesh.faces])

    return compute_once(robot, ("surface", geometry.filename, geometry.scale), make)


def tessellate_primitive_triangles(shape: Collision | Visual) -> Array:
    """Tessellate a box, cylinder, sphere or capsule about its origin, shape (n, 3, 3)."""
    geometry = shape.geometry
    size = getattr(geometry, "size", None)
    if size is not None:
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        points = signs * np.array(size) / 2
    else:
        radius = getattr(geometry, "radius", 0.0)
        length = getattr(geometry, "length", 0.0)
        around = np.linspace(0, 2 * np.pi, 24, endpoint=False)
        ring = np.stack([np.cos(around), np.sin(around), np.zeros(24)], axis=1) * radius
        up = np.array([0.0, 0.0, length / 2])
        points = np.concatenate([ring + up, ring - up])
        if type(geometry).__name__ != "Cylinder":
            rise = np.linspace(0, np.pi / 2, 7)[1:]
            caps = [ring * np.cos(a) + [0.0, 0.0, radius * np.sin(a)] for a in rise]
            cap = np.concatenate(caps)
            points = np.concatenate([points, cap + up, cap * [1.0, 1.0, -1.0] - up])
    corners, faces = compute_hull(points)
    triangles: Array = corners[faces]
    return triangles


def _measure_deepest(one: Surface, at: Pose, other: Surface, there: Pose, least: float) -> float:
    """Measure the penetration depth of two surfaces at poses in the world [m]."""
    return max(
        _measure_inside(one, other, there.invert() @ at, least),
        _measure_inside(other, one, at.invert() @ there, least),
    )


def _measure_inside(one: Surface, other: Surface, pose: Pose, least: float) -> float:
    """Measure the depth of the deepest point of one surface inside another [m].

    Distances are fast to compute and winding numbers are not, so points are tested in order of
    their distance, and the first one inside is the deepest.

    Args:
        one: Surface whose points are tested.
        other: Surface around them.
        pose: Pose of ``one`` in the frame of ``other``.
        least: A smaller depth may be returned as 0 [m].
    """
    points = one.points @ np.array(pose.rotation).T + np.array(pose.translation)
    points = points[((points >= other.low) & (points <= other.high)).all(axis=1)]
    if not len(points):
        return 0.0
    squares = _compute_nearest_squared(points, other.points)
    far = np.flatnonzero(squares >= least**2)
    far = far[np.argsort(-squares[far], kind="stable")]
    first, count = 0, _FIRST
    while first < len(far):
        some = far[first : first + count]
        inside = np.flatnonzero(compute_winding_numbers(points[some], other.boxes) > 0.5)
        if len(inside):
            return math.sqrt(squares[some[inside[0]]])
        first, count = first + count, 2 * count
    return 0.0


def _compute_nearest_squared(points: Array, others: Array) -> Array:
    """Compute the squared distance from each point to the nearest other [m²], shape (n,)."""
    middle = others.mean(axis=0)  # centered coordinates keep the precision of squares
    points, others = points - middle, others - middle
    ones = np.column_stack([points, np.ones(len(points))])
    minus = np.vstack([-2 * others.T, (others**2).sum(axis=1)])
    room = np.empty((_BLOCK, len(others)))  # allocating it in the loop dominates the time
    nearest: Array = (points**2).sum(axis=1)
    for first in range(0, len(points), _BLOCK):
        some = ones[first : first + _BLOCK]
        squares = np.matmul(some, minus, out=room[: len(some)])
        nearest[first : first + _BLOCK] += squares.min(axis=1)
    return np.maximum(nearest, 0.0, out=nearest)


def _sort_distinct(points: Array) -> Array:
    """Sort points by coordinates, without duplicates; three times as fast as ``numpy.unique``."""
    points = points[np.lexsort(points.T[::-1])]
    new = np.append(True, (points[1:] != points[:-1]).any(axis=1))
    distinct: Array = points[new]
    return distinct


def _spread_points(triangles: Array) -> Array:
    """Spread points over triangles in proportion to area, and add corners, with a fixed seed."""
    edges = triangles[:, 1:] - triangles[:, :1]
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    corners = _sort_distinct(triangles.reshape(-1, 3))
    if len(corners) > POINTS:
        corners = corners[:: len(corners) // POINTS + 1]
    if not areas.sum() > 0:
        return corners
    chance = np.random.default_rng(0)
    chosen = chance.choice(len(triangles), size=2 * POINTS, p=areas / areas.sum())
    u, v = chance.random((2, 2 * POINTS, 1))
    beyond = (u + v) > 1
    u, v = np.where(beyond, 1 - u, u), np.where(beyond, 1 - v, v)
    spread = triangles[chosen, 0] + u * edges[chosen, 0] + v * edges[chosen, 1]
    points: Array = np.concatenate([corners, spread])
    return points
