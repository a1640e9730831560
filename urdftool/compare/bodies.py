"""Rigid bodies of a robot: links that fixed joints connect."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import ModelError
from ..mechanics.reference import Array, get_origin_matrix, turn
from ..model.elements import Joint, Link, Robot
from ..model.kinematics import get_limits
from ..model.mechanism import Frame
from ..model.world import WORLD

HINGES = ("revolute", "continuous")


@dataclass
class Body:
    """Links without relative motion.

    Attributes:
        name: Name of the topmost link, whose frame is that of the body.
        joint: Joint that moves the body; None for the root.
        parent: Name of the parent body; empty for the root.
        members: Pose of each link in the frame of the body, 4 × 4.
        joints: Moving joints whose parent is one of the links.
        frames: Named frames on the links, with their poses in the frame of the body.
        written: Pose of the frame in which the source writes the topmost link, in the frame of the
            body; None if it is that frame.
    """

    name: str
    joint: Joint | None
    parent: str
    members: dict[str, Array] = field(default_factory=dict)
    joints: list[Joint] = field(default_factory=list)
    frames: dict[str, tuple[Frame, Array]] = field(default_factory=dict)
    written: Array | None = None


class Bodies:
    """Rigid bodies of a robot that is a tree.

    Attributes:
        robot: The robot.
        top: Name of the body that moves all others.
        root: Name of the root body: the top, or the only free body on an empty world.
        by_name: Bodies by name, parents first.
        body_of: Name of the body of each link.
        is_free: Whether the root moves freely; None if the description does not specify it.
    """

    def __init__(
        self, robot: Robot, welded: Collection[str] = (), *, kept: Collection[str] = ()
    ) -> None:
        """Find the bodies.

        Args:
            robot: The robot.
            welded: Names of joints that count as fixed, at their lower limit.
            kept: Names of fixed joints whose child is a body of its own.

        Raises:
            ModelError: The links do not form a tree.
        """
        top = robot.tree.root
        if top is None or robot.tree.detached:
            text = "its links do not form a tree with one root, so it cannot be compared"
            raise ModelError(text, at=robot.place)
        self.robot = robot
        self.top = top.name
        self.by_name: dict[str, Body] = {}
        self.body_of: dict[str, str] = {}
        for name in robot.tree.order:
            joint = robot.tree.get_parent_joint(name)
            is_fixed = joint is not None and (
                (joint.is_fixed and joint.name not in kept) or joint.name in welded
            )
            if joint is not None and is_fixed:
                body = self.by_name[self.body_of[joint.parent]]
                at = get_origin_matrix(joint.origin)
                if not joint.is_fixed:
                    at = at @ _compute_locked_motion(joint)
                body.members[name] = body.members[joint.parent] @ at
            else:
                parent = "" if joint is None else self.body_of[joint.parent]
                body = Body(name, joint, parent, {name: np.eye(4)})
                self.by_name[name] = body
                if joint is not None:
                    self.by_name[parent].joints.append(joint)
            self.body_of[name] = body.name
        for frame in robot.frames:
            owner = self.body_of.get(frame.link)
            if frame.kind != "body" and frame.name not in robot.link and owner is not None:
                body = self.by_name[owner]
                pose = body.members[frame.link] @ get_origin_matrix(frame.origin)
                body.frames.setdefault(frame.name, (frame, pose))
            elif frame.kind == "body" and frame.link in self.by_name:
                self.by_name[frame.link].written = get_origin_matrix(frame.origin)
        self.root, self.is_free = self._find_base(top.name)

    def _find_base(self, root: str) -> tuple[str, bool | None]:
        """Return the root body without an empty world, and whether it moves freely."""
        body = self.by_name[root]
        only = body.joints[0] if len(body.joints) == 1 else None
        if only is not None and only.type == "floating" and not self.has_content(body):
            return self.body_of[only.child], True
        if root == WORLD:
            return root, False
        return root, None if self.robot.base is None else self.robot.base.is_free

    def reset_root(self) -> None:
        """Make the top body the root, as if it were not an empty world."""
        self.root, self.is_free = self.top, None
        self.__dict__.pop("joints", None)

    def has_content(self, body: Body) -> bool:
        """Tell whether a link of a body has mass or geometry."""
        links = self.get_links(body)
        return any(link.mass or link.visuals or link.collisions for link in links)

    def get_links(self, body: Body) -> list[Link]:
        """Return the links of a body."""
        return [self.robot.link[name] for name in body.members]

    def get_child(self, joint: Joint) -> Body:
        """Return the body that a moving joint moves."""
        return self.by_name[joint.child]

    def compute_joint_pose(self, joint: Joint) -> Array:
        """Compute the pose of the child of a moving joint at zero in its parent body, 4 × 4."""
        body = self.by_name[self.body_of[joint.parent]]
        pose: Array = body.members[joint.parent] @ get_origin_matrix(joint.origin)
        return pose

    @cached_property
    def joints(self) -> dict[str, Joint]:
        """Return the joints between bodies by name, parents first."""
        return {
            body.joint.name: body.joint
            for body in self.by_name.values()
            if body.joint is not None and body.name != self.root
        }


def find_locked_joints(robot: Robot) -> set[str]:
    """Return the names of joints whose limits are equal."""
    return {
        joint.name
        for joint in robot.joints
        if joint.type in ("revolute", "prismatic")
        and joint.limit is not None
        and get_limits(joint)[0] == get_limits(joint)[1]
        and math.isfinite(get_limits(joint)[0])
    }


LEAST_AXIS = 1e-15
"""Length below which an axis has no direction; MuJoCo's mjMINVAL."""


def compute_axis(joint: Joint) -> Array:
    """Return the unit axis of a joint in the joint frame; zeros if it has none.

    MuJoCo rejects an axis that is shorter than 1e-15 (mjMINVAL).
    """
    axis = np.array(joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    largest = float(np.abs(axis).max())  # the square of a large number is infinite
    if not LEAST_AXIS <= largest < np.inf:
        return np.zeros(3)
    axis = axis / largest
    unit: Array = axis / np.linalg.norm(axis)
    return unit


def _compute_locked_motion(joint: Joint) -> Array:
    pose, value = np.eye(4), get_limits(joint)[0]
    if joint.type in HINGES:
        pose[:3, :3] = turn(compute_axis(joint), value)
    else:
        pose[:3, 3] = compute_axis(joint) * value
    return pose
