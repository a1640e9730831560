"""Rules on the fingers of a gripper."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...model.elements import Joint, Robot, Vector
from ...model.pose import make_pose, rotate
from ..rule import ANY_FORMAT, INFO, WARNING, Problem, rule

APPLIES_TO = ("joint",)


@rule(
    INFO,
    effects={
        "mujoco, pybullet": "move the fingers independently",
    },
    default=False,
)
def gripper_finger_not_mimic(robot: Robot) -> Iterator[Problem]:
    """The left and the right finger of a gripper move independently.

    Most parallel grippers have one motor. Without ``<mimic>`` the fingers need two commands, and
    may close off center.
    """
    for joint in robot.joints:
        if "left" not in joint.name or "finger" not in joint.name or not joint.is_limited:
            continue
        other = robot.joint.get(joint.name.replace("left", "right"))
        if other is None or other.type != joint.type or other.parent != joint.parent:
            continue
        if joint.mimic is None and other.mimic is None:
            yield Problem(
                other,
                f"joints '{joint.name}' and '{other.name}' move independently; "
                "if one motor drives both, add <mimic> to one of them",
                data={"joints": [joint.name, other.name]},
            )


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": (
            "move both fingers in the same direction: the gripper cannot grip"
        ),
    },
    formats=ANY_FORMAT,
)
def fingers_move_together(robot: Robot) -> Iterator[Problem]:
    """The two fingers of a gripper move in the same direction.

    To open and close, two fingers on one parent link must move in opposite directions. Here their
    axes have the same direction in the frame of the parent, and either their ranges extend to the
    same side of 0, or one mimics the other with a positive multiplier. One axis is reversed, or the
    right finger is a copy of the left one. Ranges that contain 0 are not reported, unless one joint
    mimics the other. Fingers that turn are compared if their joints are apart across the axes.
    """
    for link in robot.links:
        below = robot.tree.get_child_joints(link.name)
        slides = [j for j in below if j.type in ("prismatic", "revolute") and _is_finger(j)]
        if len(slides) != 2 or slides[0].type != slides[1].type:
            continue
        one, other = slides
        if one.type == "revolute" and not _are_apart(one, other):
            continue
        axes = (_compute_axis_in_parent(one), _compute_axis_in_parent(other))
        if sum(a * b for a, b in zip(*axes, strict=True)) < 0.95:
            continue
        leader = {joint.mimic.joint: joint for joint in slides if joint.mimic is not None}
        follower = leader.get(one.name) or leader.get(other.name)
        if follower is not None and follower.mimic is not None:
            together = follower.mimic.multiplier > 0
            remedy = "write a negative multiplier, or reverse one axis"
        else:
            ways = {_get_direction(joint) for joint in slides}
            together = len(ways) == 1 and None not in ways
            remedy = "reverse the axis of one of them"
        if together:
            yield Problem(
                other,
                f"fingers '{one.name}' and '{other.name}' both move in the same direction, so the "
                f"gripper cannot grip; {remedy}",
                at=other.axis or other,
                data={"joints": [one.name, other.name]},
            )


def _are_apart(one: Joint, other: Joint) -> bool:
    """Tell whether two joints are at least 1 mm apart, across the axis of the first."""
    axis = _compute_axis_in_parent(one)
    places = [make_pose(joint.origin).translation for joint in (one, other)]
    step = [b - a for a, b in zip(*places, strict=True)]
    along = sum(a * b for a, b in zip(step, axis, strict=True))
    return math.hypot(*(a - along * b for a, b in zip(step, axis, strict=True))) > 1e-3


_FINGER = re.compile(r"finger|jaw|claw|grip", re.IGNORECASE)


def _is_finger(joint: Joint) -> bool:
    return _FINGER.search(joint.name) is not None or _FINGER.search(joint.child) is not None


def _compute_axis_in_parent(joint: Joint) -> Vector:
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = math.hypot(*axis) or 1.0
    x, y, z = rotate(make_pose(joint.origin).rotation, axis)
    return x / length, y / length, z / length


def _get_direction(joint: Joint) -> int | None:
    """Get the direction of motion from 0: 1 along the axis, -1 against it; None for both."""
    if joint.limit is None or joint.limit.lower is None or joint.limit.upper is None:
        return None
    lower, upper = joint.limit.lower, joint.limit.upper
    slack = 0.1 * (upper - lower)
    if upper <= lower:
        return None
    return 1 if lower >= -slack else -1 if upper <= slack else None
