"""Fixes that bring a robot to another generation of its readers, or to another reader."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot, Transmission
from ..cross_file_references import check_not_included
from ..rule import Problem
from .proposal import Around, Change, Lines, Proposal, is_computed, quote, remove, replace, unsafe

_COMMANDS = {"Position": "position", "Velocity": "velocity", "Effort": "effort"}
_HARDWARE = {
    "gz": "gz_ros2_control/GazeboSimSystem",
    "gazebo-classic": "gazebo_ros2_control/GazeboSystem",
}
_NO_HARDWARE = "mock_components/GenericSystem"


def ros1_transmission_in_ros2(problem: Problem, around: Around) -> Proposal | None:
    """A ``<ros2_control>`` with the same joints and interfaces, in their place.

    Its hardware is that of the simulator, or the one that only repeats commands: which drives the
    real robot only its maker knows.
    """
    robot, targets = around.robot, around.targets
    if "ros1" in targets or set(_HARDWARE) <= targets:
        return None
    joints = list(_driven(robot))
    if not all(commands or robot.joint[name].mimic is not None for name, commands in joints):
        return None  # transmissions that another reader than ros_control has
    if not joints:
        return None
    if robot.ros2_controls:
        there = {part.name for control in robot.ros2_controls for part in control.components}
        if not there.issuperset(name for name, _ in joints):
            return None
        return unsafe(
            "leave it to <ros2_control>", *(remove(t.element) for t in robot.transmissions)
        )
    if any(is_computed(t.element) or t.element.calls for t in robot.transmissions):
        return None
    plugin = next((v for name, v in _HARDWARE.items() if name in targets), _NO_HARDWARE)
    lines: Lines = (
        f'<ros2_control name="{quote(robot.name)}" type="system">',
        "\t<hardware>",
        f"\t\t<plugin>{plugin}</plugin>",
        "\t</hardware>",
    )
    for name, commands in joints:
        states = dict.fromkeys(("position", "velocity", *commands))
        lines += (
            f'\t<joint name="{quote(name)}">',
            *(f'\t\t<command_interface name="{command}"/>' for command in commands),
            *(f'\t\t<state_interface name="{state}"/>' for state in states),
            "\t</joint>",
        )
    head, *rest = (transmission.element for transmission in robot.transmissions)
    return unsafe(
        f"write <ros2_control> with {plugin} instead",
        replace(head, (*lines, "</ros2_control>")),
        *map(remove, rest),
    )


def _driven(robot: Robot) -> Iterator[tuple[str, list[str]]]:
    """The joints of the transmissions that are there, each once, with their commands, if any."""
    found: dict[str, list[str]] = {}
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            if joint.name in robot.joint:
                found.setdefault(joint.name, []).extend(_commands(transmission, joint.name))
    for name, commands in found.items():
        mimics = robot.joint[name].mimic is not None
        yield name, [] if mimics else list(dict.fromkeys(commands))


def _commands(transmission: Transmission, name: str) -> Iterator[str]:
    said = [joint.hardware_interfaces for joint in transmission.joints if joint.name == name]
    said += [actuator.hardware_interfaces for actuator in transmission.actuators]
    for interface in (one for interfaces in said for one in interfaces):
        word = interface.rpartition("/")[2].removesuffix("JointInterface")
        if word in _COMMANDS:
            yield _COMMANDS[word]


def mujoco_welds_root(problem: Problem, around: Around) -> Proposal | None:
    """A link ``world`` and a floating joint, which Gazebo does not take."""
    robot, root = around.robot, around.link(problem)
    if around.targets != {"mujoco"} or is_computed(root.element):
        return None
    if "world" in robot.link or "world_joint" in robot.joint:
        return None
    check_not_included(around)
    blocks: tuple[Lines, ...] = (
        ('<link name="world"/>',),
        (
            '<joint name="world_joint" type="floating">',
            '\t<parent link="world"/>',
            f'\t<child link="{quote(root.name)}"/>',
            "</joint>",
        ),
    )
    return unsafe(
        "put a link 'world' and a floating joint above it",
        Change("first", robot.element, blocks=blocks),
    )
