"""Read contacts from PyBullet by the links of the file, and clear those of rolling wheels.

PyBullet keeps the contact points of a round body until they separate from the plane. They are
behind the axle, and their load accelerates the wheel on a level plane. If they are removed before
each step, there is one new point below the axle in each step. A body on its flat end requires
several points, and keeps them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...recording import GROUND, Array, Contact
from ...rigid_bodies import RigidBody, RigidBodyModel

_NEAR = 1e-4
"""M; with a distance of zero, it finds nothing between two boxes. Chosen, no source."""


class ContactReader:
    """Contacts of one robot."""

    def __init__(
        self, p: Any, robot: int, plane: int, bodies: RigidBodyModel, link_of: Mapping[int, int]
    ) -> None:
        """Store the engine's indices of a robot and a plane, and its link of each body."""
        self.p, self.robot, self.plane = p, robot, plane
        self.bodies, self.link_of = bodies, link_of
        self.body_of = {link: body for body, link in link_of.items()}

    def list_contacts(self) -> list[Contact]:
        """List the contacts with the plane."""
        return [
            self._make_contact(point, GROUND)
            for point in self.p.getContactPoints(bodyA=self.robot, bodyB=self.plane)
        ]

    def _make_contact(self, point: Any, other: str) -> Contact:
        return Contact(
            self._link(self.body_of[point[3]], point[5]),
            other,
            -point[8],
            point[9],
            tuple(point[6]),
            tuple(point[7]),
        )

    def _link(self, number: int, at: tuple[float, float, float]) -> str:
        """Find the link of a body whose shape is nearest to a point in the world."""
        body = self.bodies.bodies[number]
        if len({shape.link for shape in body.shapes}) < 2:
            return body.shapes[0].link if body.shapes else body.name
        where, turn = self.get_frame(number)
        local, _ = self.p.multiplyTransforms(*self.p.invertTransform(where, turn), at, (0, 0, 0, 1))

        def distance(shape: Any) -> float:
            low, high = shape.get_bounds()
            outside = np.maximum(0.0, np.maximum(low - local, np.array(local) - high))
            return float(np.linalg.norm(outside))

        return min(body.shapes, key=distance).link

    def get_frame(self, number: int) -> tuple[Any, Any]:
        """Return position [m] and quaternion x, y, z, w of a body's link frame in the world."""
        if number:
            state = self.p.getLinkState(self.robot, self.link_of[number])
            return state[4], state[5]
        at, turn = self.p.getBasePositionAndOrientation(self.robot)
        back = self.p.getDynamicsInfo(self.robot, -1)
        where: tuple[Any, Any] = self.p.multiplyTransforms(
            at, turn, *self.p.invertTransform(back[3], back[4])
        )
        return where

    def find_overlaps(self, *, ground: bool = True) -> list[Contact]:
        """Find the interpenetration of each pair of bodies, whether or not contacts are enabled."""
        p, found = self.p, []
        solid = [n for n, body in enumerate(self.bodies.bodies) if body.shapes]
        boxes = {n: np.array(p.getAABB(self.robot, self.link_of[n])) for n in solid}
        for position, one in enumerate(solid):
            for other in solid[:position]:
                a, b = boxes[one], boxes[other]
                if (a[0] > b[1]).any() or (b[0] > a[1]).any():
                    continue
                points = p.getClosestPoints(
                    self.robot, self.robot, _NEAR, self.link_of[one], self.link_of[other]
                )
                if points and min(point[8] for point in points) < 0:
                    deepest = min(points, key=lambda point: point[8])
                    name = self._link(other, deepest[6])
                    found.append(self._make_contact(deepest, name))
            if ground and boxes[one][0][2] < 0:
                points = p.getClosestPoints(self.robot, self.plane, _NEAR, self.link_of[one], -1)
                if points:
                    found.append(
                        self._make_contact(min(points, key=lambda point: point[8]), GROUND)
                    )
        return found


ROUND = ("cylinder", "capsule", "sphere")

LYING = 0.5
"""Largest vertical component of the unit axis of a rolling body: 30° from the plane. Chosen, no
source.
"""


NEARING = 0.05
"""Distance from the plane below which a body may make contact before the next sample [m]."""


def round_part(body: RigidBody) -> tuple[Array, float] | None:
    """Find the axes of a body's round shapes in its frame, (n, 3), and their reach [m].

    None if the body has other shapes, too.
    """
    if not body.shapes or any(shape.kind not in ROUND for shape in body.shapes):
        return None
    axes = [np.array(shape.pose.rotation)[:, 2] for shape in body.shapes if shape.kind != "sphere"]
    if not axes:
        return None
    corners = [np.maximum(*map(np.abs, shape.get_bounds())) for shape in body.shapes]
    return np.array(axes), max(float(np.linalg.norm(corner)) for corner in corners)


def is_lying(axes: Array, turn: Array) -> bool:
    """Tell whether all axes of a body are near the plane's directions.

    Args:
        axes: Unit axes in the body's frame, shape (n, 3).
        turn: Orientation of the body in the world, quaternion x, y, z, w, shape (4,).
    """
    x, y, z, w = turn.tolist()
    up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    return bool((np.abs(axes @ up) <= LYING).all())


def forget_contacts(p: Any, robot: int, plane: int, links: Sequence[int]) -> None:
    """Clear the contact points of links with the plane.

    Links without one are left alone: to clear them disturbs the contacts of the other links.
    """
    for link in links:
        if not p.getContactPoints(robot, plane, link, -1):
            continue
        p.setCollisionFilterPair(robot, plane, link, -1, 0)
        p.setCollisionFilterPair(robot, plane, link, -1, 1)
