"""Support of a robot by the ground: contact points, support polygon, center of mass."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ...model.elements import Robot, Vector
from ...model.pose import Pose, make_pose
from .rigid_tree import RigidTree
from .shape_box import ShapeBoxes

Array = npt.NDArray[np.float64]

TILT = 0.02
"""Tilt of the ground [rad] by which all corners of a sole become contact points; chosen, no
source."""

CONTACT = 0.002
"""Height above the lowest point [m] up to which a point carries the robot; chosen, no source."""

_AZIMUTHS = [math.pi * number / 8 for number in range(16)]


def list_contact_points(
    tree: RigidTree, boxes: ShapeBoxes, body: str, poses: Mapping[str, Pose]
) -> Array:
    """List the points with which a rigid body touches the ground below it.

    Returns:
        Points [m] of shape (n, 3), within ``CONTACT`` above the lowest.
    """
    points = np.array(
        [
            point
            for link in tree.members[body]
            for shape in link.collisions
            for way in _list_ways_down()
            if (point := boxes.find_outermost(shape, poses[link.name], way)) is not None
        ]
    ).reshape(-1, 3)
    lowest = points[:, 2].min(initial=math.inf)
    near: Array = np.unique(points[points[:, 2] <= lowest + CONTACT], axis=0)
    return near


def _list_ways_down() -> Iterator[Vector]:
    """Yield directions around straight down."""
    yield 0.0, 0.0, -1.0
    for angle in _AZIMUTHS:
        yield math.sin(TILT) * math.cos(angle), math.sin(TILT) * math.sin(angle), -math.cos(TILT)


def list_support_points(
    tree: RigidTree, boxes: ShapeBoxes, poses: Mapping[str, Pose], level: float = CONTACT
) -> Array:
    """List the points with which a robot touches the ground below it; shape (n, 3).

    Points up to ``level`` [m] above the lowest count.
    """
    found = [list_contact_points(tree, boxes, body, poses) for body in tree.members]
    points = np.concatenate(found) if found else np.zeros((0, 3))
    lowest = points[:, 2].min(initial=math.inf)
    near: Array = points[points[:, 2] <= lowest + level]
    return near


def compute_center(robot: Robot, poses: Mapping[str, Pose]) -> Vector | None:
    """Compute the center of mass of a robot [m]; None without mass."""
    masses = [
        (link.mass, (poses[link.name] @ make_pose(link.inertial.origin)).translation)
        for link in robot.links
        if link.inertial is not None and link.mass > 0
    ]
    total = math.fsum(mass for mass, _ in masses)
    if not total:
        return None
    x, y, z = (math.fsum(mass * at[axis] for mass, at in masses) / total for axis in range(3))
    return x, y, z


def compute_margin(points: Iterable[Sequence[float]], center: Sequence[float]) -> float:
    """Compute the distance of a point from the edge of a support polygon [m], in the plane.

    Args:
        points: Points with x and y first [m].
        center: A point with x and y first [m].

    Returns:
        A distance below zero outside the polygon; minus infinity without points.
    """
    hull = _make_hull({(float(x), float(y)) for x, y, *_ in points})
    x, y = float(center[0]), float(center[1])
    if len(hull) < 3:
        return -min((_measure_distance(a, b, (x, y)) for a in hull for b in hull), default=math.inf)
    edges = list(zip(hull, [*hull[1:], hull[0]], strict=True))
    if all(_compute_turn(a, b, (x, y)) >= 0 for a, b in edges):
        return min(_measure_distance(a, b, (x, y)) for a, b in edges)
    return -min(_measure_distance(a, b, (x, y)) for a, b in edges)


_Flat = tuple[float, float]


def _compute_turn(a: _Flat, b: _Flat, c: _Flat) -> float:
    """Return twice the signed area of a triangle, above zero if it is counterclockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _measure_distance(a: _Flat, b: _Flat, point: _Flat) -> float:
    """Return the distance of a point from the line segment between two points."""
    along = (b[0] - a[0], b[1] - a[1])
    square = along[0] ** 2 + along[1] ** 2
    part = 0.0
    if square:
        part = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / square
    part = min(max(part, 0.0), 1.0)
    return math.hypot(a[0] + part * along[0] - point[0], a[1] + part * along[1] - point[1])


def _make_hull(points: Iterable[_Flat]) -> list[_Flat]:
    """Return the corners of the convex hull, counterclockwise (monotone chain of Andrew, 1979)."""
    ordered = sorted(points)
    if len(ordered) < 3:
        return ordered
    halves = []
    for some in (ordered, ordered[::-1]):
        half: list[_Flat] = []
        for point in some:
            while len(half) > 1 and _compute_turn(half[-2], half[-1], point) <= 0:
                half.pop()
            half.append(point)
        halves.append(half[:-1])
    return [*halves[0], *halves[1]]
