"""The rigid bodies of a robot as a tree, for decisions that all writers share."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from ...model.elements import Joint, Link, Robot
from .lumping import plan_lumping


class RigidTree(Protocol):
    """The rigid bodies of a robot, whose tree has one root."""

    @property
    def robot(self) -> Robot:
        """Return the robot."""

    @property
    def root(self) -> Link:
        """Return its root link."""

    @property
    def moving(self) -> Sequence[Joint]:
        """Return the joints that move, parents first."""

    @property
    def group(self) -> Mapping[str, str]:
        """Return the topmost link of each link's rigid body."""

    @property
    def members(self) -> Mapping[str, Sequence[Link]]:
        """Return the links of each rigid body, by its topmost link, which comes first."""


@dataclass(frozen=True)
class RigidGroups:
    """A :class:`RigidTree` as plain values.

    Attributes:
        robot: The robot.
        root: Its root link.
        moving: The joints that move, parents first.
        group: Topmost link of each link's rigid body.
        members: Links of each rigid body by its topmost link, which comes first.
    """

    robot: Robot
    root: Link
    moving: Sequence[Joint]
    group: Mapping[str, str]
    members: Mapping[str, Sequence[Link]]


def group_rigid_links(robot: Robot, is_movable: Callable[[Joint], bool]) -> RigidGroups:
    """Group the links of a robot with one root by joints that do not move."""
    plan = plan_lumping(robot, robot.tree.order, lambda joint: not is_movable(joint))
    parents = (robot.tree.get_parent_joint(name) for name in robot.tree.order)
    moving = [joint for joint in parents if joint is not None and is_movable(joint)]
    members = {top: [robot.link[name] for name in names] for top, names in plan.members.items()}
    return RigidGroups(robot, robot.tree.roots[0], moving, plan.top, members)
