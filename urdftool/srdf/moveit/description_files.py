"""Robot description of a MoveIt configuration: the robot, and mock hardware for its joints."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Joint
from ...source.edit import Edit, insert_child, parse_source
from ...source.escape import escape_attribute
from ...source.location import SourceFile
from .configuration import Configuration

_XACRO = "http://www.ros.org/wiki/xacro"
_MOCK = "mock_components/GenericSystem"


def list_mock_joints(configuration: Configuration) -> list[Joint]:
    """List the joints for mock hardware: all actuated ones without ros2_control.

    There are none if ros2_control of the description has all joints of the groups.
    """
    controlled = {
        joint.name for block in configuration.robot.ros2_controls for joint in block.joints
    }
    lacking = [one for one in configuration.active_joints if one.name not in controlled]
    grouped = _get_grouped(configuration)
    return lacking if any(joint.name in grouped for joint in lacking) else []


def _get_grouped(configuration: Configuration) -> set[str]:
    return {
        joint.name
        for group in configuration.groups.values()
        for joint in configuration.list_group_joints(group)
    }


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
    if list_mock_joints(configuration):
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
    grouped = _get_grouped(configuration)
    joints = [
        line
        for joint in list_mock_joints(configuration)
        for line in _format_joint(joint.name, is_commanded=joint.name in grouped)
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
        *("      " + line.replace("\t", "  ") for line in joints),
        "    </ros2_control>",
        "  </xacro:macro>",
        "</robot>",
    ]
    return "\n".join([*lines, ""])


def _format_joint(name: str, *, is_commanded: bool) -> list[str]:
    """Format a joint of mock hardware, with a tab for each level."""
    key = name.replace("\\", "\\\\").replace("'", "\\'")
    key = escape_attribute(key.replace("{", "\\x7b").replace("}", "\\x7d"))
    return [
        f'<joint name="{_escape(name)}">',
        *(['\t<command_interface name="position"/>'] if is_commanded else []),
        '\t<state_interface name="position">',
        f"\t\t<param name=\"initial_value\">${{initial_positions['{key}']}}</param>",
        "\t</state_interface>",
        '\t<state_interface name="velocity"/>',
        "</joint>",
    ]


def complete_mock_hardware(
    configuration: Configuration, file: SourceFile
) -> Iterator[tuple[str, Edit]]:
    """Yield the edits that add joints to an existing file of mock hardware, each with its joint.

    Raises:
        SourceError: The file cannot be parsed.
    """
    source = parse_source(file)
    blocks = [one for one in source.document.root.walk() if one.tag == "ros2_control"]
    if not blocks:
        return
    present = {one.get("name") for block in blocks for one in block.list_children("joint")}
    grouped = _get_grouped(configuration)
    for joint in list_mock_joints(configuration):
        if joint.name in present:
            continue
        lines = _format_joint(joint.name, is_commanded=joint.name in grouped)
        ascii_lines = [one.encode("ascii", "xmlcharrefreplace").decode() for one in lines]
        last = blocks[0].children[-1] if blocks[0].children else None
        yield f"joint '{joint.name}'", insert_child(source, blocks[0], ascii_lines, after=last)
