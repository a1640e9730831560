"""Conversion of ``<sensor>``: types of the target, poses in the owner, plugins."""

from __future__ import annotations

from copy import deepcopy

from ...diagnostic import Severity
from ...model.block_elements import LUMPED, list_part_elements
from ...model.elements import Joint, Link
from ...rules.gazebo.sensors import TYPES
from ...source.document import Element
from ..common.naming import get_free_name
from .copied_elements import copy_raw_element, move_to_owner, rename_frames
from .imu import write_imu_noise
from .plugins import add_plugin
from .sensor_plugins import convert_sensor_plugin
from .sensor_types import TO_CLASSIC, TO_GZ
from .shape_names import choose_shape_names
from .translation import Translation
from .xml import Node


def add_sensors(node: Node, t: Translation, link: Link) -> None:
    """Add the sensors of a link to its owner."""
    for element in list_part_elements(t.robot, link):
        if element.tag == "sensor":
            if (element.get("type") or "").strip() == "force_torque":
                text = f"force_torque sensor '{element.get('name')}' is on link '{link.name}'; "
                t.report_loss(
                    "sensor", text + "it measures joints only, and is not exported", element, link
                )
                continue
            for made in _convert_made(node, t, link, element):
                move_to_owner(made, t, link)


def add_joint_sensors(node: Node, t: Translation, joint: Joint) -> None:
    """Add the sensors of a joint."""
    for element in list_part_elements(t.robot, joint):
        if element.tag == "sensor":
            for made in _convert_made(node, t, joint, element):
                rename_frames(made, t, joint)


def _convert_made(node: Node, t: Translation, part: Link | Joint, element: Element) -> list[Node]:
    """Convert a sensor to the types of the target; a multicamera becomes several sensors."""
    kind = (element.get("type") or "").strip()
    if kind not in TYPES:
        text = (
            f"sensor '{element.get('name')}' has a type that Gazebo does not have; it is not "
            "exported"
        )
        t.report_loss("sensor", text, element, part)
        return []
    types = TO_CLASSIC if t.options.classic else TO_GZ
    made = copy_raw_element(node, t, element, about=None)
    assert made is not None  # SDF allows sensors in links and joints
    write_imu_noise(made, element)
    _name_once(node, t, part, made, element)
    other = types.get(kind)
    if other is not None and not other.type:
        t.report_loss(
            "sensor",
            f"sensor '{element.get('name')}' is of type '{kind}', which {t.options.target} does "
            "not have; it is copied unchanged",
            element,
            part,
        )
    elif other is not None:
        made.set("type", other.type)
        for old, new in other.renamed:
            for holder in made.findall(old):
                holder.tag = new
        note = f" ({other.note})" if other.note else ""
        text = (
            f"sensor '{element.get('name')}' of type '{kind}' is exported as type "
            f"'{other.type}'{note}"
        )
        t.report_note("sensor", text, element, part)
    _add_plugins(made, t, part, element)
    _update_contacts(made, t, part, element)
    if kind == "multicamera" and not t.options.classic:
        return _split(node, made)
    return [made]


def _name_once(
    node: Node, t: Translation, part: Link | Joint, made: Node, element: Element
) -> None:
    """Rename a sensor if another of its link has the same name, and report it."""
    name = made.get("name") or f"{part.name}_sensor"
    taken = {other.get("name") for other in node if other is not made}
    new = get_free_name(name, taken)
    if new != made.get("name"):
        made.set("name", new)
        t.report_loss(
            "name", f"sensor '{name}' is '{new}' in SDF, since the name is taken", element, part
        )


def _add_plugins(made: Node, t: Translation, part: Link | Joint, element: Element) -> None:
    for written, source in zip(
        made.findall("plugin"), list(element.list_children("plugin")), strict=True
    ):
        made.remove(written)
        if t.options.classic or not convert_sensor_plugin(made, t, part, source):
            add_plugin(made, t, source)


def _split(node: Node, made: Node) -> list[Node]:
    """Split a multicamera into one sensor for each camera."""
    cameras = made.findall("camera")
    node.remove(made)
    result = []
    for index, camera in enumerate(cameras):
        one = deepcopy(made)
        one.set("name", f"{made.get('name')}_{camera.get('name') or index}")
        for place, other in enumerate(one.findall("camera")):
            if place != index:
                one.remove(other)
        node.append(one)
        result.append(one)
    return result


def _update_contacts(made: Node, t: Translation, part: Link | Joint, element: Element) -> None:
    """Update the collision names in a contact sensor, and report unknown ones."""
    if not isinstance(part, Link):
        return
    members = [t.robot.link[name] for name in t.plan.members[t.plan.owner[part.name]]]
    names = choose_shape_names(members)
    here = {names[id(c)] for link in members for c in link.collisions}
    by_link = {f"{m.name}_collision": names[id(m.collisions[0])] for m in members if m.collisions}
    for tag in made.iterfind("contact/collision"):
        name = (tag.text or "").strip()
        short = name.rpartition(LUMPED)[2].rpartition("::")[2]
        for candidate in (name, short, short.removesuffix("_collision")):
            if candidate in here:
                tag.text = candidate
                break
        else:
            if short in by_link:
                tag.text = by_link[short]
                continue
            t.report_loss(
                "contact-sensor",
                f"contact sensor '{element.get('name')}' watches collision '{name}', which link "
                f"'{part.name}' does not have",
                element,
                part,
                severity=Severity.WARNING,
                hint=f"its collisions are {', '.join(sorted(here)) or 'none'}",
            )
