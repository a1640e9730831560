"""Rules on effort and velocity limits, damping and friction of a joint."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from ...diagnostic import Severity
from ...model.actuation import find_actuated_joints, find_measured_joints, is_passive
from ...model.elements import Joint, Limit, Robot
from ...model.kinematics import MOVABLE
from ...model.read import number
from ...model.settings import MAGNITUDES, RESISTANCE_OF_URDF
from ..fix import FixContext, Proposal, remove_element, remove_sign, replace_element, safe, unsafe
from ..gazebo.contact import is_wheel
from ..rule import ANY_FORMAT, ERROR, INFO, SAFE, UNSAFE, WARNING, Problem, rule, select_holding
from ..symmetry import find_twins
from ..words import quote
from ..xml.vocabulary_table import (
    find_misspelled_attributes,
    find_misspelled_children,
    is_for_another_reader,
)
from .idle import is_dummy
from .range import is_locked

_UNITS = {"prismatic": ("N", "m/s")}


@rule(
    WARNING,
    raised={"gz": ERROR},
    effects={
        "gz": "passes a limit of 0 on to the engine: the joint cannot be driven",
        "mujoco": "loads it without the limit",
    },
    of_motion=True,
    group="robot",
    formats=ANY_FORMAT,
)
def zero_effort_limit(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The effort limit of a moving joint is 0.

    Gazebo takes it as a motor without force, so the joint cannot be driven. MuJoCo takes it as no
    limit. Write the maximum effort of the drive, from its data sheet. In a file with Drake elements
    the finding is an info, because Drake uses 0 for a passive joint. A joint is not reported where
    a transmission, ros2_control or a plugin drives other joints and not this one: it is passive,
    and 0 is correct. ``locked-by-limits`` reports a joint whose lower and upper limit are equal.
    A joint named as a dummy that moves neither geometry nor more than 1 g is not reported. Unless
    new Gazebo is a target, the finding is an info where no joint has a limit of effort, as an
    exporter writes them, and where the joints of both sides have none, but most others have.
    """
    passive = "gz" not in targets and (is_for_another_reader(robot.xml) or _are_meant(robot))
    actuated = find_actuated_joints(robot)
    for joint, limit in _iterate_driven(robot):
        if limit.effort == 0.0 and not is_passive(joint, actuated) and not is_locked(joint):
            if is_dummy(robot, joint):
                continue
            yield Problem(
                joint,
                f"effort limit of joint '{joint.name}' is 0; "
                f"write the maximum {'force [N]' if joint.type == 'prismatic' else 'torque [N·m]'} "
                "of its drive, if it has one",
                at=limit.locate_attribute("effort"),
                severity=INFO if passive else None,
                alike=joint.type == "prismatic",
            )


def _are_meant(robot: Robot) -> bool:
    """Tell whether limits of 0 are of all joints of a robot, or of pairs of passive joints."""
    driven = list(_iterate_driven(robot))
    if not any(limit.effort for _, limit in driven):
        return True
    none = {joint.name for joint, limit in driven if limit.effort == 0.0}
    twins = {name: find_twins(name, robot.joint) for name in none}
    paired = {*twins, *(one for others in twins.values() for one in others)} & none
    right = {one for others in twins.values() for one in others}
    both = all(others or name in right for name, others in twins.items()) and right <= none
    return both and len(paired) * 3 <= len(driven)


