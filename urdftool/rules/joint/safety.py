"""Soft limits."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Limit, Robot, SafetyController
from ..fix import FixContext, Proposal, set_attribute, unsafe
from ..rule import ERROR, INFO, ROS, UNSAFE, WARNING, Problem, rule
from ..xml.vocabulary_table import misspelt_attributes
from .range import bounds_of_joint

APPLIES_TO = ("safety_controller",)


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: no k_velocity",
        "mujoco, pybullet, drake": "ignore it",
    },
)
def incomplete_safety_controller(robot: Robot) -> Iterator[Problem]:
    """A ``<safety_controller>`` has no ``k_velocity``.

    It is the one attribute of it that must be written; urdfdom refuses the whole robot without it.
    """
    for joint in robot.joints:
        safety = joint.safety_controller
        if safety is None or "k_velocity" in safety.element.attributes:
            continue
        if "k_velocity" not in misspelt_attributes(safety.element).values():
            yield Problem(
                joint,
                f"<safety_controller> of joint '{joint.name}' has no k_velocity; write it",
                at=safety,
            )


@rule(
    WARNING,
    raised={"moveit": ERROR},
    effects={
        "moveit": "takes the soft limits, within the hard ones, for the joint's range",
        "gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "ignore them",
    },
)
def soft_limits_lock_joint(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A joint's soft limits leave it no range.

    Both are 0 where they are not written. MoveIt takes them for the range of the joint, so a
    ``<safety_controller k_velocity="10"/>`` alone locks it at 0. Of a robot that is neither for ROS
    nor for MoveIt nothing is reported, as no other reader uses soft limits.
    """
    if targets.isdisjoint(ROS) and not _are_used(robot, targets):
        return
    for joint in robot.joints:
        safety, limit = joint.safety_controller, joint.limit
        if safety is None or not joint.is_limited or "k_velocity" not in safety.element.attributes:
            continue
        low, high = safety.soft_lower_limit, safety.soft_upper_limit
        apart = limit is not None and None not in (limit.lower, limit.upper)
        if apart and limit is not None:
            lower, upper = limit.lower or 0.0, limit.upper or 0.0
            apart = lower < upper and (low >= upper or high <= lower)
        if low >= high or apart:
            yield Problem(
                joint,
                f"soft limits {low:g} to {high:g} of joint '{joint.name}' leave it no range; "
                "write soft_lower_limit and soft_upper_limit within its limits",
                at=safety,
                data={"soft_lower": low, "soft_upper": high},
            )


