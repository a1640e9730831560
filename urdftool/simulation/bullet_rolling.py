"""Wheels that roll as wheels do: PyBullet's memory of contacts would push them on.

It keeps the points where a round body touched until they have left the floor. Those lie behind the
axle, and what they carry there drives the wheel: it accelerates on the level. Forgotten before each
step, there is one new point a step, below the axle. What stands on its flat end needs several
points, and keeps them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .bodies import Body
from .recording import Array

ROUND = ("cylinder", "capsule", "sphere")

LYING = 0.5
"""The upright part of an axis that still counts as lying: of 30° from the plane."""


NEARING = 0.05
"""How near to the plane a body is that may touch it before it is looked at again [m]."""


def round_part(body: Body) -> tuple[Array, float] | None:
    """The axes of a body's round shapes in its frame, shape (n, 3), and how far they reach [m].

    None where shapes that are not round touch, too.
    """
    if not body.shapes or any(shape.kind not in ROUND for shape in body.shapes):
        return None
    axes = [np.array(shape.pose.rotation)[:, 2] for shape in body.shapes if shape.kind != "sphere"]
    if not axes:
        return None
    corners = [np.maximum(*map(np.abs, shape.bounds())) for shape in body.shapes]
    return np.array(axes), max(float(np.linalg.norm(corner)) for corner in corners)


def is_lying(axes: Array, turn: Array) -> bool:
    """Whether all axes of a body lie along the plane.

    Args:
        axes: In the body's frame, shape (n, 3).
        turn: The body in the world, a quaternion x, y, z, w, shape (4,).
    """
    x, y, z, w = turn.tolist()
    up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    return bool((np.abs(axes @ up) <= LYING).all())


def forget_contacts(p: Any, robot: int, plane: int, links: Sequence[int]) -> None:
    """Forget where links touched the plane.

    Args:
        p: PyBullet.
        robot: Its number of the robot.
        plane: Its number of the plane.
        links: Its numbers of the links.
    """
    for link in links:
        p.setCollisionFilterPair(robot, plane, link, -1, 0)
        p.setCollisionFilterPair(robot, plane, link, -1, 1)