@rule(
    WARNING,
    raised={"moveit": ERROR},
    effects={
        "moveit": "does not time a trajectory: no velocity limit was defined",
        "gz": "passes a limit of 0 on to the engine",
    },
    caused_by=("zero-effort-limit",),
    group="robot",
    formats=ANY_FORMAT,
    pedantic="effort limits that are 0 too, unless MoveIt or new Gazebo is a target",
)
def zero_velocity_limit(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The velocity limit of a moving joint is 0.

    Gazebo then does not allow the joint to move. MoveIt takes it as a missing limit and cannot time
    a trajectory. Where the effort limit is 0 too, both are one finding: an exporter wrote them.
    ``locked-by-limits`` reports a joint whose lower and upper limit are equal. A joint named as a
    dummy that moves neither geometry nor more than 1 g is not reported.
    """
    for joint, limit in _iterate_driven(robot):
        if limit.velocity == 0.0 and not is_locked(joint) and not is_dummy(robot, joint):
            yield Problem(
                joint,
                f"velocity limit of joint '{joint.name}' is 0, so it must not move; "
                f"write its maximum [{_get_units(joint)[1]}]",
                at=limit.locate_attribute("velocity"),
                alike=joint.type == "prismatic",
                pedantic=limit.effort == 0.0 and targets.isdisjoint(("moveit", "gz")),
            )


def _iterate_driven(robot: Robot) -> Iterator[tuple[Joint, Limit]]:
    for joint in robot.joints:
        if joint.limit is not None and joint.mimic is None:
            if joint.type in MOVABLE:
                yield joint, joint.limit


def _get_units(joint: Joint) -> tuple[str, str]:
    return _UNITS.get(joint.type, ("N·m", "rad/s"))


@rule(
    ERROR,
    effects={
        "gz": "treats it as unlimited",
        "mujoco (an effort)": "takes its absolute value",
        "moveit (a velocity)": "takes its absolute value",
        "drake (a velocity)": "aborts",
        "pinocchio": "rejects the robot",
    },
)
def negative_limit(robot: Robot) -> Iterator[Problem]:
    """An effort or velocity limit is negative.

    Both limits are magnitudes. Readers differ: Gazebo takes a negative one as no limit, MuJoCo and
    MoveIt take its absolute value, pinocchio rejects the robot.
    """
    for joint in robot.joints:
        if joint.limit is None:
            continue
        for name in MAGNITUDES:
            value = getattr(joint.limit, name)
            if value is not None and value < 0:
                yield Problem(
                    joint,
                    f"{name} limit of joint '{joint.name}' is {value:g}; write {-value:g}",
                    at=joint.limit.locate_attribute(name),
                    effects=select_holding(
                        negative_limit.effects, "a velocity" if name == "velocity" else "an effort"
                    ),
                    data={name: value},
                )


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, pybullet, pinocchio, drake": "take it as written",
    },
    of_motion=True,
    group="robot",
    infos=True,
)
def implausible_velocity(
    robot: Robot, *, fastest_turn: float = 200.0, fastest_slide: float = 50.0, together: float = 4
) -> Iterator[Problem]:
    """A velocity limit is higher than joints of robots reach.

    The number is usually in degrees per second or revolutions per minute, or it is a placeholder
    for no limit, such as 1000 or 1e6. Planners time trajectories by it. A joint whose lower and
    upper limit are equal is not reported, neither is a passive joint with effort limit 0, or a
    joint that ros2_control only measures, or a placeholder for no limit where no transmission,
    ``<ros2_control>`` or plugin drives a joint. ``fastest_turn`` [rad/s] and ``fastest_slide``
    [m/s] are the highest plausible velocities. Where more than ``together`` joints have the same
    value, they are one finding.
    """
    found = []
    measured, actuated = find_measured_joints(robot), find_actuated_joints(robot)
    for joint, limit in _iterate_driven(robot):
        if joint.type == "continuous" or limit.velocity is None or is_locked(joint):
            continue
        if limit.effort == 0.0 or joint.name in measured:
            continue
        fastest = fastest_slide if joint.type == "prismatic" else fastest_turn
        if limit.velocity > fastest:
            if not actuated and _is_endless(limit.velocity):
                continue
            excess = _describe_excess(limit.velocity, fastest)
            what = f"{limit.velocity:g} {_get_units(joint)[1]}, {excess}"
            found.append(
                _ImplausibleLimit(joint, limit, limit.velocity, _is_endless(limit.velocity), what)
            )
    yield from _report_limits(found, together, "velocity")


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet, pinocchio": "take it as written",
    },
    of_motion=True,
    group="robot",
)
def implausible_effort(
    robot: Robot, *, largest: float = 1e4, together: float = 4
) -> Iterator[Problem]:
    """An effort limit is higher than drives of robots deliver.

    A large placeholder for no limit allows every command: a simulated motor then exerts forces at
    which the real one would have stalled. A joint that is not actuated, where other joints are, is
    not reported. ``largest`` [N·m, N] is the highest plausible effort. Where more than ``together``
    joints have the same value, they are one finding.
    """
    actuated = find_actuated_joints(robot)
    found = [
        _ImplausibleLimit(
            joint,
            limit,
            limit.effort,
            _is_endless(limit.effort),
            f"{limit.effort:g} {_get_units(joint)[0]}, {_describe_excess(limit.effort, largest)}",
        )
        for joint, limit in _iterate_driven(robot)
        if limit.effort is not None and limit.effort > largest and not is_passive(joint, actuated)
    ]
    yield from _report_limits(found, together, "effort")


def _report_limits(
    found: list[_ImplausibleLimit], together: float, attribute: str
) -> Iterator[Problem]:
    for one, more in _deduplicate(found, together):
        yield Problem(
            one.joint,
            f"{attribute} limit of joint '{one.joint.name}'{more} is {one.what}; "
            "write the maximum of the drive",
            at=one.limit.locate_attribute(attribute),
            alike=(one.is_slide, one.is_endless, bool(more)),
            data={attribute: one.value},
        )


def _describe_excess(value: float, most: float) -> str:
    """Describe how a limit exceeds the largest plausible one; a power of ten means no limit."""
    return "in effect no limit" if _is_endless(value) else f"above {most:g}"


def _is_endless(value: float) -> bool:
    """Tell whether a large limit means no limit."""
    power = math.log10(value)
    return value >= _NO_LIMIT or abs(power - round(power)) < 1e-9


_NO_LIMIT = 1e6
"""Velocity [rad/s, m/s] or effort [N·m, N] from which a limit is a placeholder for no limit."""


class _ImplausibleLimit(NamedTuple):
    """A limit that is implausibly large."""

    joint: Joint
    limit: Limit
    value: float
    is_endless: bool
    what: str

    @property
    def is_slide(self) -> bool:
        """Tell whether the joint is prismatic."""
        return self.joint.type == "prismatic"


def _deduplicate(
    found: list[_ImplausibleLimit], together: float
) -> Iterator[tuple[_ImplausibleLimit, str]]:
    """Yield each limit, or the first of more than ``together`` that are equal."""
    times = Counter((one.value, one.is_slide) for one in found)
    reported = set()
    for one in found:
        key = one.value, one.is_slide
        if times[key] <= together:
            yield one, ""
        elif key not in reported:
            reported.add(key)
            yield one, f" (and {times[key] - 1} more)"


@rule(
    ERROR,
    effects={
        "drake (a damping)": "rejects the file",
        "mujoco, pybullet": "use the negative value: the joint gains energy",
    },
    of_motion=True,
    formats=ANY_FORMAT,
)
def negative_dynamics(robot: Robot) -> Iterator[Problem]:
    """The damping or friction of a joint is negative.

    A negative value adds energy to the joint, so a small motion grows until the simulation
    diverges. For a fixed joint the finding is an info, because no reader uses the value. In SDF and
    MJCF it is a warning: no reader rejects it there.
    """
    for joint in robot.joints:
        dynamics = joint.dynamics
        if dynamics is None:
            continue
        for name in RESISTANCE_OF_URDF:
            value = getattr(dynamics, name)
            if value is not None and value < 0:
                yield Problem(
                    joint,
                    f"{name} of joint '{joint.name}' is {value:g}; write {-value:g}",
                    at=dynamics.locate_attribute(name),
                    severity=_choose_severity(robot, joint),
                    effects=select_holding(
                        negative_dynamics.effects, *["a damping"] * (name == "damping")
                    ),
                    data={name: value},
                )


def _choose_severity(robot: Robot, joint: Joint) -> Severity | None:
    if joint.is_fixed:
        return INFO
    return None if robot.format == "urdf" else WARNING


negative_limit.fix(UNSAFE)(remove_sign)
negative_dynamics.fix(UNSAFE)(remove_sign)


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio": "reject the robot",
        "mujoco, drake": "take 0",
    },
)
def empty_dynamics(robot: Robot) -> Iterator[Problem]:
    """A ``<dynamics>`` has neither damping nor friction.

    ``<dynamics>`` is optional, but urdfdom rejects the robot if it is empty.
    """
    for joint in robot.joints:
        if joint.dynamics is None:
            continue
        element = joint.dynamics.element
        if not element.attributes.keys().isdisjoint(RESISTANCE_OF_URDF) or element.children:
            continue
        if not find_misspelled_attributes(element):
            yield Problem(
                joint,
                f"<dynamics> of joint '{joint.name}' has neither damping nor friction; "
                "write one, or remove the element",
                at=element,
            )


@empty_dynamics.fix(SAFE)
def remove_empty_dynamics(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the empty ``<dynamics>``."""
    dynamics = context.get_joint(problem).dynamics
    if dynamics is None or dynamics.element.attributes:
        return None
    return safe("remove the empty <dynamics>", remove_element(dynamics.element))


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio": (
            "reject the robot: no damping and no friction"
        ),
        "mujoco, drake": "ignore them",
    },
)
def dynamics_as_child_elements(robot: Robot) -> Iterator[Problem]:
    """Damping or friction is written as a child element of ``<dynamics>``.

    SDF has child elements, URDF has attributes. Readers that use urdfdom reject a ``<dynamics>``
    without attributes.
    """
    for joint in robot.joints:
        if joint.dynamics is None or not joint.dynamics.element.children:
            continue
        children = joint.dynamics.element.children
        written = " ".join(f'{c.tag}="{c.text.strip()}"' for c in children if c.text.strip())
        first = children[0]
        yield Problem(
            joint,
            f"<{first.tag}> in the <dynamics> of joint '{joint.name}' is not read; "
            f"write <dynamics {written or first.tag + '=…'}/>",
            at=first,
        )


