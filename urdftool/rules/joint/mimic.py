"""Rules on mimic joints."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.elements import Joint, Mimic, Robot
from ...model.numbers import number_text
from ...source.document import Element
from ..fix import FixContext, Proposal, get_suggestion, set_attribute, unsafe
from ..rule import (
    ANY_FORMAT,
    ERROR,
    INFO,
    UNSAFE,
    URDF_AND_SDF,
    WARNING,
    Problem,
    rule,
    select_holding,
)
from ..unexpanded import is_unexpanded
from ..words import find_nearest_joint, suggest_joint
from ..xml.vocabulary_table import find_misspelled_attributes

APPLIES_TO = ("mimic",)


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio (a name)": "accept it",
        "urdfdom, gz, gazebo-classic, pinocchio (no name)": "reject the robot",
        "moveit": "logs 'cannot mimic unknown joint', and moves the joint on its own",
        "mujoco (a name)": "drops the constraint, 4.0 with a warning",
        "mujoco (no name)": "4.0 rejects the file",
        "drake": "rejects the file",
        "ros2_control": "stops with an exception where the joint is in <ros2_control>",
        "pybullet": "does not read <mimic>",
        "newton": "drops the constraint with a warning",
    },
    group="robot",
    formats=ANY_FORMAT,
)
def mimic_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A mimic joint refers to a joint that does not exist.

    Nothing then moves the joint. urdfdom does not check the name, MuJoCo removes the constraint,
    Drake rejects the file, and ros2_control does not start. If the attribute ``joint`` is missing,
    urdfdom rejects the robot, and so do all readers that use it: ROS, Gazebo and pinocchio.
    """
    stripped = {name.strip() for name in robot.joint}
    for joint, mimic in _iterate_mimic_joints(robot):
        name = mimic.joint
        if name in robot.joint or is_unexpanded(name):
            continue
        if not name.strip():
            if mimic.has_attribute("joint") or not _is_misspelt(mimic.xml):
                yield _report_missing_leader(joint, mimic)
        elif name.strip() not in stripped:
            yield _report_unknown_leader(robot, joint, mimic)


@mimic_unknown_joint.full
def report_unknown_leaders(robot: Robot) -> Iterator[Problem]:
    """Report each mimic joint without an existing leader, also if the attribute is misspelled."""
    for joint, mimic in _iterate_mimic_joints(robot):
        if mimic.joint not in robot.joint:
            if mimic.joint.strip():
                yield _report_unknown_leader(robot, joint, mimic)
            else:
                place = mimic.locate_attribute("joint")
                yield Problem(joint, _describe_missing_leader(joint), at=place)


def _report_missing_leader(joint: Joint, mimic: Mimic) -> Problem:
    written = mimic.has_attribute("joint")
    effects = select_holding(mimic_unknown_joint.effects, "no name" if not written else "a name")
    return Problem(
        joint, _describe_missing_leader(joint), at=mimic, alike="no name", effects=effects
    )


def _describe_missing_leader(joint: Joint) -> str:
    return f"<mimic> of joint '{joint.name}' has no joint name; write joint=\"…\""


def _report_unknown_leader(robot: Robot, joint: Joint, mimic: Mimic) -> Problem:
    near = suggest_joint(robot, mimic.joint)
    return Problem(
        joint,
        f"joint '{joint.name}' mimics '{mimic.joint}', but the robot has no such joint{near}",
        at=mimic.locate_attribute("joint"),
        alike=bool(near),
        data={"suggestion": find_nearest_joint(robot, mimic.joint)},
        effects=select_holding(mimic_unknown_joint.effects, "a name"),
    )


def _is_misspelt(element: Element | None) -> bool:
    """Tell whether the attribute has a different name, which another rule reports."""
    if element is None:
        return False
    return "name" in element.attributes or "joint" in find_misspelled_attributes(element).values()


