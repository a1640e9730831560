"""Rigid bodies of a robot, and the joints with one position that move them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property

from ..model.elements import Joint, Robot
from ..model.kinematics import find_movable_joints


class BodyTree:
    """Tree of the rigid bodies of a robot.

    A body is named for its topmost link. A joint with several positions, such as a floating one,
    ends the tree: the body below it is a root.

    Attributes:
        robot: The robot.
        active: Names of the joints with one position that do not mimic another.
    """

    def __init__(self, robot: Robot) -> None:
        """Index the bodies and joints of a robot."""
        self.robot = robot
        movable = find_movable_joints(robot)
        self.active = {
            joint.name
            for joint in movable.values()
            if joint.mimic is None or joint.mimic.joint not in movable
        }
        self._above: dict[str, Joint] = {}
        self._below: dict[str, list[Joint]] = {}
        bodies = robot.tree.bodies
        for body in self.order:
            joint = robot.tree.get_parent_joint(body)
            if joint is not None and joint.name in movable and joint.parent in bodies:
                self._above[body] = joint
                self._below.setdefault(bodies[joint.parent], []).append(joint)

    @cached_property
    def order(self) -> list[str]:
        """Return the names of all bodies, parents first."""
        bodies = self.robot.tree.bodies
        return [name for name in self.robot.tree.order if bodies[name] == name]

    def get_body(self, link: str) -> str:
        """Return the name of the body of a link."""
        return self.robot.tree.bodies[link]

    def get_links(self, body: str) -> list[str]:
        """Return the names of the links of a body, its topmost link first."""
        return self.robot.tree.body_links[body]

    def get_joint_above(self, body: str) -> Joint | None:
        """Return the joint that moves a body; None for a root."""
        return self._above.get(body)

    def get_joints_below(self, body: str) -> list[Joint]:
        """Return the joints that move the children of a body, in the order of the file."""
        return self._below.get(body, [])

    def is_active(self, joint: Joint) -> bool:
        """Tell whether a joint has one position and does not mimic another."""
        return joint.name in self.active

    def list_joints_within(self, joint: Joint) -> Iterator[Joint]:
        """Yield a joint and all joints below it."""
        todo = [joint]
        while todo:
            one = todo.pop()
            yield one
            todo += reversed(self.get_joints_below(one.child))

    def list_joints_above(self, body: str) -> list[Joint]:
        """List the joints from a body up to its root, the nearest first."""
        found: list[Joint] = []
        while (joint := self.get_joint_above(body)) is not None:
            found.append(joint)
            body = self.get_body(joint.parent)
        return found

    def measure_reach(self, joint: Joint) -> float:
        """Measure the largest distance along the links from the child of a joint to a leaf [m]."""
        reaches = {joint.child: 0.0}
        for link in self.robot.tree.list_descendants(joint.child):
            above = self.robot.tree.get_parent_joint(link)
            if above is not None and above.parent in reaches:
                xyz = above.origin.xyz if above.origin is not None else (0.0, 0.0, 0.0)
                reaches[link] = reaches[above.parent] + math.hypot(*xyz)
        return max(reaches.values())
