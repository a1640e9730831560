"""Robot description of a MoveIt configuration: the robot, and mock hardware for its joints."""

from __future__ import annotations

from ...model.elements import Joint
from ...source.escape import escape_attribute
from .configuration import Configuration

_XACRO = "http://www.ros.org/wiki/xacro"
_MOCK = "mock_components/GenericSystem"


def list_uncontrolled_joints(configuration: Configuration) -> list[Joint]:
    """List the actuated joints of the groups that the description has no ros2_control for."""
    controlled = {
        joint.name for block in configuration.robot.ros2_controls for joint in block.joints
    }
    grouped = {
        joint.name
        for group in configuration.groups.values()
        for joint in configuration.list_group_joints(group)
    }
    return [
        joint
        for joint in configuration.active_joints
        if joint.name in grouped and joint.name not in controlled
    ]


def make_description(configuration: Configuration) -> str:
    """Make the robot description: the given one, with mock hardware for joints without hardware."""
    arguments = [
        f'  <xacro:arg name="{escape_attribute(name)}" default="{_escape(value)}"/>'
        for name, value in configuration.description.arguments.items()
    ]
    location = escape_attribute(configuration.description.location)
    lines = [
        '<?xml version="1.0"?>',
        f'<robot xmlns:xacro="{_XACRO}" name="{_escape(configuration.robot.name)}">',
        *arguments,
        f'  <xacro:include filename="{location}"/>',
    ]
    if list_uncontrolled_joints(configuration):
        stem = configuration.stem
        lines += [
            '  <xacro:arg name="initial_positions_file" default="initial_positions.yaml"/>',
            f'  <xacro:include filename="{stem}.ros2_control.xacro"/>',
            f'  <xacro:{stem}_ros2_control name="MockSystem" '
            'initial_positions_file="$(arg initial_positions_file)"/>',
        ]
    return "\n".join([*lines, "</robot>", ""])


def _escape(text: str) -> str:
    """Escape text for an attribute that xacro evaluates."""
    return escape_attribute(text.replace("$", "$$")) if "$" in text else escape_attribute(text)


def make_mock_hardware(configuration: Configuration) -> str:
    """Make the xacro macro with mock hardware for the joints without ros2_control."""
    joints = [
        line
        for joint in list_uncontrolled_joints(configuration)
        for line in _make_joint(joint.name)
    ]
    lines = [
        '<?xml version="1.0"?>',
        f'<robot xmlns:xacro="{_XACRO}">',
        "  <!-- Mock hardware, which follows each command. Replace its plugin for a real",
        "       robot. -->",
        f'  <xacro:macro name="{configuration.stem}_ros2_control" '
        'params="name initial_positions_file">',
        '    <xacro:property name="initial_positions" '
        "value=\"${load_yaml(initial_positions_file)['initial_positions']}\"/>",
        '    <ros2_control name="${name}" type="system">',
        "      <hardware>",
        f"        <plugin>{_MOCK}</plugin>",
        "      </hardware>",
        *(f"      {line}" for line in joints),
        "    </ros2_control>",
        "  </xacro:macro>",
        "</robot>",
    ]
    return "\n".join([*lines, ""])


def _make_joint(name: str) -> list[str]:
    key = escape_attribute(name.replace("\\", "\\\\").replace("'", "\\'"))
    return [
        f'<joint name="{_escape(name)}">',
        '  <command_interface name="position"/>',
        '  <state_interface name="position">',
        f"    <param name=\"initial_value\">${{initial_positions['{key}']}}</param>",
        "  </state_interface>",
        '  <state_interface name="velocity"/>',
        "</joint>",
    ]
