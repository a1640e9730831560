"""Links that move as one, and the whole robot at a pose.

Links joined by fixed joints are one rigid body; its mass properties are given in the frame of the
link the others hang on. Those of the whole robot are in the frame of its root.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches

import numpy as np

from ..model.elements import Joint, Robot
from ..model.pose import IDENTITY, Pose, pose_of
from .inertia_error import InertiaError
from .link_review import LinkReview
from .tensor import Array, MassProperties, combine, rotate


@dataclass(frozen=True, eq=False)
class Lump:
    """Links that are one rigid body.

    Attributes:
        link: The link the others hang on.
        members: All of them, in the order of the tree.
        properties: In the frame of ``link``; None where none of them weighs anything.
    """

    link: str
    members: tuple[str, ...]
    properties: MassProperties | None


@dataclass(frozen=True, eq=False)
class Lumped:
    """A robot's rigid bodies, and all of them at a pose.

    Attributes:
        lumps: In the order of the tree.
        root: The link in whose frame the whole is given.
        whole: The whole robot; None where it weighs nothing.
        positions: The position of each movable joint [rad or m].
        notes: What is to be said: links that are left out, positions beyond limits.
    """

    lumps: tuple[Lump, ...]
    root: str
    whole: MassProperties | None
    positions: dict[str, float]
    notes: tuple[str, ...] = field(default=())


def lump(robot: Robot, found: Sequence[LinkReview], pose: Mapping[str, float]) -> Lumped:
    """Mass properties of each rigid body, and of the robot at a pose.

    Args:
        robot: The robot.
        found: Its links, looked over; a link without an inertial counts with what is implied.
        pose: Positions of joints [rad or m] by name; 0 for the others, and what mimics follows.

    Raises:
        InertiaError: A joint is not in the robot or cannot be put anywhere, or there is no root.
    """
    if len(robot.tree.roots) != 1:
        names = ", ".join(link.name for link in robot.tree.roots) or "none"
        raise InertiaError(f"a robot with one root link is needed; its roots: {names}")
    root = robot.tree.roots[0].name
    positions = joint_positions(robot, pose)
    notes = _beyond_limits(robot, positions)
    weights: dict[str, MassProperties] = {}
    for item in found:
        if item.written is not None and item.written.mass > 0:
            weights.setdefault(item.link.name, item.written)
        elif item.implied is not None:
            weights.setdefault(item.link.name, item.implied)
            notes.append(f"link '{item.link.name}' counts with what its geometry implies")
        elif item.body is not None or item.link.inertial is not None:
            if item.written is None or item.written.mass < 0:
                notes.append(f"link '{item.link.name}' is left out: nothing says what it weighs")
        if item.status == "wrong" and item.written is not None:
            notes.append(f"link '{item.link.name}' counts as written, which cannot be")
    poses = link_poses(robot, positions)
    lumps = []
    for top, members in robot.tree.body_links.items():
        if top not in poses:
            continue
        to_top = poses[top].inverse()
        bodies = [
            placed(weights[name], to_top @ poses[name]) for name in members if name in weights
        ]
        properties = combine(bodies) if bodies else None
        lumps.append(Lump(top, tuple(members), properties))
    all_bodies = [placed(body, poses[name]) for name, body in weights.items() if name in poses]
    whole = combine(all_bodies) if all_bodies else None
    for link in robot.tree.detached:
        notes.append(f"link '{link.name}' hangs on no root and is left out")
    return Lumped(tuple(lumps), root, whole, positions, tuple(notes))


def placed(body: MassProperties, pose: Pose) -> MassProperties:
    """A body seen from the frame in which its own has a pose."""
    rotation = np.array(pose.rotation, dtype=np.float64)
    com: Array = rotation @ body.com + np.array(pose.translation)
    return MassProperties(body.mass, com, rotate(body.inertia, rotation))


def joint_positions(robot: Robot, pose: Mapping[str, float]) -> dict[str, float]:
    """The position of every joint that turns or slides; joints that mimic another follow it."""
    movable = {
        joint.name: joint
        for joint in robot.joints
        if joint.type in ("revolute", "continuous", "prismatic")
    }
    for name, value in pose.items():
        if name not in movable:
            if name in robot.joint:
                kind = robot.joint[name].type
                raise InertiaError(f"joint '{name}' is {kind} and has no single position")
            near = get_close_matches(name, list(movable), 1, 0.5)
            hint = f"did you mean '{near[0]}'?" if near else f"there are {', '.join(movable)}"
            raise InertiaError(f"the robot has no joint '{name}' that moves; {hint}")
        if not math.isfinite(value):
            raise InertiaError(f"the position of joint '{name}' is {value:g}, not a finite number")
    return {name: _position(joint, movable, pose, set()) for name, joint in movable.items()}


def _position(
    joint: Joint, movable: Mapping[str, Joint], pose: Mapping[str, float], seen: set[str]
) -> float:
    mimic = joint.mimic
    if joint.name in pose or mimic is None or mimic.joint not in movable or joint.name in seen:
        return pose.get(joint.name, 0.0)
    leader = _position(movable[mimic.joint], movable, pose, seen | {joint.name})
    return mimic.multiplier * leader + mimic.offset


def _beyond_limits(robot: Robot, positions: Mapping[str, float]) -> list[str]:
    notes = []
    for name, value in positions.items():
        joint = robot.joint[name]
        limit = joint.limit
        if limit is None or joint.type == "continuous":
            continue
        low, high = limit.lower or 0.0, limit.upper or 0.0
        if low < high and not low <= value <= high:
            notes.append(f"joint '{name}' at {value:g} is beyond its limits, {low:g} to {high:g}")
    return notes


def link_poses(robot: Robot, positions: Mapping[str, float]) -> dict[str, Pose]:
    """The pose of each link in the frame of the root that it hangs on."""
    poses: dict[str, Pose] = {}
    for name in robot.tree.order:
        joint = robot.tree.parent_joint(name)
        if joint is None:
            poses[name] = IDENTITY
        elif joint.parent in poses:
            motion = _motion(joint, positions.get(joint.name, 0.0))
            poses[name] = poses[joint.parent] @ pose_of(joint.origin) @ motion
    return poses


def _motion(joint: Joint, value: float) -> Pose:
    """What a joint at a position does to its child; by Rodrigues' formula where it turns."""
    x, y, z = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = math.hypot(x, y, z)
    if not value or not length:
        return IDENTITY
    x, y, z = x / length, y / length, z / length
    if joint.type == "prismatic":
        return Pose(translation=(x * value, y * value, z * value))
    c, s = math.cos(value), math.sin(value)
    k = 1 - c
    return Pose(
        (
            (c + x * x * k, x * y * k - z * s, x * z * k + y * s),
            (y * x * k + z * s, c + y * y * k, y * z * k - x * s),
            (z * x * k - y * s, z * y * k + x * s, c + z * z * k),
        )
    )
