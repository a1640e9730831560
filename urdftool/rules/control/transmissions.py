"""Rules on transmissions of ros_control."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot, Transmission
from ...source.description import Description
from ..fix import (
    FixContext,
    Proposal,
    append_child,
    append_number,
    escape_attribute,
    find_element,
    remove_element,
    safe,
    substitute_text,
    unsafe,
    write_suggestion,
)
from ..rule import ERROR, INFO, SAFE, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import find_nearest, suggest_name
from .dependence import OF_CLASSIC, depends_on_control

APPLIES_TO = ("transmission", "plugin")

JOINT_INTERFACES = ("EffortJointInterface", "PositionJointInterface", "VelocityJointInterface")


def has_own_hardware(robot: Robot) -> bool:
    """Tell whether gazebo_ros_control loads another hardware than the default, such as franka's."""
    names = (plugin.element.find_child("robotSimType") for plugin in robot.plugins)
    return any(name is not None and "DefaultRobotHWSim" not in name.text for name in names)


def describe_transmission(transmission: Transmission) -> str:
    """Describe a transmission by its name, or by its first joint."""
    if transmission.name:
        return f"transmission '{transmission.name}'"
    joint = transmission.joints[0].name if transmission.joints else ""
    return f"the transmission of joint '{joint}'" if joint else "a transmission"


@rule(
    ERROR,
    effects={"gazebo_ros_control": "fails to start: no joint is controlled"},
    group="robot",
)
def transmission_unknown_joint(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """A transmission refers to a joint that does not exist.

    ``gazebo_ros_control`` stops at the first unknown joint, so no joint of the robot is controlled.
    Many hardware drivers do the same. Without that plugin, and without a package that depends on
    it, it is a warning. It is not reported in ROS 2 for a robot with ``<ros2_control>``, where
    nothing reads the transmissions (``ros1-transmission-in-ros2``).
    """
    is_read = _has_control_plugin(robot) or depends_on_control(description)
    if not is_read and robot.ros2_controls and "ros2" in targets:
        return
    severity = None if is_read else WARNING
    driven = {joint.name for transmission in robot.transmissions for joint in transmission.joints}
    idle = [name for name, joint in robot.joint.items() if name not in driven and joint.has_axis]
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            if joint.name and joint.name not in robot.joint and not is_unexpanded(joint.name):
                yield Problem(
                    transmission.element,
                    f"{describe_transmission(transmission)} refers to joint '{joint.name}', "
                    f"which does not exist{suggest_name(joint.name, idle, 0.8)}",
                    at=joint.locate_attribute("name"),
                    severity=severity,
                    effects=None if is_read else (),
                    group="{count} transmissions refer to joints that do not exist: {names}",
                    data={"joint": joint.name, "suggestion": find_nearest(joint.name, idle, 0.8)},
                )


transmission_unknown_joint.fix(UNSAFE)(write_suggestion)


@rule(
    INFO,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "accepts it, with a warning of deprecated syntax at every start",
    },
    group="robot",
)
def unprefixed_hardware_interface(robot: Robot, description: Description) -> Iterator[Problem]:
    """A hardware interface has no prefix ``hardware_interface/``.

    ``EffortJointInterface`` alone is deprecated since 2014. ``gazebo_ros_control`` accepts it with
    a warning for each joint; other hardware compares the full name and does not find it. Reported
    only for a robot with that plugin, or whose package depends on it: otherwise the transmission is
    left over, and nothing reads it.
    """
    if not (_has_control_plugin(robot) or depends_on_control(description)):
        return
    for transmission in robot.transmissions:
        if not transmission.name:
            continue  # another rule reports that it is not read
        for joint in transmission.joints:
            for child in joint.element.list_children("hardwareInterface"):
                name = child.text.strip()
                if name in JOINT_INTERFACES:
                    yield Problem(
                        transmission.element,
                        f"'{name}' in {describe_transmission(transmission)} has no prefix; "
                        f"write hardware_interface/{name}",
                        at=child,
                        group="{count} hardware interfaces have no prefix hardware_interface/, "
                        "in the transmissions {names}",
                    )


