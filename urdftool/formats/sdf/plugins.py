"""Conversion of ``<plugin>``: plugins of Gazebo Classic become gz systems where one exists."""

from __future__ import annotations

from ...model.elements import ZERO
from ...model.gazebo_plugins import (
    CONTROL_PLUGINS,
    MIMIC_PLUGINS,
    SENSOR_PLUGINS,
    SYSTEM_PLUGINS,
    System,
    convert_parameters,
    get_library,
    is_for_classic,
    is_for_gz,
)
from ...model.numbers import format_numbers_text
from ...model.pose import Pose, rotation_from_rpy, rpy_from_rotation
from ...model.read import parse_numbers
from ...source.document import Element
from .translation import Translation
from .xml import Node, add, append_comment, append_copy, format_one_line, get_or_create

_NAMES_LINK = frozenset(
    ("bodyName", "body_name", "linkName", "link_name", "gripper_link", "palm_link", "parent_link",
     "child_link", "link")
)  # fmt: skip


def add_plugin(node: Node, t: Translation, element: Element) -> None:
    """Add a plugin of a model, link, joint or sensor."""
    name = get_library(element)
    if not name:
        append_comment(node, format_one_line(element))
        _report_plugin(t, element, "has no library; it is kept as a comment")
    elif t.options.classic:
        _copy_kept(node, t, element)
        if is_for_gz(element):
            _report_plugin(
                t,
                element,
                "is a gz plugin, which Gazebo Classic cannot load; it is copied unchanged",
            )
    elif name in CONTROL_PLUGINS:
        _convert_control(node, t, element)
    elif name in MIMIC_PLUGINS:
        _convert_mimic(node, t, element)
    elif name in SYSTEM_PLUGINS:
        for system in SYSTEM_PLUGINS[name]:
            _add_system(node, t, element, system)
    else:
        _copy_kept(node, t, element)
        if name in SENSOR_PLUGINS:
            where = (
                "but is not in one, and names no link or joint of the SDF model; it is copied "
                "unchanged"
            )
            _report_plugin(t, element, f"belongs to a sensor, {where}")
        elif is_for_classic(element):
            _report_plugin(
                t,
                element,
                "is a Gazebo Classic plugin without a successor in gz; it is copied unchanged",
            )


def get_system_name(t: Translation, word: str, name: str) -> dict[str, str]:
    """Return file and class of a system, as named in the release of the exported version."""
    if t.options.is_at_least("1.10"):
        return {"filename": f"gz-sim-{word}-system", "name": f"gz::sim::systems::{name}"}
    return {
        "filename": f"ignition-gazebo-{word}-system",
        "name": f"ignition::gazebo::systems::{name}",
    }


def _copy_kept(node: Node, t: Translation, element: Element) -> None:
    """Copy a plugin, with the exported names of the links and joints in its parameters."""
    made = append_copy(node, element)
    if not made.get("name"):
        made.set("name", get_library(element))
    _offset(made, t)
    for tag in made.iter():
        if not isinstance(tag.tag, str) or not tag.text:
            continue
        text = tag.text.strip()
        if tag.tag in _NAMES_LINK and text in t.plan.owner:
            dissolved = t.options.classic and not t.plan.stays(text)
            tag.text = t.names.link(t.plan.owner[text] if dissolved else text)
        elif "oint" in tag.tag and ("joint", text) in t.names.renamed:
            tag.text = t.names.get_joint(text)


def _offset(made: Node, t: Translation) -> None:
    """Convert the offsets of a plugin to the owner of its link."""
    body = made.find("bodyName")
    name = (body.text or "").strip() if body is not None else ""
    if not t.options.classic or name not in t.plan.owner or t.plan.stays(name):
        return
    xyz, rpy = (parse_numbers(made.findtext(f"{w}Offset"), 3) or ZERO for w in ("xyz", "rpy"))
    local = Pose(rotation_from_rpy(rpy), xyz)  # type: ignore[arg-type]
    pose = t.plan.in_owner[name] @ local
    get_or_create(made, "xyzOffset").text = format_numbers_text(pose.translation)
    get_or_create(made, "rpyOffset").text = format_numbers_text(rpy_from_rotation(pose.rotation))


def _add_system(node: Node, t: Translation, element: Element, system: System) -> None:
    made = add(node, "plugin", **get_system_name(t, system.word, system.name))
    converted, left = convert_parameters(element, system)
    for tag, value in converted:
        if isinstance(value, str):
            add(made, tag, t.names.get_joint(value) if "joint" in tag else value)
        else:
            append_copy(made, value, tag)
    text = f"plugin '{get_library(element)}' is '{made.get('filename')}' in gz"
    if left:
        text += f"; it has no {', '.join(left)}"
    if system.missing:
        text += f"; fill in {', '.join(system.missing)}"
    (t.report_loss if left or system.missing else t.report_note)("plugin", text, element)


def _convert_control(node: Node, t: Translation, element: Element) -> None:
    """Convert the plugin of ros_control or gazebo_ros2_control."""
    names = {
        "filename": "gz_ros2_control-system",
        "name": "gz_ros2_control::GazeboSimROS2ControlPlugin",
    }
    if not t.options.is_at_least("1.10"):
        names = {
            "filename": "ign_ros2_control-system",
            "name": "ign_ros2_control::IgnitionROS2ControlPlugin",
        }
    made = add(node, "plugin", **names)
    for child in element.children:
        if child.tag == "robotNamespace":
            if child.text.strip():
                add(add(made, "ros"), "namespace", child.text.strip())
        elif child.tag in ("parameters", "ros", "controller_manager_name", "robot_param",
                           "robot_param_node", "hold_joints"):  # fmt: skip
            append_copy(made, child)
    has_control = bool(t.robot.ros2_controls)
    needs = (
        ""
        if has_control
        else "; it requires a <ros2_control> block in robot_description, which is missing"
    )
    text = f"plugin '{get_library(element)}' is '{names['filename']}' in gz{needs}"
    (t.report_note if has_control else t.report_loss)("plugin", text, element)


def _convert_mimic(node: Node, t: Translation, element: Element) -> None:
    """Convert a mimic joint plugin, which is not needed if SDF has the ``<mimic>``."""
    follower = element.find_child("mimicJoint")
    name = follower.text.strip() if follower is not None else ""
    joint = t.robot.joint.get(name)
    if joint is not None and joint.mimic is not None and t.options.is_at_least("1.11"):
        t.report_note(
            "plugin",
            f"plugin '{get_library(element)}' is <mimic> of joint '{name}' in SDF",
            element,
        )
        return
    _copy_kept(node, t, element)
    _report_plugin(
        t,
        element,
        f"has no successor in gz, and joint '{name}' has no <mimic>; it is copied unchanged",
    )


def _report_plugin(t: Translation, element: Element, what: str) -> None:
    t.report_loss(
        "plugin", f"plugin '{get_library(element) or element.get('name')}' {what}", element
    )
