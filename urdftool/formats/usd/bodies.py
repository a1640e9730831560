"""Division of the links into rigid bodies and frames.

A simulator computes the mass of a body without mass from its collision geometry. Therefore a link
without mass is a frame on the body that carries it, unless it moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...diagnostic import Severity
from ...model.elements import BALL_TYPES, Joint, Link, Robot
from ...model.kinematics import link_poses
from ...model.pose import IDENTITY, Pose, compute_norm, make_pose
from ...model.selection import list_below
from ...model.start import start_positions
from ..common.base import decide_base
from ..common.option import Base
from ..common.rigid_tree import group_rigid_links
from ..common.shape_box import ShapeBoxes
from ..common.upright import turn_upright
from ..written import Written

_MOVING = frozenset(("revolute", "continuous", "prismatic", "planar", "floating")) | BALL_TYPES


@dataclass(frozen=True, eq=False)
class Bodies:
    """The rigid bodies of a robot.

    Attributes:
        robot: The robot, whose tree has one root.
        free: Whether the base moves freely in the world.
        carrier: Body of each link, by name; empty for a frame that is fixed to the world.
        pose: Pose of each link in its body.
        base: Name of the base body; empty if joints start at the world.
    """

    robot: Robot
    free: bool
    carrier: dict[str, str]
    pose: dict[str, Pose]
    base: str

    @cached_property
    def links(self) -> list[Link]:
        """Return the links that are bodies, parents first."""
        return [self.robot.link[n] for n in self.robot.tree.order if self.carrier[n] == n]

    @cached_property
    def frames(self) -> list[Link]:
        """Return the links that are frames, parents first."""
        return [self.robot.link[n] for n in self.robot.tree.order if self.carrier[n] != n]

    @cached_property
    def joints(self) -> list[Joint]:
        """Return the joints between bodies, in the order of the tree."""
        joints = (self.robot.tree.get_parent_joint(name) for name in self.robot.tree.order)
        return [j for j in joints if j is not None and self.carrier[j.child] == j.child
                and j.child != self.base]  # fmt: skip

    @cached_property
    def root_pose(self) -> Pose:
        """Return the pose of the root link in the stage."""
        base = self.robot.base
        return make_pose(base.origin) if base is not None else IDENTITY

    @cached_property
    def poses(self) -> dict[str, Pose]:
        """Return the pose of each link in the stage with all joints at zero."""
        found = link_poses(self.robot)
        return {name: self.root_pose @ pose for name, pose in found.items()}

    def find_rigid_groups(self) -> dict[str, list[str]]:
        """Return the names of the bodies that move together, by the topmost one."""
        top: dict[str, str] = {}
        groups: dict[str, list[str]] = {}
        for link in self.links:
            joint = self.robot.tree.get_parent_joint(link.name)
            parent = "" if joint is None or is_movable(joint) else self.carrier[joint.parent]
            top[link.name] = top.get(parent, link.name)
            groups.setdefault(top[link.name], []).append(link.name)
        return groups

    def compute_parent_frame(self, joint: Joint) -> Pose:
        """Return the pose of the joint's child at zero, in the frame of the joint's first body."""
        at = self.pose[joint.parent] @ make_pose(joint.origin)
        return at if self.carrier[joint.parent] else self.root_pose @ at

    def is_movable(self, joint: Joint) -> bool:
        """Tell whether a joint has degrees of freedom in the stage."""
        return is_movable(joint)


def is_movable(joint: Joint) -> bool:
    """Tell whether a joint moves; a joint without a usable axis does not."""
    if joint.has_axis and joint.axis is not None and compute_norm(joint.axis.xyz) < 1e-6:
        return False
    return joint.type in _MOVING


def has_mass(link: Link) -> bool:
    """Tell whether a link has a mass that is above zero as a 32-bit float."""
    return float(np.float32(min(link.mass, 3e38))) > 0


def make_bodies(robot: Robot, base: Base, virtual_joint: str | None, written: Written) -> Bodies:
    """Divide the links of a robot into bodies and frames."""
    root = robot.tree.roots[0]
    free = _is_free(robot, root, base, virtual_joint, written)
    if free:
        robot = _turn_upright(robot, written)
    carrier: dict[str, str] = {}
    pose: dict[str, Pose] = {}
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        if joint is not None and not is_movable(joint) and not has_mass(robot.link[name]):
            carrier[name] = carrier[joint.parent]
            pose[name] = pose[joint.parent] @ make_pose(joint.origin)
        else:
            carrier[name], pose[name] = name, IDENTITY
    plan = Bodies(robot, free, carrier, pose, root.name)
    return plan if has_mass(root) else _choose_massive_base(plan, root, written)


def _is_free(
    robot: Robot, root: Link, base: Base, virtual_joint: str | None, written: Written
) -> bool:
    """Tell whether the base is free; a massless root with one floating joint is the world."""
    children = robot.tree.get_child_joints(root.name)
    if not has_mass(root) and len(children) == 1 and children[0].type == "floating":
        return True
    tree = group_rigid_links(robot, is_movable)
    home, _ = start_positions(robot)
    return decide_base(tree, base, virtual_joint, ShapeBoxes(robot), home, written)[0]


def _turn_upright(robot: Robot, written: Written) -> Robot:
    """Return the robot; with a turned base if it stands on its legs with y up only."""
    home, _ = start_positions(robot)
    return turn_upright(group_rigid_links(robot, is_movable), ShapeBoxes(robot), home, written)


def _choose_massive_base(plan: Bodies, root: Link, written: Written) -> Bodies:
    """Replace a base without mass: by a link that is fixed to it, or by the world."""
    robot = plan.robot
    frames = [name for name, body in plan.carrier.items() if body == root.name]
    below = [j for name in frames for j in robot.tree.get_child_joints(name)
             if plan.carrier[j.child] == j.child]  # fmt: skip
    fixed = [joint for joint in below if not is_movable(joint)]
    if fixed:
        joint = max(fixed, key=lambda joint: robot.link[joint.child].mass)
        at = (plan.pose[joint.parent] @ make_pose(joint.origin)).invert()
        carrier, pose = dict(plan.carrier), dict(plan.pose)
        for name in frames:
            carrier[name], pose[name] = joint.child, at @ plan.pose[name]
        return Bodies(robot, plan.free, carrier, pose, joint.child)
    floats = len(below) == 1 and below[0].type == "floating"
    if floats or (len(below) < 2 and not plan.free):
        carrier = {n: "" if body == root.name else body for n, body in plan.carrier.items()}
        return Bodies(robot, plan.free, carrier, plan.pose, below[0].child if floats else "")
    return plan


def report_floating(plan: Bodies, written: Written) -> None:
    """Report floating joints inside the tree, whose child is free relative to the world."""
    for joint in plan.joints:
        if joint.type == "floating":
            written.report_loss(
                "floating-joint",
                f"joint '{joint.name}' is floating: link '{joint.child}' is a free body of the "
                "stage, and its position is relative to the world instead of "
                f"'{joint.parent}'",
                joint.place,
                kind="joint",
                name=joint.name,
                severity=Severity.INFO,
            )
    _report_robots(plan, written)


def _report_robots(plan: Bodies, written: Written) -> None:
    """Report free bodies next to the robot that carry joints: a stage has one articulation."""
    tree = plan.robot.tree
    free = [joint for joint in plan.joints if joint.type == "floating"]
    others = [
        joint.child
        for joint in free
        if any(
            is_movable(one)
            for link in list_below(tree, joint.child)
            for one in tree.get_child_joints(link)
        )
    ]
    if others:
        named = f"'{others[0]}'" + f" and {len(others) - 1} more" * (len(others) > 1)
        written.report_loss(
            "several-robots",
            f"joints below {named} belong to no articulation, since a stage describes one robot, "
            "and Newton refuses such a stage; 'urdftool export urdf --root' writes one of the "
            "robots",
            plan.robot.link[others[0]].place,
            kind="link",
            name=others[0],
        )
