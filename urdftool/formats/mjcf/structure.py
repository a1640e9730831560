"""The kinematic tree for MuJoCo: joint kinds, rigid groups of links, and the kind of base."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ...model.elements import Joint, Link, Robot
from ...model.kinematics import compute_motion, link_poses
from ...model.pose import Pose, compute_norm, make_pose
from ..common.lumping import LumpingPlan, plan_lumping

WORLD = "world"
"""A root link of this name is MuJoCo's world."""

ZERO_AXIS = 1e-6
"""Length of an axis below which it has no direction; chosen, no source."""

KINDS = {
    "revolute": "hinge",
    "continuous": "hinge",
    "prismatic": "slide",
    "planar": "planar",
    "floating": "free",
    "spherical": "ball",
    "ball": "ball",
    "fixed": "weld",
}
"""MuJoCo's joint kind for each URDF joint type; other types are welded."""


@dataclass(frozen=True, eq=False)
class Structure:
    """The kinematic tree as MuJoCo represents it.

    Attributes:
        robot: The robot, whose tree has one root.
        root: Its root link.
        free: Whether the base floats.
        reason: Why it does or does not, as text.
        keep_locked: Whether a joint with equal limits stays a joint, held by an equality.
    """

    robot: Robot
    root: Link
    free: bool
    reason: str
    keep_locked: bool = False

    @property
    def in_world(self) -> bool:
        """Tell whether the root link is the world instead of a body."""
        return self.root.name == WORLD

    def get_kind(self, joint: Joint) -> str:
        """Return the kind of a joint: one of the values of ``KINDS``."""
        if joint.name in self.locked:
            return "weld"
        if joint.has_axis and joint.axis is not None and compute_norm(joint.axis.xyz) < ZERO_AXIS:
            return "weld"
        return KINDS.get(joint.type, "weld")

    def is_single(self, joint: Joint) -> bool:
        """Tell whether a joint has one position, which actuators and equalities can set."""
        return self.get_kind(joint) in ("hinge", "slide")

    @cached_property
    def locked(self) -> dict[str, float]:
        """Return the position [rad or m] of each joint that is welded for its equal limits."""
        if self.keep_locked:
            return {}
        positions = ((joint.name, get_locked_at(joint)) for joint in self.robot.joints)
        return {name: position for name, position in positions if position is not None}

    def compute_joint_pose(self, joint: Joint) -> Pose:
        """Compute the pose of a joint's child in its parent, at the locked position or at zero."""
        return make_pose(joint.origin) @ compute_motion(joint, self.locked.get(joint.name, 0.0))

    @cached_property
    def joints(self) -> list[Joint]:
        """Return the joints to parents, in the order of MuJoCo's bodies."""
        tree = self.robot.tree
        return [joint for link in tree.order if (joint := tree.get_parent_joint(link)) is not None]

    @cached_property
    def moving(self) -> list[Joint]:
        """Return the joints that are not welded, in MuJoCo's order."""
        return [joint for joint in self.joints if self.get_kind(joint) != "weld"]

    @cached_property
    def _lumping(self) -> LumpingPlan:
        links = (self.root.name, *(joint.child for joint in self.joints))
        return plan_lumping(
            self.robot, links, lambda joint: self.get_kind(joint) == "weld", self.compute_joint_pose
        )

    @property
    def group(self) -> dict[str, str]:
        """Return the topmost link of each link's rigid body."""
        return self._lumping.top

    @cached_property
    def members(self) -> dict[str, list[Link]]:
        """Return the links of each rigid body, by its topmost link, which comes first."""
        bodies = self._lumping.members.items()
        return {top: [self.robot.link[name] for name in names] for top, names in bodies}

    def is_static(self, link: str) -> bool:
        """Tell whether a link is rigidly attached to the world."""
        return not self.free and self.group[link] == self.root.name

    def get_pose_in_group(self, link: str) -> Pose:
        """Return the pose of a link in the frame of its rigid body's topmost link."""
        return self._lumping.pose[link]

    @cached_property
    def _poses(self) -> dict[str, Pose]:
        return link_poses(self.robot, self.locked)

    def get_pose_at_zero(self, link: str) -> Pose:
        """Return the pose of a link in the root's frame with every joint at zero or its lock."""
        return self._poses[link]

    def get_body_name(self, link: str) -> str:
        """Return the name of a link's body; MuJoCo reserves the name ``world``."""
        return f"{WORLD}_link" if link == WORLD and link != self.root.name else link

    @cached_property
    def depth(self) -> dict[str, int]:
        """Return the nesting level of each link's body below the world."""
        found = {self.root.name: 1}
        for joint in self.joints:
            found[joint.child] = found[joint.parent] + 1
        return found


def get_bounds(joint: Joint) -> tuple[float, float] | None:
    """Return lower and upper limit [rad or m]; None for an unlimited joint.

    A missing limit counts as zero, as the URDF specification defines, unless the other is missing
    too and the joint has an effort or velocity.
    """
    if not joint.is_limited or joint.limit is None or joint.turns_freely:
        return None
    return joint.limit.lower or 0.0, joint.limit.upper or 0.0


def get_locked_at(joint: Joint) -> float | None:
    """Return the position of a joint with equal limits [rad or m]; None if it can move."""
    limits = get_bounds(joint)
    return limits[0] if limits is not None and limits[0] == limits[1] else None


def create_structure(robot: Robot, *, keep_locked: bool = False) -> Structure:
    """Create the structure of a robot with one root, with a fixed base."""
    return Structure(robot, robot.tree.roots[0], False, "", keep_locked)
