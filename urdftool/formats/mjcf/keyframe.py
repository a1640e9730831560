"""The initial values of ros2_control as a keyframe named home."""

from __future__ import annotations

from lxml import etree

from ...model.elements import Robot
from ...model.pose import quaternion_of_rotation
from ...model.read import number
from ..numbers import numbers_text
from .actuator import Drive
from .equality import follows
from .joint import PLANAR_SUFFIXES
from .structure import Structure


def keyframe_section(structure: Structure, drives: list[Drive]) -> etree._Element | None:
    """``<keyframe>``, or None where no initial position other than zero is written."""
    start = initial_positions(structure.robot)
    if not any(start.values()):
        return None
    for joint in structure.moving:
        if follows(structure, joint) and joint.mimic is not None:
            leader = start.get(joint.mimic.joint, 0.0)
            start[joint.name] = joint.mimic.multiplier * leader + joint.mimic.offset
    section = etree.Element("keyframe")
    key = etree.SubElement(
        section, "key", name="home", qpos=numbers_text(_positions(structure, start))
    )
    if drives:
        controls = [
            start.get(drive.joint.name, 0.0) if drive.kind == "position" else 0.0
            for drive in drives
        ]
        key.set("ctrl", numbers_text(controls))
    return section


def initial_positions(robot: Robot) -> dict[str, float]:
    """The initial position [rad or m] of each joint for which ros2_control gives one."""
    found = {}
    for block in robot.ros2_controls:
        for component in block.joints:
            for interface in component.state_interfaces:
                value = number(interface.params.get("initial_value"))
                if interface.name == "position" and value is not None:
                    found[component.name] = value
            value = number(component.params.get("initial_position"))
            if value is not None:
                found.setdefault(component.name, value)
    return found


def _positions(structure: Structure, start: dict[str, float]) -> list[float]:
    """``qpos`` in MuJoCo's order: free bodies below others come after the root's tree."""
    first: list[float] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0] if structure.free else []
    later: list[float] = []
    torn: set[str] = set()
    for joint in structure.moving:
        kind = structure.kind(joint)
        if kind == "free":
            pose = structure.pose_at_zero(joint.child)
            values = [*pose.translation, *quaternion_of_rotation(pose.rotation)]
        elif kind == "ball":
            values = [1.0, 0.0, 0.0, 0.0]
        elif kind == "planar":
            values = [0.0] * len(PLANAR_SUFFIXES)
        else:
            values = [start.get(joint.name, 0.0)]
        nested = joint.parent in torn
        if (kind == "free" and not structure.in_world) or nested:
            torn.update((joint.child, *structure.robot.tree.descendants(joint.child)))
            later += values
        else:
            first += values
    return first + later
