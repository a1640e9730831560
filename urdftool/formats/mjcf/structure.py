"""What hangs on what: kinds of joints, rigid groups of links, and what the root stands on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ...model.elements import Joint, Link, Robot
from ...model.kinematics import link_poses, motion_of
from ...model.pose import Pose, norm, pose_of
from ..common.lumping import LumpingPlan, plan_lumping

WORLD = "world"
"""The root link of this name is MuJoCo's world itself."""

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
"""What each type of joint becomes; any other is welded."""


@dataclass(frozen=True, eq=False)
class Structure:
    """The tree as MuJoCo sees it.

    Attributes:
        robot: The robot, whose tree has one root.
        root: Its root link.
        free: Whether the root moves freely.
        reason: Why it does or does not, in words.
        keep_locked: Whether a joint with equal limits stays a joint, held by an equality.
    """

    robot: Robot
    root: Link
    free: bool
    reason: str
    keep_locked: bool = False

    @property
    def in_world(self) -> bool:
        """Whether the root link is the world itself, and no body."""
        return self.root.name == WORLD

    def kind(self, joint: Joint) -> str:
        """What a joint becomes: one of the values of ``KINDS``."""
        if joint.name in self.locked:
            return "weld"
        if joint.has_axis and joint.axis is not None and norm(joint.axis.xyz) < 1e-6:
            return "weld"
        return KINDS.get(joint.type, "weld")

    @cached_property
    def locked(self) -> dict[str, float]:
        """The position [rad or m] of each joint that is welded because its limits are equal."""
        if self.keep_locked:
            return {}
        positions = ((joint.name, locked_at(joint)) for joint in self.robot.joints)
        return {name: position for name, position in positions if position is not None}

    def joint_pose(self, joint: Joint) -> Pose:
        """Compute the pose of a joint's child in its parent: at the joint's lock, or at zero."""
        return pose_of(joint.origin) @ motion_of(joint, self.locked.get(joint.name, 0.0))

    @cached_property
    def joints(self) -> list[Joint]:
        """Each link's joint to its parent, in the order of MuJoCo's bodies."""
        tree = self.robot.tree
        return [joint for link in tree.order if (joint := tree.parent_joint(link)) is not None]

    @cached_property
    def moving(self) -> list[Joint]:
        """The joints that MuJoCo has, in its order."""
        return [joint for joint in self.joints if self.kind(joint) != "weld"]

    @cached_property
    def _lumping(self) -> LumpingPlan:
        links = (self.root.name, *(joint.child for joint in self.joints))
        return plan_lumping(
            self.robot, links, lambda joint: self.kind(joint) == "weld", self.joint_pose
        )

    @property
    def group(self) -> dict[str, str]:
        """Return for each link the topmost link of the rigid body it belongs to."""
        return self._lumping.top

    @cached_property
    def members(self) -> dict[str, list[Link]]:
        """Return the links of each rigid body, by its topmost link, which is the first."""
        bodies = self._lumping.members.items()
        return {top: [self.robot.link[name] for name in names] for top, names in bodies}

    def is_static(self, link: str) -> bool:
        """Whether a link is held by the world."""
        return not self.free and self.group[link] == self.root.name

    def pose_in_group(self, link: str) -> Pose:
        """Return the pose of a link in the frame of its rigid body's topmost link."""
        return self._lumping.pose[link]

    @cached_property
    def _poses(self) -> dict[str, Pose]:
        return link_poses(self.robot, self.locked)

    def pose_at_zero(self, link: str) -> Pose:
        """Return the pose of a link in the root's frame with every joint at zero or its lock."""
        return self._poses[link]

    def body_name(self, link: str) -> str:
        """The name of a link's body: MuJoCo keeps that of its world to itself."""
        return f"{WORLD}_link" if link == WORLD and link != self.root.name else link

    @cached_property
    def depth(self) -> dict[str, int]:
        """How many bodies each link is below the world."""
        found = {self.root.name: 1}
        for joint in self.joints:
            found[joint.child] = found[joint.parent] + 1
        return found


def bounds(joint: Joint) -> tuple[float, float] | None:
    """Lower and upper limit [rad or m]; None for a joint without.

    A limit that is not written counts as zero, as the specification has it.
    """
    if not joint.is_limited or joint.limit is None:
        return None
    return joint.limit.lower or 0.0, joint.limit.upper or 0.0


def locked_at(joint: Joint) -> float | None:
    """The position that equal limits leave to a joint; None if it can move."""
    limits = bounds(joint)
    return limits[0] if limits is not None and limits[0] == limits[1] else None


def structure_of(robot: Robot, *, keep_locked: bool = False) -> Structure:
    """Make the structure of a robot with one root, which is held.

    Args:
        robot: The robot.
        keep_locked: Whether joints with equal limits stay joints.
    """
    return Structure(robot, robot.tree.roots[0], False, "", keep_locked)
