"""Rules on missing and needless limits of a joint."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator

from ...model.elements import JOINT_TYPES, Joint, Limit, Robot
from ...model.read import number
from ...model.settings import MAGNITUDES
from ..fix import (
    FixContext,
    Proposal,
    is_computed,
    remove_attribute,
    remove_element,
    safe,
    set_attribute,
    unsafe,
)
from ..rule import BOTH, ERROR, INFO, UNSAFE, WARNING, Problem, rule, select_holding
from ..xml.vocabulary_table import find_misspelled_attributes, find_misspelled_children


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio": "reject the robot",
        "mujoco, drake, newton": "load the joint without limits",
    },
    group="robot",
)
def missing_limit(robot: Robot) -> Iterator[Problem]:
    """A revolute or prismatic joint has no ``<limit>``.

    URDF requires it for these types. urdfdom rejects the robot; MuJoCo and Drake load the joint
    without limits. A revolute joint without limits is ``continuous``.
    """
    for joint in robot.joints:
        if not joint.is_limited or joint.limit is not None:
            continue
        if "limit" in find_misspelled_children(joint.element).values():
            continue
        yield _report_missing_limit(joint)


@missing_limit.full
def report_missing_limits(robot: Robot) -> Iterator[Problem]:
    """Report each joint that needs limits and has none, also where they are misspelled."""
    for joint in robot.joints:
        if joint.is_limited and joint.limit is None:
            yield _report_missing_limit(joint)


def _report_missing_limit(joint: Joint) -> Problem:
    or_type = ", or make it continuous" if joint.type == "revolute" else ""
    return Problem(
        joint,
        f"{joint.type} joint '{joint.name}' has no <limit>; "
        f"write lower, upper, effort and velocity{or_type}",
        alike=joint.type,
    )


@missing_limit.fix(UNSAFE, reveals=True)
def make_continuous(problem: Problem, context: FixContext) -> Proposal | None:
    """Make a revolute joint without limits continuous."""
    joint = context.get_joint(problem)
    if joint.type != "revolute":
        return None
    return unsafe("make it continuous", set_attribute(joint.element, "type", "continuous"))


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot (urdfdom 3, 4 and 6)",
        "pybullet": "takes 0",
        "mujoco": "loads it: without effort there is no limit, and velocity is never read",
        "drake": "loads it: without velocity there is no limit",
    },
    group="robot",
)
def limit_without_effort_or_velocity(robot: Robot) -> Iterator[Problem]:
    """A ``<limit>`` has no effort or no velocity.

    urdfdom rejects the robot, also for a fixed or continuous joint, unless the URDF version is 1.2.
    MuJoCo and Drake load it, so the defect is only noticed in ROS. For a joint of an unknown type,
    ``unknown-joint-type`` is reported instead.
    """
    if _read_version(robot) >= 1.2:
        return
    for joint in robot.joints:
        limit = joint.limit
        if limit is None or joint.type.lower() not in JOINT_TYPES:
            continue
        attributes = limit.element.attributes
        missing = [name for name in MAGNITUDES if name not in attributes]
        if missing and (meant := find_misspelled_attributes(limit.element)):
            missing = [name for name in missing if name not in meant.values()]
        if missing:
            words = " and no ".join(missing)
            yield Problem(
                joint,
                f"<limit> of joint '{joint.name}' has no {words}; both are required",
                at=limit,
                alike=tuple(missing),
                data={"missing": missing},
            )


def _read_version(robot: Robot) -> float:
    try:
        return float(robot.version or "1.0")
    except ValueError:
        return 1.0


@limit_without_effort_or_velocity.fix(BOTH)
def write_usual_limits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the most frequent effort and velocity of joints of the same type.

    The ``<limit>`` of a fixed joint is removed.
    """
    joint = context.get_joint(problem)
    limit = joint.limit
    if limit is None:
        return None
    if joint.is_fixed:
        if is_computed(joint.element, "type"):
            return None
        return safe("remove the <limit> of the fixed joint", remove_element(limit.element))
    changes, written = [], []
    for name in MAGNITUDES:
        if name not in limit.element.attributes:
            value = _get_usual_value(context.robot, joint, name)
            if value is None:
                return None
            changes.append(set_attribute(limit.element, name, value))
            written.append(f'{name}="{value}"')
    if not changes:
        return None
    return unsafe(f"write {' and '.join(written)}, as in its other joints", *changes)


def _get_usual_value(robot: Robot, joint: Joint, name: str) -> str | None:
    """Get the most frequent limit of the other joints of the same type, as written."""
    counts: Counter[str] = Counter()
    for other in robot.joints:
        limit = other.limit
        if other is joint or limit is None or other.is_fixed:
            continue
        if (other.type == "prismatic") != (joint.type == "prismatic"):
            continue
        text = limit.element.get(name)
        value = number(text)
        if text is not None and value is not None and value > 0:
            counts[text] += 1
    return counts.most_common(1)[0][0] if counts else None


