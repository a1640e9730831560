"""Joints that follow another."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Joint, Mimic, Robot
from ...source.document import Element
from ..fix import FixContext, Proposal, format_numbers, set_attribute, suggestion_of, unsafe
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean, nearest
from ..xml.vocabulary_table import misspelt_attributes
from .range import bounds_of_joint

APPLIES_TO = ("mimic",)


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": (
            "accept it; reject the robot where the attribute is missing"
        ),
        "moveit": "logs 'cannot mimic unknown joint', and moves the joint on its own",
        "mujoco": (
            "drops the constraint, 4.0 with a warning; 4.0 rejects the file where the "
            "attribute is missing"
        ),
        "drake": "rejects the file",
        "ros2_control": "stops with an exception where the joint is in <ros2_control>",
        "pybullet": "does not read <mimic>",
    },
    group="robot",
)
def mimic_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A mimic joint follows a joint that is not there.

    Nothing then moves it. urdfdom does not look, MuJoCo drops the constraint, Drake rejects the
    file, ros2_control does not start. A ``<mimic>`` without the attribute ``joint`` is worse:
    urdfdom, and with it every reader of ROS, Gazebo and pinocchio, rejects the robot.
    """
    stripped = {name.strip() for name in robot.joint}
    for joint, mimic in _mimics(robot):
        name = mimic.joint
        if name in robot.joint or is_unexpanded(name):
            continue
        if not name.strip():
            if "joint" in mimic.element.attributes or not _is_misspelt(mimic.element):
                yield Problem(joint, _without_leader(joint), at=mimic, alike="no name")
        elif name.strip() not in stripped:
            yield _unknown_leader(robot, joint, mimic)


@mimic_unknown_joint.full
def every_unknown_leader(robot: Robot) -> Iterator[Problem]:
    """Report each joint that follows none of the robot, also where the attribute is misspelt."""
    for joint, mimic in _mimics(robot):
        if mimic.joint not in robot.joint:
            if mimic.joint.strip():
                yield _unknown_leader(robot, joint, mimic)
            else:
                place = mimic.element.attribute_place("joint")
                yield Problem(joint, _without_leader(joint), at=place)


def _without_leader(joint: Joint) -> str:
    return f"<mimic> of joint '{joint.name}' names no joint; write joint=\"…\""


def _unknown_leader(robot: Robot, joint: Joint, mimic: Mimic) -> Problem:
    near = did_you_mean(mimic.joint, robot.joint)
    return Problem(
        joint,
        f"joint '{joint.name}' mimics '{mimic.joint}', which is no joint{near}",
        at=mimic.element.attribute_place("joint"),
        alike=bool(near),
        data={"suggestion": nearest(mimic.joint, robot.joint)},
    )


def _is_misspelt(element: Element) -> bool:
    """Whether the attribute is there under another name, which is a finding of its own."""
    return "name" in element.attributes or "joint" in misspelt_attributes(element).values()