@dynamics_as_child_elements.fix(UNSAFE)
def write_dynamics_attributes(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the child elements as attributes.

    The fix is unsafe because MuJoCo loads the robot without this damping and friction before it.
    """
    dynamics = context.get_joint(problem).dynamics
    if dynamics is None:
        return None
    element = dynamics.element
    written = {child.tag: " ".join(child.text.split()) for child in element.children}
    if not written or len(written) < len(element.children) or element.attributes:
        return None
    if not written.keys() <= {*RESISTANCE_OF_URDF} or any(
        number(text) is None for text in written.values()
    ):
        return None
    line = "<dynamics " + " ".join(f'{k}="{v}"' for k, v in written.items()) + "/>"
    return unsafe(f"write {line}", replace_element(element, (line,)))


@rule(
    INFO,
    default=False,
    on=("gazebo-classic", "gz", "mujoco", "pybullet"),
    effects={
        "mujoco, drake": "take 0: no damping slows the joint",
        "pybullet": "takes 0: its default motor holds the joint until it is disabled",
        "gz, gazebo-classic": "take 0",
    },
)
def missing_dynamics(robot: Robot) -> Iterator[Problem]:
    """Moving joints have neither damping nor friction.

    No energy is lost in them: a joint without a motor swings for very long, and a joint under
    position control oscillates. Real bearings and gears have both. All such joints of a robot are
    one finding. A joint is not reported if its lower and upper limit are equal, if it turns a
    wheel, or if it is a mimic joint.
    """
    free = [
        joint
        for joint in robot.joints
        if joint.type in MOVABLE
        and not is_locked(joint)
        and _is_undamped(joint)
        and not _is_wheel_joint(robot, joint)
        and (joint.mimic is None or joint.mimic.joint not in robot.joint)
    ]
    if free:
        names = quote(joint.name for joint in free)
        which, verb = ("joint", "has") if len(free) == 1 else ("joints", "have")
        yield Problem(
            free[0],
            f"{which} {names} {verb} neither damping nor friction; "
            'write <dynamics damping="…" friction="…"/>',
            data={"joints": [joint.name for joint in free]},
        )


def _is_wheel_joint(robot: Robot, joint: Joint) -> bool:
    link = robot.link.get(joint.child)
    return joint.type == "continuous" and link is not None and is_wheel(robot, link)


def _is_undamped(joint: Joint) -> bool:
    if "dynamics" in find_misspelled_children(joint.element).values() or joint.element.find_child(
        "joint_properties"
    ):
        return False
    return joint.dynamics is None
