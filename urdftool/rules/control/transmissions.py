"""Transmissions of ros_control."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot, Transmission
from ..gazebo.lumping import is_lumped
from ..joint.range import is_locked
from ..rule import ERROR, INFO, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean

APPLIES_TO = ("transmission", "plugin")

JOINT_INTERFACES = ("EffortJointInterface", "PositionJointInterface", "VelocityJointInterface")


def called(transmission: Transmission) -> str:
    """A transmission by its name, or by its first joint."""
    if transmission.name:
        return f"transmission '{transmission.name}'"
    joint = transmission.joints[0].name if transmission.joints else ""
    return f"the transmission of joint '{joint}'" if joint else "a transmission"


@rule(ERROR, effects={"gazebo_ros_control": "fails to start: no joint is controlled"})
def transmission_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A transmission names a joint that is not there.

    ``gazebo_ros_control`` looks every joint up and gives up at the first that it does not find, so
    one misspelt name leaves the whole robot limp. Drivers of real hardware do much the same.
    """
    driven = {joint.name for transmission in robot.transmissions for joint in transmission.joints}
    idle = [name for name, joint in robot.joint.items() if name not in driven and joint.has_axis]
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            if joint.name and joint.name not in robot.joint and not is_unexpanded(joint.name):
                yield Problem(
                    transmission.element,
                    f"{called(transmission)} names joint '{joint.name}', "
                    f"which is not there{did_you_mean(joint.name, idle, 0.8)}",
                    at=joint.element.attribute_place("name"),
                )


@rule(
    WARNING,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "accepts it, and warns of deprecated syntax at every start",
    },
    group="robot",
)
def unprefixed_hardware_interface(robot: Robot) -> Iterator[Problem]:
    """A hardware interface lacks its ``hardware_interface/``.

    ``EffortJointInterface`` alone is the syntax of before 2014. It is still taken, with a warning
    for every joint, by ``gazebo_ros_control``; other hardware compares the whole name and finds
    none.
    """
    for transmission in robot.transmissions:
        if not transmission.name:
            continue  # it is not read, which is reported
        for joint in transmission.joints:
            for child in joint.element.all("hardwareInterface"):
                name = child.text.strip()
                if name in JOINT_INTERFACES:
                    yield Problem(
                        transmission.element,
                        f"'{name}' in {called(transmission)} lacks its prefix; "
                        f"write hardware_interface/{name}",
                        at=child,
                        group="{count} hardware interfaces lack their prefix hardware_interface/, "
                        "in the transmissions {names}",
                    )


@rule(
    ERROR,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "skips the transmission, with an error in the log",
    },
)
def incomplete_transmission(robot: Robot) -> Iterator[Problem]:
    """A transmission lacks its type, joint or actuator.

    The parser skips such a transmission with one line in the log, and a controller for its joint
    then says that there is no such joint.
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
                f"{called(transmission)} has no <{'> and no <'.join(missing)}>",
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

    Without ``<hardwareInterface>`` in the joint it is not known whether it is driven by effort,
    velocity or position; the transmission is skipped. One inside the ``<actuator>`` is the layout
    of before 2014 and does not count.
    """
    for transmission in robot.transmissions:
        if transmission.type.startswith("pr2_"):
            continue
        inside = [a for a in transmission.actuators if a.hardware_interfaces]
        for joint in transmission.joints:
            if joint.hardware_interfaces or not joint.name:
                continue
            where = "only in its actuator; move it into" if inside else "in none; write it into"
            yield Problem(
                transmission.element,
                f"{called(transmission)} has its <hardwareInterface> {where} "
                f'<joint name="{joint.name}">',
                at=inside[0] if inside else joint,
            )


_KNOWN = (
    *(f"hardware_interface/{name}" for name in JOINT_INTERFACES),
    "hardware_interface/JointStateInterface",
    "hardware_interface/PosVelJointInterface",
    "hardware_interface/PosVelAccJointInterface",
    "hardware_interface/ActuatorStateInterface",
    "hardware_interface/ImuSensorInterface",
    "hardware_interface/ForceTorqueSensorInterface",
)


@rule(ERROR, on=("ros1",), effects={"gazebo_ros_control": "fails to start: no joint is controlled"})
def unknown_hardware_interface(robot: Robot) -> Iterator[Problem]:
    """A hardware interface is none that there is.

    ``gazebo_ros_control`` knows effort, position and velocity; any other name ends its start with a
    fatal error, for all joints.
    """
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            for child in joint.element.all("hardwareInterface"):
                name = child.text.strip()
                if name in JOINT_INTERFACES or name in _KNOWN or is_unexpanded(name):
                    continue
                if "/" in name and not name.startswith("hardware_interface/"):
                    continue  # that of another package
                near = did_you_mean(name, _KNOWN, 0.6)
                yield Problem(
                    transmission.element,
                    f"'{name}' in {called(transmission)} is no hardware interface"
                    + (near or "; write such as hardware_interface/EffortJointInterface"),
                    at=child,
                )


@rule(
    INFO,
    on=("ros1",),
    effects={
        "gazebo_ros_control": "takes the first, with a warning",
    },
)
def several_hardware_interfaces(robot: Robot) -> Iterator[Problem]:
    """A joint of a transmission has several hardware interfaces.

    Real hardware may offer them all; ``gazebo_ros_control`` takes the first and says so. One
    finding names the joints. It skips transmissions of several joints, and another
    ``<robotSimType>`` than ``DefaultRobotHWSim`` may take all interfaces: these are not reported.
    """
    if any(
        kind.text.strip() and kind.text.strip().rpartition("/")[2] != "DefaultRobotHWSim"
        for plugin in robot.plugins
        for kind in plugin.element.all("robotSimType")
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
            f"joint '{joint.name}' in {called(transmission)} has "
            f"{len(joint.hardware_interfaces)} interfaces; Gazebo takes the first"
            + (f"; so it does of {others}" if others else ""),
            at=list(joint.element.all("hardwareInterface"))[1],
        )


