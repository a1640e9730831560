"""Where each link is when the joints are somewhere: forward kinematics."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..errors import ModelError
from ..suggestions import did_you_mean
from .elements import Joint, Robot
from .pose import IDENTITY, Pose, pose_of

MOVABLE = ("revolute", "continuous", "prismatic")
"""The types of joint that have one position."""

NOWHERE: Mapping[str, float] = {}


def link_poses(robot: Robot, positions: Mapping[str, float] = NOWHERE) -> dict[str, Pose]:
    """The pose of each link in the frame of the root that it hangs on, by name.

    Each root stands in the same place; a link that hangs on none has no pose.

    Args:
        robot: Any robot, also a broken one.
        positions: Of joints by name [rad, m]; the others are at zero. What mimics is not moved by
            what it mimics: :func:`with_mimics` does that.
    """
    poses: dict[str, Pose] = {}
    for name in robot.tree.order:
        joint = robot.tree.parent_joint(name)
        if joint is None:
            poses[name] = IDENTITY
        elif joint.parent in poses:
            at = poses[joint.parent] @ pose_of(joint.origin)
            value = positions.get(joint.name, 0.0)
            poses[name] = at @ motion_of(joint, value) if value else at
    return poses


def motion_of(joint: Joint, value: float) -> Pose:
    """What a joint at a position [rad, m] does to its child; by Rodrigues' formula where it turns.

    A fixed joint, and one of a type with more than one position, does not move.
    """
    if not value or joint.type not in MOVABLE:
        return IDENTITY
    x, y, z = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = math.hypot(x, y, z)
    if not length:
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


def with_mimics(robot: Robot, positions: Mapping[str, float]) -> dict[str, float]:
    """Positions with those that follow from ``<mimic>``, for every joint that moves in one way.

    A joint that is given keeps what it is given; a chain of mimics is followed, a loop of them ends
    where it began, at zero.
    """
    movable = movable_joints(robot)
    return {
        name: positions[name] if name in positions else _follow(joint, movable, positions)
        for name, joint in movable.items()
    }


def movable_joints(robot: Robot) -> dict[str, Joint]:
    """The joints that have one position, by name, in the order of the file."""
    return {joint.name: joint for joint in robot.joints if joint.type in MOVABLE}


def check_positions(robot: Robot, positions: Mapping[str, float]) -> None:
    """Refuse a position that somebody asked for and no joint can have.

    Raises:
        ModelError: The robot has no such joint, or it has no single position, or the position is
            not a finite number. A position beyond a limit is allowed.
    """
    movable = movable_joints(robot)
    for name, value in positions.items():
        if name not in movable:
            if name in robot.joint:
                kind = robot.joint[name].type
                raise ModelError(f"joint '{name}' is {kind} and has no single position")
            hint = did_you_mean(name, movable, 0.5) or f"; there are {', '.join(movable)}"
            if not movable:
                hint = "; no joint of it moves"
            raise ModelError(f"the robot has no joint '{name}' that moves{hint}")
        if not math.isfinite(value):
            raise ModelError(f"the position of joint '{name}' is {value:g}, not a finite number")


def limits_of(joint: Joint) -> tuple[float, float]:
    """The lower and upper limit of a joint [rad, m], as readers of URDF understand it.

    A bound that is not written is zero; a joint without ``<limit>``, and a continuous one, have
    none, which is infinite.
    """
    if joint.limit is None or joint.type == "continuous":
        return -math.inf, math.inf
    return joint.limit.lower or 0.0, joint.limit.upper or 0.0


def chain_of(joint: Joint, movable: Mapping[str, Joint]) -> tuple[str, float, float]:
    """Follow the chain of ``<mimic>`` from a joint.

    Args:
        joint: A joint that has one position.
        movable: The joints that have one, by name.

    Returns:
        The name of the joint at its end, and the factor and the offset [rad, m] by which the
        position of ``joint`` follows from its position. A loop ends where it began.
    """
    scale, shift, seen = 1.0, 0.0, set[str]()
    while (mimic := joint.mimic) is not None and mimic.joint in movable and joint.name not in seen:
        seen.add(joint.name)
        shift += scale * mimic.offset
        scale *= mimic.multiplier
        joint = movable[mimic.joint]
    return joint.name, scale, shift


def _follow(joint: Joint, movable: Mapping[str, Joint], positions: Mapping[str, float]) -> float:
    """The position of a joint that is not given, along its chain of mimics."""
    scale, shift, seen = 1.0, 0.0, set()
    while joint.name not in positions:
        mimic = joint.mimic
        if mimic is None or mimic.joint not in movable or joint.name in seen:
            return shift
        seen.add(joint.name)
        shift += scale * mimic.offset
        scale *= mimic.multiplier
        joint = movable[mimic.joint]
    return shift + scale * positions[joint.name]