def _has_control_plugin(robot: Robot) -> bool:
    return any(name in plugin.filename for plugin in robot.plugins for name in OF_CLASSIC)


@unprefixed_hardware_interface.fix(SAFE)
def write_prefix(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the prefix."""
    element = find_element(problem)
    if element is None:
        return None
    name = element.text.strip()
    return safe(
        f"write hardware_interface/{name}",
        substitute_text(
            element, r"^(\s*)(?=(?:Effort|Position|Velocity)Joint)", r"\1hardware_interface/"
        ),
    )


@rule(
    ERROR,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "skips the transmission, with an error in the log",
    },
)
def incomplete_transmission(robot: Robot) -> Iterator[Problem]:
    """A transmission has no type, joint or actuator.

    The parser skips the transmission with an error in the log, and a controller then reports that
    its joint does not exist.
    """
    for transmission in robot.transmissions:
        if transmission.type.startswith("pr2_"):
            continue
        missing = [
            word
            for word, there in (
                ("type", transmission.type),
                ("joint", transmission.joints),
                ("actuator", transmission.actuators),
            )
            if not there
        ]
        if missing:
            yield Problem(
                transmission.element,
                f"{describe_transmission(transmission)} has no <{'> and no <'.join(missing)}>",
                data={"missing": missing},
            )


@rule(
    ERROR,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "skips the transmission, with an error in the log",
    },
)
def missing_hardware_interface(robot: Robot) -> Iterator[Problem]:
    """The joint of a transmission has no hardware interface.

    ``<hardwareInterface>`` in the joint selects effort, velocity or position; without it the
    transmission is skipped. A ``<hardwareInterface>`` in the ``<actuator>`` is the layout before
    2014, and is not read.
    """
    for transmission in robot.transmissions:
        if transmission.type.startswith("pr2_"):
            continue
        inside = [a for a in transmission.actuators if a.hardware_interfaces]
        for joint in transmission.joints:
            if joint.hardware_interfaces or not joint.name:
                continue
            what = (
                "has its <hardwareInterface> in the actuator; move it"
                if inside
                else ("has no <hardwareInterface>; write it")
            )
            yield Problem(
                transmission.element,
                f'{describe_transmission(transmission)} {what} into <joint name="{joint.name}">',
                at=inside[0] if inside else joint,
            )


@missing_hardware_interface.fix(UNSAFE)
def move_interface(problem: Problem, context: FixContext) -> Proposal | None:
    """Move the interface from the actuator into the joint."""
    transmission = problem.element
    joints = [
        joint
        for joint in transmission.list_children("joint")
        if not joint.find_child("hardwareInterface")
    ]
    inside = [
        interface
        for actuator in transmission.list_children("actuator")
        for interface in actuator.list_children("hardwareInterface")
    ]
    if len(joints) != 1 or not inside or not inside[0].text.strip():
        return None
    changes = [remove_element(interface) for interface in inside]
    line = f"<hardwareInterface>{escape_attribute(inside[0].text.strip())}</hardwareInterface>"
    return unsafe("move it into the joint", *changes, append_child(joints[0], line))


_KNOWN = (
    *(f"hardware_interface/{name}" for name in JOINT_INTERFACES),
    "hardware_interface/JointStateInterface",
    "hardware_interface/PosVelJointInterface",
    "hardware_interface/PosVelAccJointInterface",
    "hardware_interface/ActuatorStateInterface",
    "hardware_interface/ImuSensorInterface",
    "hardware_interface/ForceTorqueSensorInterface",
)


@rule(
    ERROR,
    on=("ros1",),
    effects={"gazebo_ros_control": "fails to start: no joint is controlled"},
    group="robot",
)
def unknown_hardware_interface(robot: Robot) -> Iterator[Problem]:
    """A hardware interface is unknown.

    ``gazebo_ros_control`` reads effort, position and velocity interfaces; any other name stops it
    with a fatal error, so no joint is controlled.
    """
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            for child in joint.element.list_children("hardwareInterface"):
                name = child.text.strip()
                if name in JOINT_INTERFACES or name in _KNOWN or is_unexpanded(name):
                    continue
                if "/" in name and not (_is_path(name) or name.startswith("hardware_interface/")):
                    continue  # interface of another package
                near = suggest_name(name, _KNOWN, 0.6)
                yield Problem(
                    transmission.element,
                    f"'{name}' in {describe_transmission(transmission)} is not a hardware interface"
                    + (near or "; write, for example, hardware_interface/EffortJointInterface"),
                    at=child,
                    data={"suggestion": find_nearest(name, _KNOWN, 0.6)},
                    alike=name,
                )


unknown_hardware_interface.fix(UNSAFE)(write_suggestion)


def _is_path(name: str) -> bool:
    """Tell whether a name is a path, such as one that an argument was expanded to."""
    return "\\" in name or name.startswith(("/", "."))


@rule(
    INFO,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "takes the first, with a warning",
    },
)
def several_hardware_interfaces(robot: Robot) -> Iterator[Problem]:
    """A joint of a transmission has several hardware interfaces.

    Real hardware may support all of them; ``gazebo_ros_control`` takes the first, with a warning.
    One finding lists all joints. Not reported are transmissions with several joints, which Gazebo
    skips, and robots with a ``<robotSimType>`` other than ``DefaultRobotHWSim``, which may read all
    interfaces.
    """
    if any(
        kind.text.strip() and kind.text.strip().rpartition("/")[2] != "DefaultRobotHWSim"
        for plugin in robot.plugins
        for kind in plugin.element.list_children("robotSimType")
    ):
        return
    found = [
        (transmission, transmission.joints[0])
        for transmission in robot.transmissions
        if len(transmission.joints) == 1 and len(transmission.joints[0].hardware_interfaces) > 1
    ]
    if found:
        (transmission, joint), *rest = found
        others = ", ".join(f"'{other.name}'" for _, other in rest)
        yield Problem(
            transmission.element,
            f"joint '{joint.name}' in {describe_transmission(transmission)} has "
            f"{len(joint.hardware_interfaces)} interfaces; Gazebo takes the first"
            + (f"; the same applies to {others}" if others else ""),
            at=list(joint.element.list_children("hardwareInterface"))[1],
        )


@rule(
    WARNING,
    effects={
        "gazebo_ros_control": "replaces the handle of the joint by the second, with a warning",
    },
)
def duplicate_transmission(robot: Robot) -> Iterator[Problem]:
    """Two transmissions have the same name, or drive the same joint.

    Names of transmissions must be unique. Of two simple transmissions for one joint,
    ``gazebo_ros_control`` uses the second, with a warning. A robot whose plugin names another
    hardware than the default is not reported.
    """
    if has_own_hardware(robot):
        return
    names: set[str] = set()
    joints: dict[str, str] = {}
    for transmission in robot.transmissions:
        name = transmission.name
        if name and name in names:
            yield Problem(
                transmission.element,
                f"another transmission also has the name '{name}'; make it unique",
                at=transmission.locate_attribute("name"),
                data={"name": name},
            )
            continue
        names.add(name)
        if len(transmission.joints) != 1:
            continue
        joint = transmission.joints[0]
        other = joints.setdefault(joint.name, name)
        if joint.name and other != name:
            yield Problem(
                transmission.element,
                f"joint '{joint.name}' is already driven by transmission '{other}'; remove "
                "one of them",
                at=joint.locate_attribute("name"),
                data={"joint": joint.name, "other": other},
            )


@duplicate_transmission.fix(UNSAFE)
def number_transmission(problem: Problem, context: FixContext) -> Proposal | None:
    """Append a number to a duplicate name; of two transmissions for a joint, none is chosen."""
    if "name" not in problem.data:
        return None
    return append_number(problem, {one.name for one in context.robot.transmissions})
