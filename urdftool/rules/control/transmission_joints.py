"""Rules on joints of transmissions of ros_control."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Plugin, Robot, Transmission
from ...source.description import Description
from ..fix import (
    FixContext,
    Lines,
    Proposal,
    escape_attribute,
    get_written_value,
    insert_after,
    is_computed,
    remove_element,
    replace_element,
    unsafe,
)
from ..gazebo.lumping import is_lumped
from ..joint.range import is_locked
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from .dependence import OF_ROS2, depends_on_control
from .transmissions import describe_transmission, has_own_hardware

APPLIES_TO = ("transmission", "plugin")


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

    A fixed joint cannot move, and Gazebo removes it by fixed joint lumping. The finding is an error
    if the ``gazebo_ros_control`` plugin reads the transmission, and a warning in other cases. A
    robot whose plugin names another hardware than the default is not reported.
    """
    if has_own_hardware(robot):
        return
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
                f"{describe_transmission(transmission)} drives joint '{joint.name}', "
                "which is fixed; remove it",
                at=joint.locate_attribute("name"),
                severity=None if len(keys) > 1 else WARNING,
                effects=keys,
                data={"joint": joint.name},
            )


@transmission_on_immovable_joint.fix(UNSAFE)
def remove_transmission(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the transmission, if it drives only this joint."""
    transmission = problem.element
    if sum(1 for _ in transmission.list_children("joint")) != 1:
        return None
    return unsafe("remove the transmission", remove_element(transmission))


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
    """A moving joint has no transmission, in a robot with gazebo_ros_control.

    ``gazebo_ros_control`` only handles joints of transmissions: other joints move freely, and their
    state is not published. Joints of a loop that an SDF joint closes are not reported, neither are
    casters, suspensions and other passive joints, recognized by name.
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
    others.update(_find_loop_joints(robot))
    for joint in robot.moving_joints:
        if joint.mimic is not None or joint.name in driven | others or not joint.has_axis:
            continue
        if not is_locked(joint) and not any(map(_PASSIVE.search, (joint.name, joint.child))):
            yield Problem(
                joint,
                f"joint '{joint.name}' moves but has no <transmission>, so nothing drives it",
            )


@actuated_joint_without_transmission.fix(UNSAFE)
def add_transmission(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a transmission with the interface of the others, if they have the same."""
    joint = context.get_joint(problem)
    used = [
        text
        for transmission in context.robot.transmissions
        for part in transmission.joints
        for text in part.hardware_interfaces
    ]
    if len(set(used)) > 1:
        return None
    interface = used[0] if used else "hardware_interface/EffortJointInterface"
    name = escape_attribute(get_written_value(joint.element, "name"))
    lines = (
        f'<transmission name="{name}_transmission">',
        "\t<type>transmission_interface/SimpleTransmission</type>",
        f'\t<joint name="{name}">',
        f"\t\t<hardwareInterface>{escape_attribute(interface)}</hardwareInterface>",
        "\t</joint>",
        f'\t<actuator name="{name}_motor">',
        "\t\t<mechanicalReduction>1</mechanicalReduction>",
        "\t</actuator>",
        "</transmission>",
    )
    return unsafe(f"add a transmission with {interface}", insert_after(joint.element, *lines))


def _find_loop_joints(robot: Robot) -> Iterator[str]:
    """Yield the joints of loops that a ``<joint>`` in a ``<gazebo>`` block closes."""
    if any(one.kind == "joint" and one.name not in robot.joint for one in robot.rejected_settings):
        yield from robot.joint  # the joints of the loop are unknown
    for closure in robot.closures:
        sides = [
            {end, *robot.tree.list_ancestors(end)} if end in robot.link else set()
            for end in (closure.parent, closure.child)
        ]
        for name in sides[0] ^ sides[1]:
            above = robot.tree.get_parent_joint(name)
            if above is not None:
                yield above.name


@rule(
    INFO,
    on=("ros2",),
    effects={
        "ros2_control": "reads only what is in <ros2_control>",
    },
)
def ros1_transmission_in_ros2(robot: Robot, description: Description) -> Iterator[Problem]:
    """A robot for ROS 2 has transmissions of ROS 1.

    ros2_control reads transmissions inside ``<ros2_control>`` and ignores those in ``<robot>``. It
    is reported only if the robot has a ``<ros2_control>``, or its package depends on ros2_control:
    otherwise nothing reads transmissions. A robot with a ROS 1 Gazebo plugin that reads them is not
    reported, even if its package is for ROS 2.
    """
    if not robot.ros2_controls and not depends_on_control(description, OF_ROS2):
        return
    if robot.transmissions and not any(_is_transmission_reader(one) for one in robot.plugins):
        first = robot.transmissions[0]
        count = len(robot.transmissions)
        more = f" (and {count - 1} more)" if count > 1 else ""
        yield Problem(
            first.element,
            f"transmission '{first.name}'{more} is not read in ROS 2; "
            "write the interfaces in <ros2_control>",
            data={"transmissions": [one.name for one in robot.transmissions]},
        )


def _is_transmission_reader(plugin: Plugin) -> bool:
    """Tell whether a Gazebo plugin reads the transmissions of ROS 1."""
    name = plugin.filename.rpartition("/")[2].removeprefix("lib").removesuffix(".so")
    return name in ("gazebo_ros_control", "gazebo_ros_controller_manager")


_COMMANDS = {"Position": "position", "Velocity": "velocity", "Effort": "effort"}
_HARDWARE = {
    "gz": "gz_ros2_control/GazeboSimSystem",
    "gazebo-classic": "gazebo_ros2_control/GazeboSystem",
}
_NO_HARDWARE = "mock_components/GenericSystem"


@ros1_transmission_in_ros2.fix(UNSAFE)
def write_ros2_control(problem: Problem, context: FixContext) -> Proposal | None:
    """Replace the transmissions by a ``<ros2_control>`` with the same joints and interfaces.

    Its hardware is that of the simulator, or one that only mirrors commands; the driver of the real
    robot is unknown.
    """
    robot, targets = context.robot, context.targets
    if "ros1" in targets or set(_HARDWARE) <= targets:
        return None
    joints = list(_get_driven_joints(robot))
    if not all(commands or robot.joint[name].mimic is not None for name, commands in joints):
        return None  # transmissions for a reader other than ros_control
    if not joints:
        return None
    if robot.ros2_controls:
        there = {part.name for control in robot.ros2_controls for part in control.components}
        if not there.issuperset(name for name, _ in joints):
            return None
        return unsafe(
            "remove it: <ros2_control> has the joints",
            *(remove_element(t.element) for t in robot.transmissions),
        )
    if any(is_computed(t.element) or t.element.calls for t in robot.transmissions):
        return None
    plugin = next((v for name, v in _HARDWARE.items() if name in targets), _NO_HARDWARE)
    lines: Lines = (
        f'<ros2_control name="{escape_attribute(robot.name)}" type="system">',
        "\t<hardware>",
        f"\t\t<plugin>{plugin}</plugin>",
        "\t</hardware>",
    )
    for name, commands in joints:
        states = dict.fromkeys(("position", "velocity", *commands))
        lines += (
            f'\t<joint name="{escape_attribute(name)}">',
            *(f'\t\t<command_interface name="{command}"/>' for command in commands),
            *(f'\t\t<state_interface name="{state}"/>' for state in states),
            "\t</joint>",
        )
    head, *rest = (transmission.element for transmission in robot.transmissions)
    return unsafe(
        f"write <ros2_control> with {plugin} instead",
        replace_element(head, (*lines, "</ros2_control>")),
        *map(remove_element, rest),
    )


def _get_driven_joints(robot: Robot) -> Iterator[tuple[str, list[str]]]:
    """Get the joints of transmissions, each once, with their commands; none for mimic joints."""
    found: dict[str, list[str]] = {}
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            if joint.name in robot.joint:
                found.setdefault(joint.name, []).extend(_get_commands(transmission, joint.name))
    for name, commands in found.items():
        mimics = robot.joint[name].mimic is not None
        yield name, [] if mimics else list(dict.fromkeys(commands))


def _get_commands(transmission: Transmission, name: str) -> Iterator[str]:
    written = [joint.hardware_interfaces for joint in transmission.joints if joint.name == name]
    written += [actuator.hardware_interfaces for actuator in transmission.actuators]
    for interface in (one for interfaces in written for one in interfaces):
        word = interface.rpartition("/")[2].removesuffix("JointInterface")
        if word in _COMMANDS:
            yield _COMMANDS[word]
