"""Serialization of the sections: in Menagerie's order, indented by two blanks, with blank lines."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise

from lxml import etree

from ...diagnostic import Severity
from ...finding import Finding
from .body import Bodies

ORDER = (
    "compiler", "option", "size", "visual", "statistic", "default", "asset", "worldbody",
    "contact", "tendon", "equality", "actuator", "sensor", "keyframe", "custom",
)  # fmt: skip

# order of the attributes of an element
ATTRIBUTES = (
    "name", "class", "joint", "joint1", "joint2", "body1", "body2", "site", "objtype", "objname",
    "type", "childclass", "mass", "size", "pos", "quat", "axis", "dir", "mesh", "material", "rgba",
)  # fmt: skip


def assemble(model: str, sections: dict[str, etree._Element]) -> bytes:
    """Serialize a model."""
    root = etree.Element("mujoco", model=model)
    for name in ORDER:
        section = sections.get(name)
        if section is not None and (len(section) or len(section.attrib)):
            root.append(section)
    return serialize(root)


def serialize(root: etree._Element) -> bytes:
    """Serialize a tree; equal trees give equal bytes."""
    for element in root.iter(etree.Element):
        _order(element)
    etree.indent(root, "  ")
    sections = list(root)
    for before, after in pairwise(sections):
        if not isinstance(after, etree._Comment):
            before.tail = "\n\n  "
    text = etree.tostring(root, encoding="unicode", with_tail=False)
    return (text + "\n").encode()


def report_losses(losses: Iterable[Finding], bodies: Bodies) -> None:
    """Insert the losses of a link or joint as comments at its element."""
    joints = {
        element.get("name"): element
        for tag in ("site", "joint")  # a locked joint is a site
        for body in bodies.values()
        for element in body.iterchildren(tag)
    }
    for loss in losses:
        if loss.severity is Severity.INFO:
            continue
        if loss.kind == "link" and loss.name in bodies:
            body = bodies[loss.name]
            body.insert(0, create_comment(loss.message))
        elif loss.kind == "joint" and loss.name in joints:
            joints[loss.name].addprevious(create_comment(loss.message))


def create_comment(text: str) -> etree._Comment:
    """Create a comment; XML does not allow two consecutive dashes in it."""
    return etree.Comment(f" {re.sub('-(?=-)', '- ', text.rstrip('-'))} ")


def _order(element: etree._Element) -> None:
    if element.tag in ("compiler", "option", "size"):
        return
    rank = {name: index for index, name in enumerate(ATTRIBUTES)}
    attributes = sorted(element.attrib.items(), key=lambda item: rank.get(str(item[0]), len(rank)))
    element.attrib.clear()
    for name, value in attributes:
        element.set(name, value)
