"""Forward kinematics: link poses from joint positions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Real

from ..errors import ModelError
from ..suggestions import suggest_name
from .elements import Joint, Robot
from .pose import IDENTITY, Pose, make_pose

MOVABLE = ("revolute", "continuous", "prismatic")
"""Types of joints with one position."""

UNLIMITED = 1e9
"""Number that stands for no limit where a format requires one; chosen, no source."""

NOWHERE: Mapping[str, float] = {}

_SAME = 1e-6  # [rad, m], or a ratio: rounding of a mimic joint's position; chosen, no source


def link_poses(robot: Robot, positions: Mapping[str, float] = NOWHERE) -> dict[str, Pose]:
    """Return the pose of each link in the frame of its root, by name.

    All roots have the same pose; links that no root reaches are absent.

    Args:
        robot: Any robot, also an invalid one.
        positions: Joint positions by name [rad, m]; 0 by default. Mimic joints do not follow
            their leaders; use :func:`compute_link_poses` for that.
    """
    poses: dict[str, Pose] = {}
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        if joint is None:
            poses[name] = IDENTITY
        elif joint.parent in poses:
            at = poses[joint.parent] @ make_pose(joint.origin)
            value = positions.get(joint.name, 0.0)
            poses[name] = at @ compute_motion(joint, value) if value else at
    return poses


def compute_link_poses(robot: Robot, positions: Mapping[str, float] = NOWHERE) -> dict[str, Pose]:
    """Return :func:`link_poses` with mimic joints that follow their leaders, also by an offset."""
    return link_poses(robot, add_mimic_positions(robot, positions))


def get_zero_poses(robot: Robot) -> dict[str, Pose]:
    """Return :func:`link_poses` with all joints at 0, computed once for a robot.

    Mimic joints with an offset are at 0, too. Not for a robot whose joints are changed afterwards.
    """
    return robot.memo.get(get_zero_poses, lambda: link_poses(robot))


def compute_motion(joint: Joint, value: float) -> Pose:
    """Return the transform of the child that a joint position [rad, m] causes.

    Rotations use Rodrigues' formula. The result is the identity for fixed joints and for types
    with more than one position.
    """
    if not value or not _has_position(joint):
        return IDENTITY
    x, y, z = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = math.hypot(x, y, z)
    if not length:
        return IDENTITY
    x, y, z = x / length, y / length, z / length
    if joint.type == "prismatic":
        return Pose(translation=(x * value, y * value, z * value))
    along = value / math.tau * (joint.thread_pitch or 0.0)
    c, s = math.cos(value), math.sin(value)
    k = 1 - c
    return Pose(
        (
            (c + x * x * k, x * y * k - z * s, x * z * k + y * s),
            (y * x * k + z * s, c + y * y * k, y * z * k - x * s),
            (z * x * k - y * s, z * y * k + x * s, c + z * z * k),
        ),
        (x * along, y * along, z * along),
    )


def add_mimic_positions(robot: Robot, positions: Mapping[str, float]) -> dict[str, float]:
    """Return the positions [rad, m] of all joints with one position, computed through ``<mimic>``.

    Given positions are kept. Chains of mimic joints are followed; joints in a loop start from 0.
    """
    movable = find_movable_joints(robot)
    return {
        name: positions[name] if name in positions else _follow(joint, movable, positions)
        for name, joint in movable.items()
    }


def find_movable_joints(robot: Robot) -> dict[str, Joint]:
    """Return the joints with one position, by name, in the order of the file."""
    return {joint.name: joint for joint in robot.joints if _has_position(joint)}


def _has_position(joint: Joint) -> bool:
    """Tell whether a joint has one position; a screw has if its pitch is known."""
    return joint.type in MOVABLE or joint.thread_pitch is not None


def check_positions(robot: Robot, positions: Mapping[str, float]) -> None:
    """Check requested joint positions.

    Raises:
        ModelError: The robot has no such joint, the joint does not have one position, the position
            is not finite, or it is that of a mimic joint whose leader moves it elsewhere. Positions
            beyond a limit are allowed.
    """
    movable = find_movable_joints(robot)
    for name, value in positions.items():
        if name not in movable:
            if name in robot.joint:
                kind = robot.joint[name].type
                raise ModelError(
                    f"joint '{name}' is {kind}; only joints with one degree of freedom "
                    "have a position"
                )
            hint = suggest_name(name, movable, 0.5) or f"; movable joints: {', '.join(movable)}"
            if not movable:
                hint = "; the robot has no movable joints"
            raise ModelError(f"movable joint '{name}' does not exist{hint}")
        if not (isinstance(value, Real) and math.isfinite(value)):
            raise ModelError(f"position of joint '{name}' is {value!r}, not a finite number")
    leaders = {name: follow_mimic_chain(movable[name], movable)[0] for name in positions}
    free = {name: at for name, at in positions.items() if leaders[name] == name}
    followed = add_mimic_positions(robot, free)
    for name, leader in leaders.items():
        if not math.isclose(positions[name], followed[name], rel_tol=_SAME, abs_tol=_SAME):
            raise ModelError(
                f"joint '{name}' mimics '{leader}'; give a position of that joint instead"
            )


def get_limits(joint: Joint) -> tuple[float, float]:
    """Return the lower and upper limit of a joint [rad, m], as URDF readers interpret it.

    A missing bound is 0; the limits of a continuous joint, of a revolute one with an effort or
    velocity but neither bound, and of a joint without ``<limit>`` are infinite.
    """
    if joint.limit is None or joint.turns_freely:
        return -math.inf, math.inf
    return joint.limit.lower or 0.0, joint.limit.upper or 0.0


def explain_beyond_limits(robot: Robot, positions: Mapping[str, float]) -> dict[str, str]:
    """Return a message for each position of a joint [rad, m] that is beyond its limits, by name."""
    found = {}
    for name, value in positions.items():
        low, high = get_limits(robot.joint[name])
        if low < high and not low <= value <= high:
            found[name] = f"joint '{name}' at {value:g} is beyond its limits, {low:g} to {high:g}"
    return found


def follow_mimic_chain(joint: Joint, movable: Mapping[str, Joint]) -> tuple[str, float, float]:
    """Follow the ``<mimic>`` chain of a joint.

    Returns:
        The name of the leading joint, and the factor and offset [rad, m] that map its position
        to that of ``joint``. A loop ends at the joint where it began.
    """
    scale, shift, seen = 1.0, 0.0, set[str]()
    while (mimic := joint.mimic) is not None and mimic.joint in movable and joint.name not in seen:
        seen.add(joint.name)
        shift += scale * mimic.offset
        scale *= mimic.multiplier
        joint = movable[mimic.joint]
    return joint.name, scale, shift


def _follow(joint: Joint, movable: Mapping[str, Joint], positions: Mapping[str, float]) -> float:
    """Return the position of a joint that is not given, by its chain of mimic joints."""
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