_WITHOUT_BOUNDS = {
    "urdfdom, gz, gazebo-classic, pinocchio": "take 0 for a missing bound",
    "mujoco, pybullet, drake (both missing)": "load the joint without limits",
    "mujoco, pybullet (lower missing)": "take 0",
    "mujoco (upper missing)": "takes 0",
    "pybullet (upper missing)": "takes -1",
    "drake (lower missing)": "takes it as unlimited on that side",
    "drake (upper missing)": "takes it as unlimited on that side",
    "newton": "takes a missing bound as unlimited",
}


@rule(
    WARNING,
    effects=_WITHOUT_BOUNDS,
    group="robot",
)
def limit_without_bounds(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The ``<limit>`` of a revolute or prismatic joint has no lower or no upper bound.

    ROS and Gazebo take 0 for a missing bound. If both are missing they lock the joint at 0, while
    MuJoCo, PyBullet and Drake load it without limits. Exporters write this for wheels, which should
    be ``continuous``. Only a missing lower bound below a positive upper one is reported for Newton
    alone: 0 is the default of URDF.
    """
    for joint in robot.joints:
        limit = joint.limit
        if limit is None or not joint.is_limited:
            continue
        attributes = limit.element.attributes
        missing = [name for name in ("lower", "upper") if name not in attributes]
        if missing and (meant := find_misspelled_attributes(limit.element)):
            missing = [name for name in missing if name not in meant.values()]
        if not missing:
            continue
        if missing == ["lower"] and not _is_empty(limit) and "newton" not in targets:
            continue  # the default of URDF, 0, which all readers of the targets take
        case = "lower missing" if missing[0] == "lower" else "upper missing"
        if len(missing) == 2:
            case = "both missing"
            or_type = ", or make the joint continuous" if joint.type == "revolute" else ""
            what = "neither lower nor upper: ROS and Gazebo lock it at 0, MuJoCo, PyBullet, "
            what += f"Drake and Newton leave it without limits; write both{or_type}"
        elif missing[0] == "lower":
            what = "no lower: readers other than Drake and Newton take 0; write it"
        else:
            what = "no upper: ROS, Gazebo and MuJoCo take 0, PyBullet -1; write it"
        severity = WARNING if len(missing) == 2 or _is_empty(limit) else INFO
        yield Problem(
            joint,
            f"<limit> of joint '{joint.name}' has {what}",
            at=limit,
            severity=severity,
            effects=select_holding(_WITHOUT_BOUNDS, case),
            alike=(case, joint.type == "revolute"),
            data={"missing": missing},
        )


def _is_empty(limit: Limit) -> bool:
    return (limit.lower or 0.0) >= (limit.upper or 0.0)


@limit_without_bounds.fix(UNSAFE)
def write_missing_bound(problem: Problem, context: FixContext) -> Proposal | None:
    """Make a revolute joint without bounds continuous; write 0 for one missing bound.

    The fix is unsafe because readers differ: pinocchio and urdfdom take 0 for a missing bound,
    PyBullet takes -1 for a missing upper bound.
    """
    limit = context.get_joint(problem).limit
    if limit is None:
        return None
    missing = [name for name in ("lower", "upper") if name not in limit.element.attributes]
    if len(missing) == 2:
        return make_continuous(problem, context)
    return unsafe(f'write {missing[0]}="0"', set_attribute(limit.element, missing[0], "0"))


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, pybullet, pinocchio": "ignore the bounds",
        "urdfdom, drake": "keep them",
        "mujoco": "3.3 enforces them unless both are 0, 4.0 ignores them",
        "newton": "limits the joint to them",
    },
    group="robot",
    pedantic="bounds that are both 0, joints that mimic others, and robots called continuous, "
    "unless Newton is a target",
)
def continuous_with_bounds(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A continuous joint has a lower or upper limit.

    A continuous joint turns without limits, and most readers ignore the bounds. MuJoCo 3.3 enforces
    them unless both are 0, so simulators load two different robots. A joint with bounds is
    ``revolute``. Bounds that are both 0 are fields that an exporter left empty, and a joint that
    mimics another moves as far as that one. In a file or robot whose name has the word continuous,
    the type is meant.
    """
    path = "" if robot.source is None else os.path.basename(robot.source.path)
    is_meant = "continuous" in f"{path} {robot.name}".lower()
    for joint in robot.joints:
        limit = joint.limit
        if joint.type != "continuous" or limit is None:
            continue
        if limit.lower is None and limit.upper is None:
            continue
        if limit.lower is not None and limit.upper is not None and limit.lower > limit.upper:
            continue  # lower-above-upper reports it
        name = "lower" if limit.lower is not None else "upper"
        if not (limit.lower or limit.upper):
            remedy = "remove lower and upper"
        else:
            remedy = "remove lower and upper, or make it revolute"
        yield Problem(
            joint,
            f"joint '{joint.name}' is continuous, so most readers ignore its bounds; {remedy}",
            at=limit.locate_attribute(name),
            pedantic="newton" not in targets
            and (is_meant or joint.mimic is not None or not (limit.lower or limit.upper)),
            alike=remedy,
        )


@continuous_with_bounds.fix(UNSAFE)
def remove_bounds(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the bounds."""
    limit = context.get_joint(problem).limit
    if limit is None:
        return None
    names = [name for name in ("lower", "upper") if name in limit.element.attributes]
    changes = [remove_attribute(limit.element, name) for name in names]
    return unsafe(f"remove {' and '.join(names)}", *changes)
