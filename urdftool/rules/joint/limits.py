"""Whether a joint has limits, and which."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.elements import Joint, Limit, Robot
from ..rule import ERROR, INFO, WARNING, Problem, rule
from ..xml.vocabulary_table import misspelt_attributes, misspelt_children


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet": "reject the robot",
        "mujoco": "takes the joint as unlimited",
    },
)
def missing_limit(robot: Robot) -> Iterator[Problem]:
    """A revolute or prismatic joint has no ``<limit>``.

    These two types are defined by their stops. urdfdom refuses the whole robot; MuJoCo lets the
    joint turn for ever. A joint without stops is ``continuous``.
    """
    for joint in robot.joints:
        if not joint.is_limited or joint.limit is not None:
            continue
        if "limit" in misspelt_children(joint.element).values():
            continue
        or_type = ", or make it continuous" if joint.type == "revolute" else ""
        yield Problem(
            joint,
            f"{joint.type} joint '{joint.name}' has no <limit>; "
            f"write lower, upper, effort and velocity{or_type}",
        )


@rule(
    ERROR,
    effects={
        "urdfdom 5 and earlier (every released ROS), gz, gazebo-classic": "reject the robot",
        "pybullet": "takes 0",
        "mujoco": "takes it as unlimited",
    },
)
def limit_without_effort_or_velocity(robot: Robot) -> Iterator[Problem]:
    """A ``<limit>`` lacks its effort or velocity.

    urdfdom refuses the robot, on a fixed or continuous joint too, unless it says version 1.2.
    MuJoCo and Drake load it, so the fault only shows when ROS does.
    """
    if _version(robot) >= 1.2:
        return
    for joint in robot.joints:
        limit = joint.limit
        if limit is None:
            continue
        attributes = limit.element.attributes
        missing = [name for name in ("effort", "velocity") if name not in attributes]
        if missing and (meant := misspelt_attributes(limit.element)):
            missing = [name for name in missing if name not in meant.values()]
        if missing:
            words = " and no ".join(missing)
            yield Problem(
                joint,
                f"<limit> of joint '{joint.name}' has no {words}; both must be written",
                at=limit,
            )


def _version(robot: Robot) -> float:
    try:
        return float(robot.version or "1.0")
    except ValueError:
        return 1.0


@rule(
    WARNING,
    effects={"urdfdom, gz, gazebo-classic": "take 0 for a bound that is not written"},
)
def limit_without_bounds(robot: Robot) -> Iterator[Problem]:
    """A revolute or prismatic joint's ``<limit>`` lacks lower, upper or both.

    Each is 0 where it is not written, so with both missing the joint is locked at 0. Exporters
    write wheels like that; those are ``continuous``.
    """
    for joint in robot.joints:
        limit = joint.limit
        if limit is None or not joint.is_limited:
            continue
        attributes = limit.element.attributes
        missing = [name for name in ("lower", "upper") if name not in attributes]
        if missing and (meant := misspelt_attributes(limit.element)):
            missing = [name for name in missing if name not in meant.values()]
        if not missing:
            continue
        if len(missing) == 2:
            or_type = ", or make the joint continuous" if joint.type == "revolute" else ""
            what = f"neither lower nor upper, so it is locked at 0; write both{or_type}"
        else:
            what = f"no {missing[0]}, which is 0 then; write it down"
        severity = WARNING if len(missing) == 2 or _is_empty(limit) else INFO
        yield Problem(
            joint, f"<limit> of joint '{joint.name}' has {what}", at=limit, severity=severity
        )


def _is_empty(limit: Limit) -> bool:
    return (limit.lower or 0.0) >= (limit.upper or 0.0)


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "swap them with a warning",
        "mujoco": "takes the joint as unlimited",
        "pybullet, pinocchio": "keep the empty range",
        "moveit": "finds no state in bounds",
        "drake": "aborts",
    },
)
def lower_above_upper(robot: Robot) -> Iterator[Problem]:
    """A joint's lower limit is above its upper one.

    No position lies between them. Gazebo swaps the two, MuJoCo drops them, PyBullet keeps the empty
    range, MoveIt plans nothing.
    """
    for joint, limit, lower, upper in _bounded(robot):
        if lower > upper:
            yield Problem(
                joint,
                f"lower limit {lower:g} of joint '{joint.name}' is above the upper {upper:g}; "
                "swap them",
                at=limit.element.attribute_place("lower"),
            )


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "mujoco": "ignores the limit: the joint turns freely",
        "pybullet, gz": "hold it in place",
    },
)
def locked_by_limits(robot: Robot) -> Iterator[Problem]:
    """A joint's lower and upper limit are equal.

    It is meant not to move. MuJoCo drops such a limit, so the very joint that was locked turns
    freely; planners keep an axis that does nothing. A joint that does not move is ``fixed``.
    """
    for joint, limit, lower, upper in _bounded(robot):
        if lower == upper:
            yield Problem(
                joint,
                f"limits of joint '{joint.name}' are both {lower:g}, so it cannot move; "
                "make it fixed, or write its range",
                at=limit.element.attribute_place("upper"),
            )


@rule(WARNING, effects={"every reader": "takes radians: 90 is more than fourteen turns"})
def limit_in_degrees(robot: Robot, *, largest: float = 4 * math.pi) -> Iterator[Problem]:
    """A revolute joint's limit is larger than two turns.

    Angles are in radians. 90 lets the joint turn fourteen times, which winds up cables and gives
    planners a hundred ways to one pose. A very large number mostly means that there is no limit;
    then the joint is ``continuous``.
    """
    for joint in robot.joints:
        limit = joint.limit
        if joint.type != "revolute" or limit is None:
            continue
        lower, upper = limit.lower or 0.0, limit.upper or 0.0
        if max(abs(lower), abs(upper)) <= largest:
            continue
        name = "upper" if abs(upper) > largest else "lower"
        value = upper if name == "upper" else lower
        at = limit.element.attribute_place(name)
        what = f"{name} limit {value:g} of joint '{joint.name}'"
        if abs(value) >= 1e3:
            yield Problem(
                joint, f"{what} means none; make the joint continuous", at=at, severity=INFO
            )
        elif _looks_like_degrees(lower) and _looks_like_degrees(upper):
            low, high = math.radians(lower), math.radians(upper)
            yield Problem(
                joint,
                f"{what} looks like degrees; in radians the range is {low:.5g} to {high:.5g}",
                at=at,
            )
        else:
            turns = abs(value) / (2 * math.pi)
            yield Problem(
                joint,
                f"{what} is {turns:.3g} turns; limits are in radians",
                at=at,
            )


def _looks_like_degrees(value: float) -> bool:
    return abs(value) <= 720 and (value * 2).is_integer()


@rule(INFO, effects={"every reader": "takes metres"})
def prismatic_in_millimetres(robot: Robot, *, largest: float = 10.0) -> Iterator[Problem]:
    """A prismatic joint's limit, or the place of a joint, is more than ten metres.

    Lengths are in metres. Numbers of a drawing in millimetres make a thousandfold robot.
    """
    for joint, limit, lower, upper in _bounded(robot):
        if joint.type == "prismatic" and max(abs(lower), abs(upper)) > largest:
            name = "upper" if abs(upper) > largest else "lower"
            value = upper if name == "upper" else lower
            yield Problem(
                joint,
                f"{name} limit of joint '{joint.name}' is {value:g} m; "
                f"if that is millimetres, write {value / 1000:g}",
                at=limit.element.attribute_place(name),
            )
    for joint in robot.joints:
        if joint.origin is None:
            continue
        far = max(joint.origin.xyz, key=abs)
        if abs(far) > largest:
            yield Problem(
                joint,
                f"joint '{joint.name}' is {abs(far):g} m from its parent; "
                f"if that is millimetres, write {far / 1000:g}",
                at=joint.origin.element.attribute_place("xyz"),
            )


@rule(
    INFO,
    raised={"moveit": WARNING},
    effects={"moveit": "plans to positions that the drive refuses"},
)
def limit_rounded_outward(
    robot: Robot, *, smallest: float = 1e-7, largest: float = 1e-3
) -> Iterator[Problem]:
    """A revolute joint's limit is a multiple of 90° that was rounded up.

    ``3.1416`` is seven millionths of a radian beyond a half turn. Planners use them, and drives
    trip on them. Round limits towards zero: ``3.1415``.
    """
    for joint, limit, lower, upper in _bounded(robot):
        if joint.type != "revolute":
            continue
        for name, value in (("lower", lower), ("upper", upper)):
            quarter = math.pi / 2
            turns = math.floor(abs(value) / quarter)
            beyond = abs(value) - turns * quarter
            if turns and smallest < beyond < largest:
                inside = math.copysign(math.floor(turns * quarter * 1e4) / 1e4, value)
                yield Problem(
                    joint,
                    f"{name} limit {value:g} of joint '{joint.name}' is beyond {turns * 90}° "
                    f"by {beyond:.1g} rad; write {inside:g}",
                    at=limit.element.attribute_place(name),
                )


@rule(
    INFO,
    on=("moveit",),
    effects={"moveit": "has several joint values for one pose and may take the long way"},
)
def range_above_full_turn(robot: Robot) -> Iterator[Problem]:
    """A revolute joint's range is more than a full turn.

    One pose of the arm then has several joint values, and a planner may go the long way round.
    """
    for joint, limit, lower, upper in _bounded(robot):
        if joint.type == "revolute" and 2 * math.pi + 1e-3 < upper - lower < 1e3:
            turns = (upper - lower) / (2 * math.pi)
            yield Problem(
                joint,
                f"range of joint '{joint.name}' is {turns:.3g} turns; "
                "one turn is enough to reach every pose",
                at=limit,
            )


@rule(
    WARNING,
    effects={
        "urdfdom, pybullet, gz, gazebo-classic": "ignore the bounds",
        "mujoco": "3.3 keeps to them, 4.0 ignores them",
    },
)
def continuous_with_bounds(robot: Robot) -> Iterator[Problem]:
    """A continuous joint has a lower or upper limit.

    A continuous joint turns without end and most readers pass over the bounds; MuJoCo 3.3 keeps to
    them, so the same file is two robots. A joint with stops is ``revolute``.
    """
    for joint in robot.joints:
        limit = joint.limit
        if joint.type != "continuous" or limit is None:
            continue
        if limit.lower is None and limit.upper is None:
            continue
        name = "lower" if limit.lower is not None else "upper"
        if not (limit.lower or limit.upper):
            remedy = "take lower and upper out"
        else:
            remedy = "take lower and upper out, or make it revolute"
        yield Problem(
            joint,
            f"joint '{joint.name}' is continuous and its bounds are ignored; {remedy}",
            at=limit.element.attribute_place(name),
        )


@rule(
    INFO,
    raised=dict.fromkeys(("gz", "gazebo-classic", "moveit"), WARNING),
    effects={
        "gz, gazebo-classic": "spawn the joint at 0, outside its limits",
        "moveit": "has no start state within bounds",
    },
)
def zero_outside_limits(robot: Robot, *, tolerance: float = 1e-6) -> Iterator[Problem]:
    """A joint's range does not contain 0.

    Simulators start every joint at 0, so the first step throws it back over its stop, and planners
    start out of bounds. ros2_control can set an ``initial_value``.
    """
    for joint, limit, lower, upper in _bounded(robot):
        if joint.mimic is not None or lower > upper:
            continue
        if lower > tolerance or upper < -tolerance:
            name = "lower" if lower > 0 else "upper"
            yield Problem(
                joint,
                f"joint '{joint.name}' cannot be at 0, where simulators start it: "
                f"its range is {lower:g} to {upper:g}",
                at=limit.element.attribute_place(name),
            )


def _bounded(robot: Robot) -> Iterator[tuple[Joint, Limit, float, float]]:
    """Revolute and prismatic joints of which both bounds are written and can be read."""
    for joint in robot.joints:
        limit = joint.limit
        if limit is None or not joint.is_limited:
            continue
        lower, upper = limit.lower, limit.upper
        if lower is not None and upper is not None:
            yield joint, limit, lower, upper
