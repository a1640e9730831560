"""Lights of links in ``<gazebo>`` blocks."""

from __future__ import annotations

import math

from lxml import etree

from ...model.elements import Robot, Vector
from ...model.pose import IDENTITY, Pose, rotate, rotation_from_rpy
from ...model.read import number, parse_numbers
from ...source.document import Element
from ..common.naming import UniqueNames
from ..written import Written
from .body import Bodies
from .digits import format_numbers_text, number_text

DOWN: Vector = (0.0, 0.0, -1.0)
TYPES = ("point", "directional", "spot")


def put_lights(robot: Robot, bodies: Bodies, written: Written) -> None:
    """Insert the lights of each link into its body."""
    names = UniqueNames()
    for block in robot.gazebo:
        for light in block.element.list_children("light"):
            if block.reference not in bodies:
                written.report_loss(
                    "light", "a light that is not on a link is not exported", light.place
                )
                continue
            body = bodies[block.reference]
            first = body.find("body")
            body.insert(len(body) if first is None else body.index(first), _light(light, names))


def _light(light: Element, names: UniqueNames) -> etree._Element:
    kind = light.get("type") or "point"
    element = etree.Element("light", name=names.take(light.get("name") or "light"))
    element.set("type", kind if kind in TYPES else "point")
    values = parse_numbers(_get_text(light, "pose"), 6)
    pose = IDENTITY
    if values is not None:
        turn = rotation_from_rpy((values[3], values[4], values[5]))
        pose = Pose(turn, (values[0], values[1], values[2]))
    if any(pose.translation):
        element.set("pos", format_numbers_text(pose.translation))
    aim = parse_numbers(_get_text(light, "direction"), 3)
    direction = DOWN if aim is None or not any(aim) else (aim[0], aim[1], aim[2])
    if kind != "point":
        element.set("dir", format_numbers_text(rotate(pose.rotation, direction)))
    for name in ("diffuse", "specular"):
        color = parse_numbers(_get_text(light, name), 4) or parse_numbers(_get_text(light, name), 3)
        if color is not None:
            element.set(name, format_numbers_text(color[:3]))
    if (_get_text(light, "cast_shadows") or "").lower() in ("false", "0"):
        element.set("castshadow", "false")
    spot = light.find_child("spot")
    outer = number(_get_text(spot, "outer_angle")) if spot is not None else None
    if kind == "spot" and outer:
        element.set("cutoff", number_text(min(math.degrees(outer) / 2, 90.0)))
    return element


def _get_text(element: Element, tag: str) -> str | None:
    child = element.find_child(tag)
    return child.text.strip() if child is not None else None
