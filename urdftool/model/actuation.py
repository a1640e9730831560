"""Joints that a description declares as actuated."""

from __future__ import annotations

from .elements import Joint, Robot


def find_actuated_joints(robot: Robot) -> set[str]:
    """Return the joints that a transmission, ros2_control or a Gazebo plugin actuates.

    Joints of ros2_control without a command interface are excluded, and joints that only a joint
    state publisher names.
    """
    named = {joint.name for part in robot.transmissions for joint in part.joints}
    for control in robot.ros2_controls:
        named |= {joint.name for joint in control.joints if joint.command_interfaces}
    for plugin in robot.plugins:
        if "state_publisher" in plugin.filename or "state_publisher" in plugin.name:
            continue
        named |= {element.text.strip() for element in plugin.element.walk()}
    return named & set(robot.joint)


def is_passive(joint: Joint, actuated: set[str]) -> bool:
    """Tell whether a joint is unactuated while other joints of the robot are actuated."""
    return bool(actuated) and joint.name not in actuated


def find_measured_joints(robot: Robot) -> set[str]:
    """Return the joints that ros2_control lists and nothing actuates."""
    named = {joint.name for control in robot.ros2_controls for joint in control.joints}
    return (named & set(robot.joint)) - find_actuated_joints(robot)
