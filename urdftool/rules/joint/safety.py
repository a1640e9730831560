"""Rules on soft limits."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Limit, Robot, SafetyController
from ..fix import FixContext, Proposal, set_attribute, unsafe
from ..rule import ERROR, INFO, ROS, UNSAFE, WARNING, Problem, rule
from ..xml.vocabulary_table import find_misspelled_attributes
from .range import get_bounds

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

    ``k_velocity`` is the only required attribute; urdfdom rejects the robot without it.
    """
    for joint in robot.joints:
        safety = joint.safety_controller
        if safety is None or "k_velocity" in safety.element.attributes:
            continue
        if "k_velocity" not in find_misspelled_attributes(safety.element).values():
            yield Problem(
                joint,
                f"<safety_controller> of joint '{joint.name}' has no k_velocity, which is "
                "required; write it",
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
    """The soft limits of a joint leave no range.

    Soft limits default to 0. MoveIt uses them as the range of the joint, so ``<safety_controller
    k_velocity="10"/>`` alone locks the joint at 0. Robots for targets other than ROS and MoveIt are
    not checked, because no other reader uses soft limits.
    """
    if targets.isdisjoint(ROS) and not _are_used(robot, targets):
        return
    for joint in robot.joints:
        safety, limit = joint.safety_controller, joint.limit
        if safety is None or not joint.is_limited or "k_velocity" not in safety.element.attributes:
            continue
        low, high = safety.soft_lower_limit, safety.soft_upper_limit
        disjoint = limit is not None and None not in (limit.lower, limit.upper)
        if disjoint and limit is not None:
            lower, upper = limit.lower or 0.0, limit.upper or 0.0
            disjoint = lower < upper and (low >= upper or high <= lower)
        if low >= high or disjoint:
            yield Problem(
                joint,
                f"soft limits {low:g} to {high:g} of joint '{joint.name}' leave no range; "
                "write soft_lower_limit and soft_upper_limit within the joint limits",
                at=safety,
                data={"soft_lower": low, "soft_upper": high},
            )


@soft_limits_lock_joint.fix(UNSAFE)
def write_hard_limits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the joint limits as soft limits."""
    joint = context.get_joint(problem)
    found, safety = get_bounds(joint), joint.safety_controller
    if found is None or safety is None or found[1] >= found[2]:
        return None
    return _write_limits(safety, found[0], "lower", "upper")


def _write_limits(safety: SafetyController, limit: Limit, *names: str) -> Proposal:
    """Write bounds of the joint limits as soft limits."""
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
    pedantic="both soft limits beyond the limits, as in robots that leave them without effect",
)
def soft_limits_outside_hard(
    robot: Robot, targets: frozenset[str], *, tolerance: float = 1e-6
) -> Iterator[Problem]:
    """The soft limits of a joint are beyond its joint limits.

    Soft limits slow the joint before it reaches its limit; beyond the limit they have no effect. A
    controller limits the velocity to ``k_position`` times the distance to the soft limit. A soft
    limit that is beyond by less than the velocity limit divided by ``k_position`` still slows the
    joint, and is not reported. Robots without transmissions and ros2_control are reported for
    MoveIt only, because nothing else uses soft limits. ``tolerance`` [rad or m] is the difference
    that is ignored.
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
        least = max(tolerance, (1 + tolerance) * _compute_acting_distance(safety, limit))
        below, above = low < limit.lower - least, high > limit.upper + least
        if below and above:
            what = (
                f"soft limits {low:g} to {high:g} of joint '{joint.name}' are beyond its limits "
                f"{limit.lower:g} to {limit.upper:g}, so they have no effect"
            )
        elif below or above:
            word, soft, hard = (
                ("lower", low, limit.lower) if below else ("upper", high, limit.upper)
            )
            what = (
                f"soft {word} limit {soft:g} of joint '{joint.name}' is beyond its {word} limit "
                f"{hard:g}, so it has no effect"
            )
        else:
            continue
        name = "soft_lower_limit" if below else "soft_upper_limit"
        yield Problem(
            joint,
            what,
            at=safety.locate_attribute(name),
            data={"soft_lower": low, "soft_upper": high},
            pedantic=below and above,
        )


@soft_limits_outside_hard.fix(UNSAFE)
def clamp_soft_limits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the joint limits where the soft limits are beyond them."""
    joint = context.get_joint(problem)
    found, safety = get_bounds(joint), joint.safety_controller
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
    infos=True,
)
def soft_limits_far_inside(
    robot: Robot, targets: frozenset[str], *, part: float = 0.5
) -> Iterator[Problem]:
    """The soft limits of a joint leave less than half of its range.

    Soft limits should be close to the joint limits: those of 395 joints in 40 public descriptions
    leave at least 78 % of the range. Usually a sign, a decimal point or a unit is wrong, or only
    the joint limits were changed. Planners then reject positions that the robot can reach. ``part``
    is the part of the range that the soft limits must leave. For a robot without transmissions and
    ros2_control only MoveIt uses soft limits, so half of that part is enough.
    """
    if not _are_used(robot, targets):
        part /= 2
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
                f"range {limit.lower:g} to {limit.upper:g}; MoveIt plans only within them",
                at=safety,
                data={"part": left},
            )


def _are_used(robot: Robot, targets: frozenset[str]) -> bool:
    """Tell whether ROS controllers or MoveIt read the soft limits."""
    return bool(robot.transmissions or robot.ros2_controls) or "moveit" in targets


def _compute_acting_distance(safety: SafetyController, limit: Limit) -> float:
    """Compute how far beyond a joint limit a soft limit still slows the joint [rad, m].

    ros_control limits the velocity to ``k_position`` times the distance to the soft limit, and to
    the velocity limit (joint_limits_interface.h).
    """
    if safety.k_position <= 0 or not limit.velocity:
        return 0.0
    return max(limit.velocity, 0.0) / safety.k_position
