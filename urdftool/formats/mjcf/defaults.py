"""Default classes as in MuJoCo Menagerie, for attributes that most joints or geoms share."""

from __future__ import annotations

from collections import Counter

from lxml import etree

from .classes import add_foot_class, add_joint_classes
from .gazebo import DEFAULT_FRICTION

# attribute -> MuJoCo's default
JOINT = {"axis": "0 0 1", "damping": "0", "frictionloss": "0", "armature": "0"}
GEOM = {"type": "sphere", "friction": DEFAULT_FRICTION}

VISUAL = {"contype": "0", "conaffinity": "0", "group": "2"}
COLLISION = {"group": "3"}


def build_default_section(
    model: str, world: etree._Element, actuators: etree._Element | None = None
) -> etree._Element:
    """Build ``<default>`` with the robot's class; remove the shared attributes from the elements.

    Args:
        model: Name of the model and of the class.
        world: ``<worldbody>``, whose joints and geoms are modified.
        actuators: ``<actuator>``, whose elements are modified.
    """
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
