"""Conversion of the robot to ``<model>``: links, joints, frames and model-wide settings."""

from __future__ import annotations

from collections.abc import Sequence

from ...model.block_elements import list_model_elements
from ...model.elements import Ros2Control, Transmission
from ...model.settings import OF_ROBOT
from ...model.world import find_model_origin
from ...source.document import Element
from ..common.naming import get_first_free, list_numbered_names
from .body_sensors import add_body_sensors, is_body_sensor
from .copied_elements import copy_raw_element, is_frame, move_to_owner
from .extensions import write_settings
from .frames import add_frames, add_own_frames
from .joints import add_joint
from .links import link
from .names import get_model_name
from .native import add_native
from .plan import WORLD, get_links
from .plugins import add_plugin
from .pose import set_origin
from .translation import Translation
from .xml import Node, add, append_comment


def add_model(parent: Node, t: Translation) -> Node:
    """Add the model of the robot."""
    node = add(parent, "model", name=get_model_name(t.robot))
    _set_whole(node, t)
    _report_world(t)
    for part in get_links(t.plan, t.robot):
        link(node, t, part)
    _name_canonical(node, t)
    for each in t.robot.joints:
        if each.child in t.plan.owner:
            add_joint(node, t, each)
    if t.options.is_at_least("1.7"):
        add_frames(node, t)
    else:
        _report_frames(t)
    add_own_frames(node, t)
    _add_parts(node, t)
    _keep_control(node, t)
    return node


def _name_canonical(node: Node, t: Translation) -> None:
    """Name the canonical link, unless it is the first, which is SDF's default."""
    if t.plan.anchored or not t.options.is_at_least("1.7"):
        return
    root = next(iter(t.plan.in_model), None)
    first = node.find("link")
    if root is not None and first is not None:
        name = t.names.link(t.plan.owner[root])
        if first.get("name") != name:
            node.set("canonical_link", name)


def _set_whole(node: Node, t: Translation) -> None:
    """Set whether the model is static, and its pose."""
    in_blocks = t.robot.format == "urdf"  # whose other elements are copied
    rows = [row for row in OF_ROBOT if row.name == "static" or not in_blocks]
    write_settings(node, t.robot.settings, rows)
    origin = find_model_origin(t.robot)
    if origin is not None:
        set_origin(node, origin, exact=t.options.is_at_least("1.9"))


def _add_parts(node: Node, t: Translation) -> None:
    """Add plugins, and SDF elements that are copied unchanged."""
    for element in list_model_elements(t.robot):
        if element.tag == "plugin":
            if not is_body_sensor(t, element):
                add_plugin(node, t, element)
        elif element.tag == "joint":
            _add_closing_joint(node, t, element)
        elif element.tag not in ("pose", "static", "canonicalBody"):
            copy_raw_element(node, t, element)
    add_body_sensors(node, t)
    add_native(node, t)


def _add_closing_joint(node: Node, t: Translation, element: Element) -> None:
    """Add a loop-closing SDF joint of a block, with the exported names of its links."""
    if why := _explain_why_not(t, _collect_ends(element)):
        inside = {id(one) for one in element.walk()}
        if any(id(one.provenance) in inside for one in t.robot.rejected_settings):
            return  # a remark of the model says why
        text = f"<joint> '{element.get('name')}' of a <gazebo> block is not exported: {why}"
        t.report_loss("reference", text, element)
        return
    made = copy_raw_element(node, t, element)
    if made is None:
        return
    name = made.get("name") or "joint"
    taken = {other.get("name") for other in node if other is not made}
    if name in taken:
        new = get_first_free(list_numbered_names(name), taken)
        made.set("name", new)
        t.report_loss(
            "name",
            f"<joint> '{name}' of a <gazebo> block is '{new}' in SDF, since the name is taken",
            element,
        )
    child = (made.findtext("child") or "").strip()
    if child in t.robot.link:  # whose frame that of the joint is relative to
        move_to_owner(made, t, t.robot.link[child])
    for end in ("parent", "child"):
        for tag in made.findall(end):
            name = (tag.text or "").strip()
            if name in t.plan.owner:
                tag.text = t.names.link(t.plan.owner[name])


