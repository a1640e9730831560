"""Positions in ``<ros2_control>`` blocks, in the conventions of another robot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy
from dataclasses import replace

from ..model.elements import Robot
from ..model.numbers import number
from ..source.document import Element
from .correspondence import JointValue


def shift_blocks(robot: Robot, known: Mapping[str, JointValue]) -> Robot:
    """Return the robot with shifted positions and ranges of its hardware interfaces."""
    if robot.xml is None or not known:
        return robot
    root = copy(robot.xml)
    root.children = [_shift_block(block, known) for block in root.children]
    return replace(robot, provenance=root)


def _shift_block(block: Element, known: Mapping[str, JointValue]) -> Element:
    if block.tag != "ros2_control":
        return block
    made = copy(block)
    made.children = [_shift_joint(e, known) if e.tag == "joint" else e for e in block.children]
    return made


def _shift_joint(joint: Element, known: Mapping[str, JointValue]) -> Element:
    value, made = known.get(joint.get("name") or ""), copy(joint)
    if value is not None:
        made.children = [_shift_interface(interface, value) for interface in joint.children]
    params = {e.get("name"): e for e in joint.list_children("param")}
    if "mimic" in params:
        leader = known.get(params["mimic"].text.strip())
        sign = math.prod(one.sign for one in (value, leader) if one is not None)
        if sign < 0:
            made.children = _negate_multiplier(made.children, params["mimic"])
    return made


def _negate_multiplier(children: list[Element], mimic: Element) -> list[Element]:
    """Return the elements of a follower with the opposite multiplier, which is 1 by default."""
    made = [copy(child) for child in children]
    written = [e for e in made if e.tag == "param" and e.get("name") == "multiplier"]
    if not written:
        written = [copy(mimic)]
        written[0].attributes = {"name": "multiplier"}
        written[0].text = "1"
        made += written
    for element in written:
        if (factor := number(element.text.strip())) is not None:
            element.text = repr(-factor)
    return made


def _shift_interface(interface: Element, value: JointValue) -> Element:
    """Return an interface with shifted ``initial_value``, ``min`` and ``max``.

    A negative sign exchanges minimum and maximum; velocity and effort have the sign only.
    """
    name = (interface.get("name") or "").rpartition("/")[2]
    if name not in ("position", "velocity", "effort"):
        return interface
    zero = value.zero if name == "position" else 0.0
    made = copy(interface)
    made.children = []
    texts = {e.get("name"): e.text for e in interface.list_children("param")}
    other = {"min": "max", "max": "min"} if value.sign < 0 else {}
    for element in interface.children:
        key = element.get("name") or ""
        source = number((texts.get(other.get(key, key)) or "").strip())
        shifted = copy(element)
        if key in ("min", "max", "initial_value") and source is not None:
            shifted.text = repr(value.sign * source + zero)
        made.children.append(shifted)
    return made