@rule(
    WARNING,
    effects={
        "gazebo_ros_control": "replaces the handle of the joint by the second, with a warning",
    },
)
def duplicate_transmission(robot: Robot) -> Iterator[Problem]:
    """Two transmissions have one name, or drive one joint.

    The names are those of resources, and there can be one of each. Of two simple transmissions at
    one joint, one is left over from a copy.
    """
    names: set[str] = set()
    joints: dict[str, str] = {}
    for transmission in robot.transmissions:
        name = transmission.name
        if name and name in names:
            yield Problem(
                transmission.element,
                f"a second transmission is called '{name}'; give it a name of its own",
                at=transmission.element.attribute_place("name"),
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
                f"joint '{joint.name}' is driven by transmission '{other}' already; take one away",
                at=joint.element.attribute_place("name"),
            )


@rule(
    ERROR,
    effects={
        "gazebo_ros_control (loaded)": (
            "fails to start: the merged joint is not in the simulated robot"
        ),
        "gz, gazebo-classic (merged)": "merge the fixed joint",
    },
    group="robot",
)
def transmission_on_immovable_joint(robot: Robot) -> Iterator[Problem]:
    """A transmission drives a fixed joint.

    There is nothing to drive, and in Gazebo the joint does not even exist: fixed joints are lumped.
    It is an error where the plugin of ``gazebo_ros_control`` is loaded and reads the transmission,
    and a warning elsewhere.
    """
    loaded = any("gazebo_ros_control" in plugin.filename for plugin in robot.plugins)
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            driven = robot.joint.get(joint.name)
            if driven is None or not driven.is_fixed:
                continue
            interfaces = [
                *(part.hardware_interfaces for part in transmission.joints),
                *(part.hardware_interfaces for part in transmission.actuators),
            ]
            keys = []
            if is_lumped(robot, driven.child):
                keys.append("gz, gazebo-classic (merged)")
                # without a type or an interface the plugin skips the transmission
                if loaded and transmission.type and any(interfaces):
                    keys.append("gazebo_ros_control (loaded)")
            yield Problem(
                transmission.element,
                f"{called(transmission)} drives '{joint.name}', which is fixed",
                at=joint.element.attribute_place("name"),
                severity=None if len(keys) > 1 else WARNING,
                effects=keys,
            )


_PASSIVE = re.compile(
    r"caster|castor|passive|suspension|spring|damper|rocker|bogie|free", re.IGNORECASE
)


@rule(
    WARNING,
    on=("ros1",),
    effects={"gazebo_ros_control": "neither reports nor drives the joint"},
    group="robot",
)
def actuated_joint_without_transmission(robot: Robot) -> Iterator[Problem]:
    """A joint moves and has no transmission, in a robot that ros_control drives.

    ``gazebo_ros_control`` knows the joints of transmissions and no others: this one swings freely,
    and no joint state tells where it is. In a loop that a joint of SDF closes the others move it;
    and casters, suspensions and other passive joints, by their names, are not driven.
    """
    if not any("gazebo_ros_control" in plugin.filename for plugin in robot.plugins):
        return
    driven = {joint.name for t in robot.transmissions for joint in t.joints}
    others = {
        child.text.strip()
        for plugin in robot.plugins
        for child in plugin.element.children
        if "oint" in child.tag
    }
    others.update(_in_loops(robot))
    for joint in robot.moving_joints:
        if joint.mimic is not None or joint.name in driven | others or not joint.has_axis:
            continue
        if not is_locked(joint) and not any(map(_PASSIVE.search, (joint.name, joint.child))):
            yield Problem(
                joint,
                f"joint '{joint.name}' moves and has no <transmission>, so nothing drives it",
            )


def _in_loops(robot: Robot) -> Iterator[str]:
    """Joints of the loops that a ``<joint>`` in a ``<gazebo>`` closes."""
    for block in robot.gazebo:
        for joint in () if block.reference else block.element.all("joint"):
            sides = []
            for end in (joint.child("parent"), joint.child("child")):
                name = end.text.strip() if end is not None else ""
                if name not in robot.link and name != "world":
                    yield from robot.joint  # which of them are in the loop is not known
                sides.append({name, *robot.tree.ancestors(name)} if name in robot.link else set())
            for name in sides[0] ^ sides[1]:
                above = robot.tree.parent_joint(name)
                if above is not None:
                    yield above.name


@rule(
    INFO,
    on=("ros2",),
    effects={
        "ros2_control": "reads only what is in <ros2_control>",
    },
)
def ros1_transmission_in_ros2(robot: Robot) -> Iterator[Problem]:
    """A transmission of ROS 1 stands in a robot for ROS 2.

    ``ros2_control`` looks for transmissions inside ``<ros2_control>``, and passes over those
    directly in the robot.
    """
    if robot.transmissions:
        first = robot.transmissions[0]
        count = len(robot.transmissions)
        more = f" (and {count - 1} more)" if count > 1 else ""
        yield Problem(
            first.element,
            f"transmission '{first.name}'{more} is not read in ROS 2; "
            "<ros2_control> says how joints are driven",
        )
