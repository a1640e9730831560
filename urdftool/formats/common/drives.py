"""Joints that the description drives: by transmissions, ros2_control, or Gazebo plugins."""

from __future__ import annotations

import re

from ...model.elements import Plugin, Robot
from ...model.kinematics import MOVABLE, get_limits

PLUGINS = (
    "diff_drive",
    "skid_steer",
    "ackermann",
    "tricycle",
    "planar_move",
    "mecanum",
    "hoverboard",
)
"""Words in the names of Gazebo plugins that drive a robot over the ground."""


INTERFACES = ("position", "velocity", "effort")


def drive_plugins(robot: Robot) -> list[Plugin]:
    """Return the plugins that drive a robot over the ground."""
    found = []
    for plugin in robot.plugins:
        words = f"{plugin.filename} {plugin.name}".lower().replace("-", "_")
        if any(word in words or word.replace("_", "") in words for word in PLUGINS):
            found.append(plugin)
    return found


def get_plugin_drives(robot: Robot) -> dict[str, str]:
    """Return how drive plugins actuate the joints that they name.

    Returns:
        By joint name: ``velocity`` for a wheel, ``position`` for a joint with limits, which steers.
    """
    found = {}
    for plugin in drive_plugins(robot):
        for element in plugin.element.walk():
            for name in re.split(r"[,\s]+", element.text.strip()):
                joint = robot.joint.get(name)
                if joint is not None and joint.type in MOVABLE:
                    lower, upper = get_limits(joint)
                    turns = joint.type == "continuous" or not -7.0 < lower < upper < 7.0
                    found[name] = "velocity" if turns else "position"
    return found


def get_commanded_joints(robot: Robot) -> set[str]:
    """Return the names of joints that a transmission, ros2_control or a drive plugin actuates."""
    names = {joint.name for part in robot.transmissions for joint in part.joints}
    for block in robot.ros2_controls:
        names |= {joint.name for joint in block.joints if joint.command_interfaces}
    return (names & set(robot.joint)) | set(get_plugin_drives(robot))


def get_actuator_kind(interfaces: list[str]) -> str:
    """Return the actuator kind for hardware interfaces; the first known interface counts."""
    for name in interfaces:
        for interface in INTERFACES:
            if interface in name.lower().rpartition("/")[2]:
                return "motor" if interface == "effort" else interface
    return "motor"


def list_servo_joints(robot: Robot) -> list[str]:
    """Return the joints with a position or velocity interface, which need gains, in file order."""
    kinds = get_plugin_drives(robot)
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            names = [*joint.hardware_interfaces]
            names += [name for part in transmission.actuators for name in part.hardware_interfaces]
            kinds[joint.name] = get_actuator_kind(names)
    for block in robot.ros2_controls:
        for component in block.joints:
            names = [interface.name for interface in component.command_interfaces]
            if names:
                kinds[component.name] = get_actuator_kind(names)
    return [joint.name for joint in robot.joints if kinds.get(joint.name, "motor") != "motor"]
