"""Whether parts whose hulls are in each other are so themselves: by their own triangles.

Engines collide the convex hull of a mesh, and a gripper's jaw or a torso's hollow is filled by it.
Points of one surface that lie inside the other, by the winding number of its triangles, tell.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..errors import UrdftoolError
from ..inertia.winding import boxes_of, winding_numbers
from ..meshes.load import load_named
from ..model.elements import Collision, Mesh, Robot, Visual
from ..model.pose import Pose, pose_of
from .recording import Array
from .run import Run, body_pose
from .shapes import hull

POINTS = 1500
"""Points of a surface that are tried."""

_AT_ONCE = 64  # points whose distances to all others fit in the cache


def overlap(robot: Robot, run: Run, frame: int, one: str, other: str) -> float | None:
    """How deep two links are in each other [m]; None where the engine's own answer is exact.

    Args:
        robot: The robot, which finds its meshes.
        run: The run.
        frame: Which sample of its recording.
        one: A link.
        other: Another, of another body.
    """
    pairs = [robot.link[name].collisions for name in (one, other)]
    if not any(isinstance(shape.geometry, Mesh) for shapes in pairs for shape in shapes):
        return None
    try:
        mine, others = (
            list(_surfaces(robot, shapes, _pose(run, frame, name)))
            for shapes, name in zip(pairs, (one, other), strict=True)
        )
    except UrdftoolError:
        return None
    return max((_deepest(a, b) for a in mine for b in others), default=0.0)


def _pose(run: Run, frame: int, link: str) -> Pose:
    """Where a link is in the world."""
    bodies = run.bodies.bodies
    number = next(index for index, body in enumerate(bodies) if link in body.links)
    return body_pose(run, number, frame) @ bodies[number].places[link]


def _surfaces(robot: Robot, shapes: list[Collision], at: Pose) -> Iterator[Array]:
    """Triangles of each shape in the world, shape (n, 3, 3)."""
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            assert robot.source is not None
            mesh = load_named(robot.source, shape.geometry.filename, shape.geometry.scale)
            corners = mesh.vertices[mesh.faces]
        else:
            corners = primitive_triangles(shape)
        pose = at @ pose_of(shape.origin)
        yield corners @ np.array(pose.rotation).T + np.array(pose.translation)


def primitive_triangles(shape: Collision | Visual) -> Array:
    """Triangles of a box, cylinder, sphere or capsule about its own origin, shape (n, 3, 3)."""
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
    corners, faces = hull(points)
    triangles: Array = corners[faces]
    return triangles


def _deepest(one: Array, other: Array) -> float:
    low = np.maximum(one.min(axis=(0, 1)), other.min(axis=(0, 1)))
    high = np.minimum(one.max(axis=(0, 1)), other.max(axis=(0, 1)))
    if (low > high).any():
        return 0.0
    return max(_inside(one, other, low, high), _inside(other, one, low, high))


def _inside(one: Array, other: Array, low: Array, high: Array) -> float:
    """How far points of one surface get into the other, looked for in a box that both share."""
    points = _points(one)
    points = points[((points >= low) & (points <= high)).all(axis=1)]
    if not len(points):
        return 0.0
    points = points[winding_numbers(points, boxes_of(other)) > 0.5]
    if not len(points):
        return 0.0
    return math.sqrt(max(_nearest_squared(points, _points(other))))


def _nearest_squared(points: Array, others: Array) -> Iterator[float]:
    """The squared distance from each point to the nearest of others [m²]."""
    middle = others.mean(axis=0)  # about which squares lose no digits
    points, others = points - middle, (others - middle).T
    squares = (others**2).sum(axis=0)
    for first in range(0, len(points), _AT_ONCE):
        some = points[first : first + _AT_ONCE]
        nearest = (squares - 2 * some @ others).min(axis=1) + (some**2).sum(axis=1)
        yield from np.maximum(0.0, nearest).tolist()


def _points(triangles: Array) -> Array:
    """Points spread over triangles by their area, and their corners, the same each time."""
    edges = triangles[:, 1:] - triangles[:, :1]
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    corners = np.unique(triangles.reshape(-1, 3), axis=0)
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