@soft_limits_lock_joint.fix(UNSAFE)
def write_hard_limits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the hard limits."""
    joint = context.joint(problem)
    found, safety = bounds_of_joint(joint), joint.safety_controller
    if found is None or safety is None or found[1] >= found[2]:
        return None
    return _write_limits(safety, found[0], "lower", "upper")


def _write_limits(safety: SafetyController, limit: Limit, *names: str) -> Proposal:
    """Write hard limits as the soft ones."""
    changes = [
        set_attribute(safety.element, f"soft_{name}_limit", (limit.element.get(name) or "").strip())
        for name in names
    ]
    return unsafe("write the limits of the joint", *changes)


@rule(
    INFO,
    effects={
        "moveit": "takes the hard limit",
        "gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "ignore the soft limits",
    },
)
def soft_limits_outside_hard(
    robot: Robot, targets: frozenset[str], *, tolerance: float = 1e-6
) -> Iterator[Problem]:
    """A joint's soft limits lie beyond its hard ones.

    They should slow the joint before the stop; out there they never do. A controller allows
    ``k_position`` times the distance to the soft limit as velocity, so one that is beyond by no
    more than the velocity limit divided by ``k_position`` still slows the joint, and is not
    reported. Nor are those of a robot without transmissions and ros2_control that is not for
    MoveIt, as nothing uses them.
    """
    if not _are_used(robot, targets):
        return
    for joint in robot.joints:
        safety, limit = joint.safety_controller, joint.limit
        if safety is None or limit is None or not joint.is_limited:
            continue
        low, high = safety.soft_lower_limit, safety.soft_upper_limit
        if limit.lower is None or limit.upper is None or low >= high:
            continue
        if low >= limit.upper or high <= limit.lower:
            continue
        least = max(tolerance, (1 + tolerance) * _still_acting(safety, limit))
        below, above = low < limit.lower - least, high > limit.upper + least
        if below and above:
            what = (
                f"soft limits {low:g} to {high:g} of joint '{joint.name}' are beyond its limits "
                f"{limit.lower:g} to {limit.upper:g}, so they do nothing"
            )
        elif below or above:
            word, soft, hard = (
                ("lower", low, limit.lower) if below else ("upper", high, limit.upper)
            )
            what = (
                f"soft {word} limit {soft:g} of joint '{joint.name}' is beyond its {word} limit "
                f"{hard:g}, so it does nothing"
            )
        else:
            continue
        name = "soft_lower_limit" if below else "soft_upper_limit"
        yield Problem(
            joint,
            what,
            at=safety.element.attribute_place(name),
            data={"soft_lower": low, "soft_upper": high},
        )


@soft_limits_outside_hard.fix(UNSAFE)
def clamp_soft_limits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the hard limits, where the soft ones are beyond."""
    joint = context.joint(problem)
    found, safety = bounds_of_joint(joint), joint.safety_controller
    if found is None or safety is None:
        return None
    limit, lower, upper = found
    beyond = {"lower": safety.soft_lower_limit < lower, "upper": safety.soft_upper_limit > upper}
    return _write_limits(safety, limit, *(name for name, is_beyond in beyond.items() if is_beyond))


@rule(
    INFO,
    effects={
        "moveit": "plans within the soft limits (from its source, robot_model.cpp)",
        "mujoco, pybullet, pinocchio, drake": "ignore them",
    },
)
def soft_limits_far_inside(
    robot: Robot, targets: frozenset[str], *, part: float = 0.5
) -> Iterator[Problem]:
    """A joint's soft limits leave less than half of its range.

    They should begin shortly before the hard limits: those of 395 joints in 40 public descriptions
    leave at least 78 % of the range. Otherwise a sign, a decimal point or a unit is wrong, or only
    the hard limits were changed. Planners then refuse positions that the robot can take. ``part``
    is the part of the range that the soft limits must leave. Of a robot without transmissions and
    ros2_control that is not for MoveIt nothing is reported, as nothing uses soft limits.
    """
    if not _are_used(robot, targets):
        return
    for joint in robot.joints:
        safety, limit = joint.safety_controller, joint.limit
        if safety is None or limit is None or not joint.is_limited:
            continue
        if limit.lower is None or limit.upper is None or limit.lower >= limit.upper:
            continue
        low = max(limit.lower, safety.soft_lower_limit)
        high = min(limit.upper, safety.soft_upper_limit)
        left = (high - low) / (limit.upper - limit.lower)
        if 0 < left < part:
            yield Problem(
                joint,
                f"soft limits {low:g} to {high:g} of joint '{joint.name}' leave {left:.0%} of its "
                f"range {limit.lower:g} to {limit.upper:g}; MoveIt plans within them alone",
                at=safety,
                data={"part": left},
            )


def _are_used(robot: Robot, targets: frozenset[str]) -> bool:
    """Whether something reads soft limits: controllers of ROS, or MoveIt."""
    return bool(robot.transmissions or robot.ros2_controls) or "moveit" in targets


def _still_acting(safety: SafetyController, limit: Limit) -> float:
    """How far beyond a hard limit a soft one still slows the joint [rad, m].

    ros_control allows ``k_position`` times the distance to the soft limit as velocity, and no more
    than the velocity limit (joint_limits_interface.h).
    """
    if safety.k_position <= 0 or not limit.velocity:
        return 0.0
    return max(limit.velocity, 0.0) / safety.k_position