@mimic_unknown_joint.fix(UNSAFE)
def write_suggested_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Follow the joint that is meant."""
    joint = context.joint(problem)
    if joint.mimic is None:
        return None
    name = suggestion_of(problem, joint.mimic.joint)
    if not name or name == joint.name:
        return None
    return unsafe(f"mimic '{name}'", set_attribute(joint.mimic.element, "joint", name))


@rule(
    ERROR,
    effects={
        "moveit": "ignores every mimic joint of the robot",
        "mujoco": "3.3 ignores it; 4.0 couples the two joints twice",
        "drake": "couples the two joints twice; rejects a joint that mimics itself",
    },
)
def mimic_cycle(robot: Robot) -> Iterator[Problem]:
    """Mimic joints follow each other in a circle.

    None of them leads. MoveIt then ignores all mimic joints of the robot.
    """
    done: set[str] = set()
    for joint, _ in _mimics(robot):
        names: list[str] = []
        follower: Joint | None = joint
        while follower is not None and follower.mimic is not None and follower.name not in done:
            if follower.name in names:
                circle = names[names.index(follower.name) :]
                yield _of_circle(robot.joint[circle[0]], circle)
                break
            names.append(follower.name)
            follower = robot.joint.get(follower.mimic.joint)
        done.update(names)


@mimic_cycle.full
def every_joint_of_circle(robot: Robot) -> Iterator[Problem]:
    """Report each joint that follows itself in the end."""
    for joint, mimic in _mimics(robot):
        circle = [joint.name]
        leader = joint if mimic.joint == joint.name else robot.joint.get(mimic.joint)
        while leader is not None and leader.mimic is not None and leader.name not in circle:
            circle.append(leader.name)
            leader = robot.joint.get(leader.mimic.joint)
        if leader is not None and leader.mimic is not None and leader.name == joint.name:
            yield _of_circle(joint, circle)


def _of_circle(joint: Joint, circle: list[str]) -> Problem:
    assert joint.mimic is not None  # only mimic joints are gone through
    if len(circle) == 1:
        message = f"joint '{joint.name}' mimics itself; it must follow another joint"
    else:
        names = " follows ".join(f"'{name}'" for name in (*circle, circle[0]))
        message = f"mimic joints follow each other: {names}; one must lead"
    place = joint.mimic.element.attribute_place("joint")
    return Problem(joint, message, at=place, data={"joints": circle})


@rule(
    WARNING,
    effects={
        "robot_state_publisher": "publishes the joint only if the leading joints sort before it",
        "moveit": "follows the chain",
    },
)
def mimic_chain(robot: Robot) -> Iterator[Problem]:
    """A mimic joint follows a joint that is itself a mimic joint.

    robot_state_publisher goes over the joints once, in the order of the alphabet. A joint whose
    leader comes later gets no transform, and its part of the robot vanishes from tf. Let each
    follow the first leader, with the multipliers multiplied.
    """
    for joint, mimic in _mimics(robot):
        leader = robot.joint.get(mimic.joint)
        if leader is None or leader.mimic is None or leader is joint:
            continue
        first = robot.joint.get(leader.mimic.joint)
        if first is None or first is joint or first.mimic is not None:
            continue
        multiplier = mimic.multiplier * leader.mimic.multiplier
        offset = mimic.multiplier * leader.mimic.offset + mimic.offset
        yield Problem(
            joint,
            f"joint '{joint.name}' mimics '{leader.name}', itself a mimic joint; "
            f"mimic '{first.name}' with multiplier {multiplier:g} and offset {offset:g}",
            at=mimic.element.attribute_place("joint"),
            data={"joint": first.name, "multiplier": multiplier, "offset": offset},
        )


@mimic_chain.fix(UNSAFE)
def follow_first_leader(problem: Problem, context: FixContext) -> Proposal | None:
    """Follow the first leader, with the multipliers multiplied.

    It is the same motion, and another constraint in MuJoCo, which ties the joint to another one.
    """
    mimic, data = context.joint(problem).mimic, problem.data
    if mimic is None:
        return None
    changes = [set_attribute(mimic.element, "joint", data["joint"])]
    for name, default in (("multiplier", 1.0), ("offset", 0.0)):
        if data[name] != default or name in mimic.element.attributes:
            changes.append(set_attribute(mimic.element, name, format_numbers([data[name]], 15)))
    return unsafe(f"mimic '{data['joint']}'", *changes)


@rule(
    WARNING,
    effects={
        "mujoco": "4.0: the two constraints fight, and the leader stops early too",
    },
)
def mimic_limits_inconsistent(robot: Robot, *, tolerance: float = 1e-3) -> Iterator[Problem]:
    """A mimic joint's own limits stop it before its leader is at its limit.

    Where the leader goes to its end, the follower would have to go beyond its own. The constraint
    pulls, the stop holds, and the gripper halts half way or shakes.
    """
    for joint, mimic in _mimics(robot):
        leader = robot.joint.get(mimic.joint)
        if leader is None or leader.limit is None or joint.limit is None:
            continue
        if not (joint.is_limited and leader.is_limited) or leader is joint:
            continue
        bounds = (leader.limit.lower, leader.limit.upper, joint.limit.lower, joint.limit.upper)
        if None in bounds:
            continue
        low, high, lower, upper = (value or 0.0 for value in bounds)
        ends = sorted(mimic.multiplier * value + mimic.offset for value in (low, high))
        if low <= high and (ends[0] < lower - tolerance or ends[1] > upper + tolerance):
            name = "lower" if ends[0] < lower - tolerance else "upper"
            yield Problem(
                joint,
                f"joint '{joint.name}' follows '{leader.name}' from {ends[0]:.4g} "
                f"to {ends[1]:.4g}, beyond its own limits {lower:g} to {upper:g}",
                at=joint.limit.element.attribute_place(name),
                data={"leader": leader.name, "range": ends, "limits": [lower, upper]},
            )


@mimic_limits_inconsistent.fix(UNSAFE)
def lower_limits_of_leader(problem: Problem, context: FixContext) -> Proposal | None:
    """Lower the limits of the leader to what its follower can do.

    The limits of the follower are those of the hardware, and are not raised.
    """
    joint = context.joint(problem)
    mimic = joint.mimic
    leader = context.robot.joint.get(mimic.joint) if mimic is not None else None
    if mimic is None or leader is None or not mimic.multiplier:
        return None
    own, other = bounds_of_joint(joint), bounds_of_joint(leader)
    if own is None or other is None:
        return None
    ends = sorted((value - mimic.offset) / mimic.multiplier for value in own[1:])
    limit, lower, upper = other
    low, high = max(ends[0], lower), min(ends[1], upper)
    if low >= high:
        return None
    changes = []
    if low > lower:
        changes.append(set_attribute(limit.element, "lower", format_numbers([low])))
    if high < upper:
        changes.append(set_attribute(limit.element, "upper", format_numbers([high])))
    return unsafe(f"limit '{leader.name}' to {low:g} … {high:g}", *changes)


@rule(
    ERROR,
    effects={
        "moveit": "ignores it: the degrees of freedom differ",
        "ros2_control": "stops with an exception for a fixed joint",
    },
)
def mimic_dof_mismatch(robot: Robot) -> Iterator[Problem]:
    """A mimic joint or its leader does not have just one way to move, or the multiplier is 0.

    A fixed joint has no position to follow or to give, a floating or planar one has several. With a
    multiplier of 0 the joint stands still. Fixed followers are one finding, and so are all
    followers of one leader. Only a remark is a fixed follower that is not in ``<ros2_control>``:
    it does not move, which is what fixed says.
    """
    controlled = {one.name for block in robot.ros2_controls for one in block.joints}
    alike: dict[tuple[str, str], list[tuple[Joint, Mimic]]] = {}
    for joint, mimic in _mimics(robot):
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
                    "moves; write how far it goes, or make it fixed",
                    at=mimic.element.attribute_place("multiplier"),
                    effects=(),
                )
    for (kind, leading), found in alike.items():
        (joint, mimic), names = found[0], [f"'{joint.name}'" for joint, _ in found]
        if leading:
            what = f"'{leading}' is {kind} and is followed by {', '.join(names)}"
        else:
            what = f"{names[0]} is {kind} and follows another"
            what += f"; so are {', '.join(names[1:])}" if names[1:] else ""
        keys = set()
        if any(_differ(joint, robot.joint.get(mimic.joint)) for joint, mimic in found):
            keys.add("moveit")
        if kind == "fixed" and any(joint.name in controlled for joint, _ in found):
            keys.add("ros2_control")
        yield Problem(
            joint,
            f"joint {what}; only a joint with one axis can",
            at=mimic,
            severity=INFO if kind == "fixed" and not leading and keys <= {"moveit"} else None,
            effects=keys,
            data={"type": kind, "joints": [joint.name for joint, _ in found]},
        )


@mimic_dof_mismatch.full
def every_mimic_of_fixed_joint(robot: Robot) -> Iterator[Problem]:
    """Report each mimic joint whose leader is fixed, and has no position to follow."""
    for joint, mimic in _mimics(robot):
        leader = robot.joint.get(mimic.joint)
        if leader is not None and leader.is_fixed:
            yield Problem(
                joint,
                f"joint '{joint.name}' follows '{leader.name}', which is fixed; only a joint with "
                "one axis can be followed",
                at=mimic.element.attribute_place("joint"),
                data={"type": leader.type, "joints": [joint.name]},
            )


_VARIABLES = {"fixed": 0, "planar": 3, "floating": 7}
"""Numbers that state a joint's position in MoveIt; of every other type one."""