@mimic_unknown_joint.fix(UNSAFE)
def write_suggested_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the existing joint with the most similar name."""
    joint = context.get_joint(problem)
    if joint.mimic is None:
        return None
    name = get_suggestion(problem, joint.mimic.joint)
    if not name or name == joint.name:
        return None
    return unsafe(f"mimic '{name}'", set_attribute(joint.mimic.element, "joint", name))


@rule(
    ERROR,
    effects={
        "moveit": "ignores every mimic joint of the robot",
        "mujoco (several joints)": "3.3 ignores it; 4.0 couples the joints, once for each <mimic>",
        "mujoco (one joint)": "4.0 rejects the file",
        "drake (several joints)": "couples the joints, once for each <mimic>",
        "drake (one joint)": "rejects it",
        "newton": "rejects the robot",
    },
    formats=ANY_FORMAT,
)
def mimic_cycle(robot: Robot) -> Iterator[Problem]:
    """Mimic joints follow each other in a circle.

    No joint of the circle leads, so nothing defines their positions. MoveIt then ignores all mimic
    joints of the robot. Remove one ``<mimic>``.
    """
    done: set[str] = set()
    for joint, _ in _iterate_mimic_joints(robot):
        names: list[str] = []
        follower: Joint | None = joint
        while follower is not None and follower.mimic is not None and follower.name not in done:
            if follower.name in names:
                circle = names[names.index(follower.name) :]
                yield _report_cycle(robot.joint[circle[0]], circle)
                break
            names.append(follower.name)
            follower = robot.joint.get(follower.mimic.joint)
        done.update(names)


@mimic_cycle.full
def report_joints_of_cycles(robot: Robot) -> Iterator[Problem]:
    """Report each mimic joint that follows itself, directly or through others."""
    circles: dict[str, list[str]] = {}
    seen: set[str] = set()
    for first, _ in _iterate_mimic_joints(robot):
        names: dict[str, None] = {}
        joint: Joint | None = first
        while joint is not None and joint.mimic is not None and joint.name not in seen:
            seen.add(joint.name)
            names[joint.name] = None
            joint = robot.joint.get(joint.mimic.joint)
        if joint is not None and joint.name in names:
            order = list(names)
            circle = order[order.index(joint.name) :]
            circles |= dict.fromkeys(circle, circle)
    for joint, mimic in _iterate_mimic_joints(robot):
        if mimic.joint == joint.name:  # of several joints of one name, each
            yield _report_cycle(joint, [joint.name])
        elif robot.joint.get(joint.name) is joint and joint.name in circles:
            circle = circles[joint.name]
            if len(circle) <= _LONGEST_TURNED:
                at = circle.index(joint.name)
                circle = [*circle[at:], *circle[:at]]
            yield _report_cycle(joint, circle)


_LONGEST_TURNED = 100
"""Longest circle that each finding lists from its own joint; chosen."""
_SHOWN = 6
"""Number of joints that a message names. Chosen, no source."""


def _report_cycle(joint: Joint, circle: list[str]) -> Problem:
    assert joint.mimic is not None  # callers pass mimic joints only
    if len(circle) == 1:
        message = f"joint '{joint.name}' mimics itself; it must follow another joint"
    else:
        some = [f"'{name}'" for name in circle]
        if len(some) > _SHOWN:
            some = [*some[: _SHOWN - 1], f"{len(some) - _SHOWN + 1} others"]
        names = " follows ".join((*some, f"'{circle[0]}'"))
        message = f"mimic joints follow each other: {names}; remove one <mimic>"
    place = joint.mimic.locate_attribute("joint")
    case = "one joint" if len(circle) == 1 else "several joints"
    effects = select_holding(mimic_cycle.effects, case)
    return Problem(joint, message, at=place, data={"joints": circle}, effects=effects)


@rule(
    WARNING,
    effects={
        "robot_state_publisher": "publishes the joint only if the leading joints sort before it",
        "moveit": "follows the chain",
    },
)
def mimic_chain(robot: Robot) -> Iterator[Problem]:
    """A mimic joint follows a joint that is itself a mimic joint.

    robot_state_publisher processes the joints once, in alphabetical order. If the leader comes
    later, it publishes no transform for the joint, and the links below are missing in tf. Refer to
    the first leader, and multiply the multipliers.
    """
    for joint, mimic in _iterate_mimic_joints(robot):
        leader = robot.joint.get(mimic.joint)
        if leader is None or leader.mimic is None or leader is joint:
            continue
        if joint.is_fixed or leader.is_fixed:
            continue  # mimic-dof-mismatch reports it
        first = robot.joint.get(leader.mimic.joint)
        if first is None or first is joint or first.mimic is not None:
            continue
        multiplier = mimic.multiplier * leader.mimic.multiplier
        offset = mimic.multiplier * leader.mimic.offset + mimic.offset
        yield Problem(
            joint,
            f"joint '{joint.name}' mimics '{leader.name}', itself a mimic joint; "
            f"mimic '{first.name}' with multiplier {multiplier:g} and offset {offset:g}",
            at=mimic.locate_attribute("joint"),
            data={"joint": first.name, "multiplier": multiplier, "offset": offset},
        )


@mimic_chain.fix(UNSAFE)
def follow_first_leader(problem: Problem, context: FixContext) -> Proposal | None:
    """Refer to the first leader, and multiply the multipliers.

    The fix is unsafe because it changes which joints the MuJoCo constraint couples; the motion is
    the same.
    """
    mimic, data = context.get_joint(problem).mimic, problem.data
    if mimic is None:
        return None
    changes = [set_attribute(mimic.element, "joint", data["joint"])]
    for name, default in (("multiplier", 1.0), ("offset", 0.0)):
        if data[name] != default or name in mimic.element.attributes:
            changes.append(set_attribute(mimic.element, name, number_text(data[name])))
    return unsafe(f"mimic '{data['joint']}'", *changes)


@rule(
    WARNING,
    effects={
        "mujoco": "4.0: limit and mimic constraint conflict, and the leader stops early too",
    },
    caused_by=("limit-in-degrees", "prismatic-in-millimeters"),
    group="robot",
    formats=ANY_FORMAT,
)
def mimic_limits_inconsistent(robot: Robot, *, tolerance: float = 1e-3) -> Iterator[Problem]:
    """The limits of a mimic joint are too narrow for the range of its leader.

    At the limit of the leader, the mimic joint would have to be beyond its own limit. In MuJoCo 4.0
    the mimic constraint and the limit conflict: the leader stops early, and a gripper may
    oscillate. ``tolerance`` [rad or m] is the difference that is ignored. If the limits hold for
    the opposite multiplier, its sign is the first thing to check, and the finding is at it.
    Otherwise the description does not show which of the two joints has the right limits, so the
    rule has no fix. Joints whose bounds are exchanged, or that mimic each other in a circle, are
    not reported.
    """
    circular = {problem.name for problem in report_joints_of_cycles(robot)}
    for joint, mimic in _iterate_mimic_joints(robot):
        leader = robot.joint.get(mimic.joint)
        if leader is None or leader.limit is None or joint.limit is None:
            continue
        if not (joint.is_limited and leader.is_limited) or joint.name in circular:
            continue
        bounds = (leader.limit.lower, leader.limit.upper, joint.limit.lower, joint.limit.upper)
        if None in bounds:
            continue
        low, high, lower, upper = (value or 0.0 for value in bounds)
        if not math.isfinite(high - low):  # a slide of an MJCF without a range
            continue
        ends = sorted(mimic.multiplier * value + mimic.offset for value in (low, high))
        is_narrow = ends[0] < lower - tolerance or ends[1] > upper + tolerance
        if low <= high and lower <= upper and is_narrow:
            name = "lower" if ends[0] < lower - tolerance else "upper"
            turned = sorted(mimic.offset - mimic.multiplier * value for value in (low, high))
            fits = lower - tolerance <= turned[0] and turned[1] <= upper + tolerance
            remedy = f"reduce the limits of '{leader.name}', or extend those of '{joint.name}'"
            if fits:
                remedy = (
                    f"with multiplier {-mimic.multiplier:g} in place of {mimic.multiplier:g} it "
                    "would keep them; check the sign first, then the limits"
                )
            yield Problem(
                joint,
                f"mimic joint '{joint.name}' follows '{leader.name}' from {ends[0]:.4g} "
                f"to {ends[1]:.4g}, beyond its own limits {lower:g} to {upper:g}; {remedy}",
                at=mimic.locate_attribute("multiplier")
                if fits
                else joint.limit.locate_attribute(name),
                cause=(joint, leader),
                alike=fits,
                data={"leader": leader.name, "range": ends, "limits": [lower, upper]},
            )


@rule(
    ERROR,
    effects={
        "moveit": "ignores it: the degrees of freedom differ",
        "ros2_control": "stops with an exception for a fixed joint",
        "newton": "rejects the robot for a fixed joint",
    },
    formats=URDF_AND_SDF,
)
def mimic_dof_mismatch(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A mimic joint or its leader does not have exactly one axis, or the multiplier is 0.

    A fixed joint has no position, a floating or planar joint has several. With a multiplier of 0
    the joint never moves. Fixed mimic joints are one finding, and so are all mimic joints of one
    leader. For a fixed mimic joint that is not in ``<ros2_control>`` the finding is an info, unless
    Newton is a target: it does not move, as its type says.
    """
    controlled = {one.name for block in robot.ros2_controls for one in block.joints}
    alike: dict[tuple[str, str], list[tuple[Joint, Mimic]]] = {}
    for joint, mimic in _iterate_mimic_joints(robot):
        leader = robot.joint.get(mimic.joint)
        for one in (joint, leader):
            if one is not None and one.type in ("fixed", "floating", "planar"):
                key = (one.type, "" if one is joint else one.name)
                alike.setdefault(key, []).append((joint, mimic))
                break
        else:
            if mimic.multiplier == 0.0 and leader is not None:
                yield Problem(
                    joint,
                    f"joint '{joint.name}' follows '{leader.name}' with multiplier 0, so it never "
                    "moves; write its multiplier, or make it fixed",
                    at=mimic.locate_attribute("multiplier"),
                    effects=(),
                )
    for (kind, leading), found in alike.items():
        (joint, mimic), names = found[0], [f"'{joint.name}'" for joint, _ in found]
        if leading:
            what = f"'{leading}' is {kind} and is mimicked by {', '.join(names)}"
        else:
            what = f"{names[0]} is {kind} and mimics another"
            what += f"; so are {', '.join(names[1:])}" if names[1:] else ""
        keys = set()
        if any(
            _has_different_variables(joint, robot.joint.get(mimic.joint)) for joint, mimic in found
        ):
            keys.add("moveit")
        if kind == "fixed" and any(joint.name in controlled for joint, _ in found):
            keys.add("ros2_control")
        if kind == "fixed":
            keys.add("newton")
        is_harmless = kind == "fixed" and not leading and "ros2_control" not in keys
        yield Problem(
            joint,
            f"joint {what}; <mimic> requires joints with one axis",
            at=mimic,
            severity=INFO if is_harmless and "newton" not in targets else None,
            effects=keys,
            data={"type": kind, "joints": [joint.name for joint, _ in found]},
        )


