"""Fixes of Gazebo's plugins."""

from __future__ import annotations

import re

from ...model.read import number
from ...source.document import Element
from ..gazebo.systems import REPLACEMENTS, SYSTEMS
from ..rule import Problem
from .proposal import (
    Around,
    Proposal,
    element_at,
    meant,
    put,
    quote,
    replace,
    safe,
    say,
    sub,
    unsafe,
)

_DRIVE = {
    "leftJoint": "left_joint",
    "left_joint": "left_joint",
    "rightJoint": "right_joint",
    "right_joint": "right_joint",
    "leftFrontJoint": "left_joint",
    "leftRearJoint": "left_joint",
    "rightFrontJoint": "right_joint",
    "rightRearJoint": "right_joint",
    "wheelSeparation": "wheel_separation",
    "wheel_separation": "wheel_separation",
    "commandTopic": "topic",
    "command_topic": "topic",
    "odometryTopic": "odom_topic",
    "odometry_topic": "odom_topic",
    "odometryFrame": "frame_id",
    "odometry_frame": "frame_id",
    "robotBaseFrame": "child_frame_id",
    "robot_base_frame": "child_frame_id",
    "odometryRate": "odom_publish_frequency",
    "updateRate": "odom_publish_frequency",
    "update_rate": "odom_publish_frequency",
}
"""Parameters of the drives of gazebo_ros, and what they are called in gz sim."""

_DRIVES = ("gazebo_ros_diff_drive", "gazebo_ros_skid_steer_drive")
_STATES = ("gazebo_ros_joint_state_publisher",)


def classic_plugin_in_gz(problem: Problem, around: Around) -> Proposal | None:
    """Its successor, with the parameters that have one."""
    plugin = problem.element
    library = (plugin.get("filename") or "").rpartition("/")[2]
    old = library.removesuffix(".so").removeprefix("lib")
    new = REPLACEMENTS.get(old)
    if old == "gazebo_ros2_control":
        return unsafe(
            f"load '{new}'",
            put(plugin, "filename", new or ""),
            put(plugin, "name", SYSTEMS["gz_ros2_control-system"]),
        )
    if new is None or any("$" in line for line in _values(plugin)):
        return None
    if old in _DRIVES:
        inside = list(_drive(plugin))
        if not any("left_joint" in line for line in inside):
            return None
    elif old in _STATES:
        texts = [c.text for c in plugin.children if c.tag in ("jointName", "joint_name")]
        names = [name for text in texts for name in re.split(r"[,\s]+", text) if name]
        inside = [f"<joint_name>{quote(name)}</joint_name>" for name in names]
    else:
        return None
    lines = (
        f'<plugin filename="{new}" name="{SYSTEMS[new]}">',
        *(f"\t{line}" for line in inside),
        "</plugin>",
    )
    if not inside:
        lines = (f'<plugin filename="{new}" name="{SYSTEMS[new]}"/>',)
    return unsafe(f"load '{new}'", replace(plugin, lines))


def _values(plugin: Element) -> list[str]:
    return [child.text for child in plugin.walk()]


def _drive(plugin: Element) -> list[str]:
    """The parameters of a drive as gz sim reads them; a wheel's radius is half of its diameter."""
    said: dict[str, list[str]] = {}
    for child in plugin.children:
        text = " ".join(child.text.split())
        tag = _DRIVE.get(child.tag)
        if child.tag in ("wheelDiameter", "wheel_diameter"):
            diameter = number(text)
            if diameter is not None:
                said["wheel_radius"] = [f"{diameter / 2:.9g}"]
        elif tag is not None and text:
            if not tag.endswith("_joint"):
                said.setdefault(tag, [text])
            else:
                said.setdefault(tag, []).append(text)
    return [f"<{tag}>{quote(text)}</{tag}>" for tag, texts in said.items() for text in texts]


def ignition_name(problem: Problem, around: Around) -> Proposal | None:
    """By its new name."""
    plugin = problem.element
    new = problem.message.partition("; write '")[2].partition("'")[0]
    if not new:
        return None
    changes = [put(plugin, "filename", new)]
    name = plugin.get("name") or ""
    if "ignition::gazebo::" in name:
        changes.append(sub(plugin, "name", "^ignition::gazebo::", "gz::sim::"))
    elif name.startswith("ign_ros2_control::"):
        changes.append(put(plugin, "name", SYSTEMS["gz_ros2_control-system"]))
    return safe(f"write {new}", *changes)


def plugin_class_mismatch(problem: Problem, around: Around) -> Proposal | None:
    """The class in the library."""
    right = problem.message.partition("' is '")[2].partition("'")[0]
    if not right:
        return None
    return safe(f"write {right}", put(problem.element, "name", right))


def plugin_unknown_entity(problem: Problem, around: Around) -> Proposal | None:
    """The link or joint that was meant."""
    element = element_at(problem)
    name = meant(problem, element.text.strip()) if element is not None else ""
    if element is None or not name or re.search(r"[,\s]", element.text.strip()):
        return None
    return unsafe(f"write {name}", say(element, name))