def _differ(joint: Joint, leader: Joint | None) -> bool:
    """Whether two joints have positions of different sizes in MoveIt."""
    return leader is not None and (_VARIABLES.get(joint.type, 1) != _VARIABLES.get(leader.type, 1))


@rule(
    INFO,
    on=("gazebo-classic", "mujoco", "pybullet"),
    effects={
        "pybullet": "ignores <mimic>: the joint moves on its own",
        "gz, gazebo-classic": "drop it where sdformat 12.3 reads the robot",
        "mujoco": "3.3 ignores it, 4.0 makes it a constraint",
    },
)
def mimic_not_simulated(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The robot has mimic joints, and the simulator does not simulate them.

    The follower is then a free joint that hangs where gravity takes it. Gazebo Classic needs a
    plugin for it, MuJoCo before 4.0 an ``<equality>``, PyBullet a gear constraint. Joints that a
    Gazebo plugin names in ``<mimicJoint>``, and those that move a link which a ``<joint>`` of SDF
    in a ``<gazebo>`` block joins to another, are reported for MuJoCo and PyBullet alone.
    """
    plugged = {
        child.text.strip() for plugin in robot.plugins for child in plugin.element.all("mimicJoint")
    } | _in_loops(robot)
    free = [pair for pair in _mimics(robot) if pair[0].name not in plugged]
    if free:
        yield _hanging(free, "where <mimic> is not simulated; add a plugin or a constraint")
    moved = [pair for pair in _mimics(robot) if pair[0].name in plugged]
    readers = [name for target, name in _WITHOUT_PLUGINS.items() if target in targets]
    if moved and readers:
        read = "do" if len(readers) > 1 else "does"
        yield _hanging(
            moved,
            f"in {' and '.join(readers)}, which {read} not read what moves it in Gazebo; add a "
            "constraint",
        )


def _in_loops(robot: Robot) -> set[str]:
    """Name the mimic joints that move an end of a joint of SDF, which closes a loop."""
    ends = {
        end.text.strip()
        for block in robot.gazebo
        for joint in block.element.all("joint")
        for end in (joint.child("parent"), joint.child("child"))
        if end is not None
    }
    found = set()
    for joint, _ in _mimics(robot) if ends else ():
        below = {joint.child, *robot.tree.descendants(joint.child)}
        if not below.isdisjoint(ends):
            found.add(joint.name)
    return found


_WITHOUT_PLUGINS = {"mujoco": "MuJoCo before 4.0", "pybullet": "PyBullet"}


def _hanging(mimics: list[tuple[Joint, Mimic]], where: str) -> Problem:
    joint, mimic = mimics[0]
    more = f" and {len(mimics) - 1} more" if len(mimics) > 1 else ""
    are = "mimic joints hang" if more else "a mimic joint hangs"
    return Problem(
        joint,
        f"joint '{joint.name}'{more}: {are} free {where}",
        at=mimic,
        data={"joints": [one.name for one, _ in mimics]},
    )


def _mimics(robot: Robot) -> Iterator[tuple[Joint, Mimic]]:
    return ((joint, joint.mimic) for joint in robot.joints if joint.mimic is not None)
