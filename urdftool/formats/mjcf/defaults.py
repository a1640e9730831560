"""Default classes as in MuJoCo Menagerie, for attributes that most joints or geoms share."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence

from lxml import etree

from ...model.settings import RESISTANCE
from ..common.naming import UniqueNames
from .gazebo import DEFAULT_FRICTION

# attribute -> MuJoCo's default
JOINT = {
    "axis": "0 0 1",
    **{row.mjcf_attribute: "0" for row in RESISTANCE},
    "solreflimit": "0.02 1",
}
GEOM = {"type": "sphere", "friction": DEFAULT_FRICTION}

VISUAL = {"contype": "0", "conaffinity": "0", "group": "2"}
COLLISION = {"group": "3"}


def build_default_section(
    model: str, world: etree._Element, actuators: etree._Element | None = None
) -> etree._Element:
    """Build ``<default>`` with the robot's class; remove shared attributes from the elements."""
    section = etree.Element("default")
    robot = etree.SubElement(section, "default", {"class": model})
    joint = etree.Element("joint")
    joints = [j for j in world.iter("joint") if j.get("type") != "ball"]
    _move_share(joint, joints, JOINT)
    if len(joint.attrib):
        robot.append(joint)
        for ball in world.iter("joint"):
            if ball.get("type") == "ball":
                _restore(ball, joint, {k: v for k, v in JOINT.items() if k != "axis"})
    add_joint_classes(robot, world, actuators, model)
    for name, fixed, shared in (
        ("visual", VISUAL, {"type": "sphere"}),
        ("collision", COLLISION, GEOM),
    ):
        geoms = [geom for geom in world.iter("geom") if geom.get("class") == name]
        if geoms:
            group = etree.SubElement(robot, "default", {"class": name})
            default = etree.SubElement(group, "geom")
            _move_share(default, geoms, shared)
            for attribute, value in fixed.items():
                default.set(attribute, value)
            if name == "collision":
                add_foot_class(group, world)
    return section


def _move_share(
    default: etree._Element, elements: list[etree._Element], builtin: dict[str, str]
) -> None:
    """Move values that more than half of the elements share to the default; write others out."""
    for attribute, plain in builtin.items():
        counts = Counter(element.get(attribute, plain) for element in elements)
        if not counts:
            continue
        value, count = counts.most_common(1)[0]
        if value == plain or count < 2 or 2 * count <= len(elements):
            value = plain
        if value != plain:
            default.set(attribute, value)
        for element in elements:
            own = element.get(attribute, plain)
            if own == value:
                if attribute in element.attrib:
                    del element.attrib[attribute]
            elif attribute not in element.attrib:
                element.set(attribute, own)


def _restore(element: etree._Element, default: etree._Element, builtin: dict[str, str]) -> None:
    for attribute, plain in builtin.items():
        if attribute in default.attrib and attribute not in element.attrib:
            element.set(attribute, plain)


SIDES = (
    "l", "r", "left", "right", "fl", "fr", "rl", "rr", "hl", "hr", "lf", "rf", "lh", "rh", "lr",
    "front", "rear", "hind", "back", "upper", "lower", "joint", "jnt", "link", "motor", "actuator",
)  # fmt: skip
"""Words of a joint's name that describe its location, not its function."""

FEET = ("foot", "feet", "toe", "sole", "paw")
"""Words in the names of links that stand on the ground."""

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_OWN = ("name", "class", "joint")

Signature = tuple[tuple[str, str], ...]


def add_joint_classes(
    robot: etree._Element, world: etree._Element, actuators: etree._Element | None, model: str
) -> None:
    """Create a class for joints that share limits, resistance and the gains of their actuator."""
    driven: dict[str, list[etree._Element]] = {}
    for actuator in actuators if actuators is not None else ():
        driven.setdefault(actuator.get("joint", ""), []).append(actuator)
    groups: dict[tuple[Signature, tuple[tuple[str, Signature], ...]], list[etree._Element]] = {}
    for joint in world.iter("joint"):
        own = driven.get(joint.get("name", ""), [])
        key = (
            _make_signature(joint, (*_OWN, "axis")),
            tuple((str(actuator.tag), _make_signature(actuator, _OWN)) for actuator in own),
        )
        groups.setdefault(key, []).append(joint)
    names = UniqueNames(("main", "visual", "collision", "foot", model))
    for number, (key, joints) in enumerate(groups.items(), 1):
        shared, drives = key
        if len(joints) < 2 or len(drives) > 1 or len(shared) + sum(len(d[1]) for d in drives) < 2:
            continue
        role = _join_role([joint.get("name", "") for joint in joints]) or f"size{number}"
        name = names.take(role)
        default = etree.SubElement(robot, "default", {"class": name})
        of_joint = etree.SubElement(default, "joint", dict(shared))
        axes = {joint.get("axis") for joint in joints}
        if len(axes) == 1 and None not in axes:
            of_joint.set("axis", axes.pop() or "")
        for joint in joints:
            _take_off(joint, of_joint, name)
        if not len(of_joint.attrib):
            default.remove(of_joint)
        for tag, signature in drives:
            of_actuator = etree.SubElement(default, tag, dict(signature))
            for joint in joints:
                _take_off(driven[joint.get("name", "")][0], of_actuator, name)


def add_foot_class(collision: etree._Element, world: etree._Element) -> None:
    """Create the class ``foot`` for the collision geoms of feet, for users to set their contact."""
    feet = [
        geom
        for geom in world.iter("geom")
        if geom.get("class") == "collision" and _is_foot(geom.getparent())
    ]
    if len(feet) < 2:
        return
    default = etree.SubElement(collision, "default", {"class": "foot"})
    shared = etree.SubElement(default, "geom")
    for attribute in ("type", "size", "friction"):
        values = {geom.get(attribute) for geom in feet}
        if len(values) == 1 and None not in values:
            shared.set(attribute, values.pop() or "")
    for geom in feet:
        _take_off(geom, shared, "foot")


def _is_foot(body: etree._Element | None) -> bool:
    return body is not None and any(word in FEET for word in _collect_words(body.get("name", "")))


def _take_off(element: etree._Element, default: etree._Element, name: str) -> None:
    """Assign a class to an element, and remove the attributes that the class sets."""
    for attribute in default.attrib:
        del element.attrib[attribute]
    element.set("class", name)


def _make_signature(element: etree._Element, but: Iterable[str]) -> Signature:
    return tuple((str(k), str(v)) for k, v in element.attrib.items() if str(k) not in but)


def _join_role(names: Sequence[str]) -> str:
    """Join the words common to the names of all joints, without those that describe a location."""
    first, *others = (_collect_words(name) for name in names)
    common = [word for word in first if all(word in words for words in others)]
    return "_".join(dict.fromkeys(word for word in common if word not in SIDES))


def _collect_words(name: str) -> list[str]:
    return [word.lower() for word in _WORD.findall(name)]