@mimic_dof_mismatch.full
def report_fixed_leaders(robot: Robot) -> Iterator[Problem]:
    """Report each mimic joint whose leader is fixed and so has no position."""
    for joint, mimic in _iterate_mimic_joints(robot):
        leader = robot.joint.get(mimic.joint)
        if leader is not None and leader.is_fixed:
            yield Problem(
                joint,
                f"joint '{joint.name}' mimics '{leader.name}', which is fixed; <mimic> requires "
                "joints with one axis",
                at=mimic.locate_attribute("joint"),
                data={"type": leader.type, "joints": [joint.name]},
            )


_VARIABLES = {"fixed": 0, "planar": 3, "floating": 7}
"""Number of position variables of a joint in MoveIt; every other type has one."""


def _has_different_variables(joint: Joint, leader: Joint | None) -> bool:
    """Tell whether two joints have different numbers of position variables in MoveIt."""
    return leader is not None and (_VARIABLES.get(joint.type, 1) != _VARIABLES.get(leader.type, 1))


@rule(
    INFO,
    on=("gazebo-classic", "mujoco", "pybullet"),
    effects={
        "pybullet": "ignores <mimic>: the joint moves on its own",
        "gz, gazebo-classic": "drop it if sdformat 12.3 reads the robot",
        "mujoco": "3.3 ignores it, 4.0 makes it a constraint",
    },
)
def mimic_not_simulated(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The simulator does not simulate the mimic joints of the robot.

    A mimic joint then moves freely, independent of its leader. Gazebo Classic requires a plugin for
    it, MuJoCo before 4.0 an ``<equality>``, PyBullet a gear constraint. Joints that a Gazebo plugin
    names in ``<mimicJoint>`` are reported for MuJoCo and PyBullet only, and so are joints of a loop
    that an SDF ``<joint>`` in a ``<gazebo>`` block closes.
    """
    plugged = {
        child.text.strip()
        for plugin in robot.plugins
        for child in plugin.element.list_children("mimicJoint")
    } | _find_joints_above_loops(robot)
    free = [pair for pair in _iterate_mimic_joints(robot) if pair[0].name not in plugged]
    if free:
        yield _report_free_joints(
            free, "where <mimic> is not simulated; add a plugin or a constraint", []
        )
    moved = [pair for pair in _iterate_mimic_joints(robot) if pair[0].name in plugged]
    readers = [name for target, name in _WITHOUT_PLUGINS.items() if target in targets]
    if moved and readers:
        do = "do" if len(readers) > 1 else "does"
        yield _report_free_joints(
            moved,
            f"in {' and '.join(readers)}, which {do} not read the Gazebo plugin or SDF joint that "
            "moves it; add a constraint",
            readers,
        )


def _find_joints_above_loops(robot: Robot) -> set[str]:
    """Get the names of mimic joints above an end of an SDF joint, which closes a loop."""
    ends = {end for closure in robot.closures for end in (closure.parent, closure.child)}
    found = set()
    for joint, _ in _iterate_mimic_joints(robot) if ends else ():
        below = {joint.child, *robot.tree.list_descendants(joint.child)}
        if not below.isdisjoint(ends):
            found.add(joint.name)
    return found


_WITHOUT_PLUGINS = {"mujoco": "MuJoCo before 4.0", "pybullet": "PyBullet"}


def _report_free_joints(
    mimics: list[tuple[Joint, Mimic]], where: str, readers: list[str]
) -> Problem:
    """Report mimic joints that move freely, and the readers for which this holds alone."""
    joint, mimic = mimics[0]
    more = f" (and {len(mimics) - 1} more)" if len(mimics) > 1 else ""
    return Problem(
        joint,
        f"mimic joint '{joint.name}'{more} moves freely {where}",
        at=mimic,
        data={"joints": [one.name for one, _ in mimics], "readers": readers},
    )


def _iterate_mimic_joints(robot: Robot) -> Iterator[tuple[Joint, Mimic]]:
    return ((joint, joint.mimic) for joint in robot.joints if joint.mimic is not None)