def _explain_why_not(t: Translation, ends: Sequence[tuple[str, str]]) -> str:
    """Explain why a joint with these ends cannot be exported; return "" if it can."""
    for end, name in ends:
        if not _can_join(t, end, name):
            return f"its {end} '{name}' is not a link"
    if len(ends) != 2:
        return "both of its links are the world"
    one, other = (t.plan.owner.get(name, name) for _, name in ends)
    return f"it connects '{one}' to itself" if one == other else ""


def _collect_ends(element: Element) -> list[tuple[str, str]]:
    ends = (element.find_child(end) for end in ("parent", "child"))
    return [(end.tag, end.text.strip()) for end in ends if end is not None]


def _can_join(t: Translation, end: str, name: str) -> bool:
    return is_frame(t, name) and name != "" if name != WORLD else end == "parent"


def _report_world(t: Translation) -> None:
    if not t.plan.anchored:
        return
    world = t.robot.link[WORLD]
    has = [
        what
        for what, there in (
            ("mass", world.inertial),
            ("visuals", world.visuals),
            ("collisions", world.collisions),
        )
        if there
    ]
    if has:
        text = f"the root link is the world; not exported: its {' and '.join(has)}"
        t.report_loss("world", text, world, world)


def _report_frames(t: Translation) -> None:
    for name in t.plan.in_model:
        if not t.plan.stays(name):
            link_ = t.robot.link[name]
            text = (
                f"link '{name}' was merged into '{t.plan.owner[name]}', and SDF 1.6 has no frames"
            )
            t.report_note("frame", f"{text}; its name is lost", link_, link_)


_HARDWARE = {
    "gz": ("gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem"),
    "gazebo-classic": ("gazebo_ros2_control/GazeboSystem",),
}
"""Hardware plugins that work in each target."""


def _keep_control(model: Node, t: Translation) -> None:
    """Keep transmissions and ros2_control as comments, and report them."""
    if t.options.classic:
        use = "ros_control reads it from robot_description"
    elif t.robot.ros2_controls:
        use = "gz drives its joints by the <ros2_control> block of robot_description"
    else:
        use = "gz requires a <ros2_control> block in robot_description instead"
    for transmission in t.robot.transmissions:
        append_comment(model, _format_comment(transmission))
        joints = ", ".join(f"'{joint.name}'" for joint in transmission.joints) or "no joint"
        t.report_loss(
            "transmission",
            f"transmission '{transmission.name}' of {joints} has no counterpart; it stays as a "
            f"comment, and {use}",
            transmission,
        )
    for system in t.robot.ros2_controls:
        _add_ros2_control(model, t, system)


def _format_comment(transmission: Transmission) -> str:
    parts = [f"transmission {transmission.name}: {transmission.type}"]
    parts += [
        f"joint {joint.name} {' '.join(joint.hardware_interfaces)}".rstrip()
        for joint in transmission.joints
    ]
    for actuator in transmission.actuators:
        reduction = actuator.mechanical_reduction
        text = "" if reduction is None else f" mechanicalReduction {reduction:g}"
        parts.append(f"actuator {actuator.name}{text}")
    return "; ".join(parts)


def _add_ros2_control(model: Node, t: Translation, system: Ros2Control) -> None:
    joints = ", ".join(joint.name for joint in system.joints)
    append_comment(
        model, f"ros2_control {system.name}: {system.plugin or 'no plugin'}; joints {joints}"
    )
    right = _HARDWARE[t.options.target]
    at = system.element.find_child("hardware") or system.element
    if system.plugin and system.plugin not in right and "azebo" in system.plugin:
        t.report_loss(
            "ros2-control",
            (
                f"hardware '{system.plugin}' of <ros2_control> '{system.name}' is for another "
                "version "
                "of Gazebo"
            ),
            at,
            hint=f"for {t.options.target} it is {right[0]}",
        )
    plugins = {plugin.filename for plugin in t.robot.plugins}
    if not any("ros2_control" in name or "ros_control" in name for name in plugins):
        t.report_loss(
            "ros2-control",
            f"<ros2_control> '{system.name}' is read from robot_description by a plugin of Gazebo, "
            "and the robot has none",
            system,
            hint="add the plugin gz_ros2_control-system in a <gazebo> block",
        )
    else:
        text = (
            f"<ros2_control> '{system.name}' is read from robot_description by its plugin, not "
            "from SDF"
        )
        t.report_note("ros2-control", text, system)
