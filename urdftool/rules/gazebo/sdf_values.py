"""A rule on values of SDF, in SDF files and in ``<gazebo>`` blocks."""

from __future__ import annotations

from collections.abc import Iterator, Set

from ...model.elements import GazeboExtension, Robot
from ...model.sdf_schema import find_requirement, find_requirement_of_attribute
from ...source.description import Description
from ...source.document import Element
from ...source.location import Place
from ..rule import ERROR, URDF_AND_SDF, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from .keywords import KEYWORDS
from .lumped_model import find_kept_links, is_joint_kept
from .lumping import get_lumped_body, is_lumped

APPLIES_TO = ("gazebo",)

_REJECTED = "gz, gazebo-classic (another type, or outside of the range)"
_CUT = "gz, gazebo-classic (more than the value)"


@rule(
    ERROR,
    formats=URDF_AND_SDF,
    effects={
        _REJECTED: "reject the whole model (sdformat 12.3: Error 9)",
        _CUT: "take the beginning, without a message (sdformat 12.3)",
    },
)
def invalid_sdf_value(robot: Robot, description: Description) -> Iterator[Problem]:
    """An element of SDF has a text that is not a value of its type, or outside of its range.

    SDF gives each element a type: ``<update_rate>`` is a number, ``<always_on>`` true or false,
    ``<diffuse>`` three or four numbers from 0 to 1. libsdformat rejects the whole model if one
    value has another type, also in a ``<sensor>`` or ``<visual>`` of a ``<gazebo>`` block. Of
    ``10 Hz`` it reads 10 and ignores the rest; this case is a warning. Blocks of links and joints
    that Gazebo does not keep are not checked.
    """
    if robot.format == "sdf":
        for parent, element in _iterate("", description.document.root):
            yield from _check(parent, element)
    kept = find_kept_links(robot) or set()
    for block in robot.gazebo if kept else ():
        if not _is_read(robot, block, kept):
            continue
        is_lumped_link = block.reference in robot.link and is_lumped(robot, block.reference)
        for parent, element in iterate_sdf_elements(robot, block):
            if not (
                is_lumped_link and (parent, element.tag) == ("sensor", "pose")
            ):  # sdformat computes another
                yield from _check(parent, element)


def _is_read(robot: Robot, block: GazeboExtension, kept: Set[str]) -> bool:
    """Tell whether the part of a block is in the model that sdformat makes."""
    name = block.reference
    if name in robot.link:
        return get_lumped_body(robot, name) in kept
    return name not in robot.joint or is_joint_kept(robot, robot.joint[name], kept)


def iterate_sdf_elements(robot: Robot, block: GazeboExtension) -> Iterator[tuple[str, Element]]:
    """Yield the elements of SDF in a block, each after the tag of the element that holds it.

    Keywords, parameters of plugins and blocks that refer to no part of the robot are left out.
    """
    name = block.reference
    parent = "link" if name in robot.link else "joint" if name in robot.joint else "model"
    if not name or parent != "model":
        for child in block.element.children:
            if child.tag not in KEYWORDS or child.children:
                yield from _iterate(parent, child)


def _iterate(parent: str, element: Element) -> Iterator[tuple[str, Element]]:
    """Yield an element and all below it in document order; parameters of plugins have no type."""
    todo = [(parent, element)]
    while todo:
        parent, element = todo.pop()
        if element.tag != "plugin":
            yield parent, element
            todo += [(element.tag, child) for child in reversed(element.children)]


def _check(parent: str, element: Element) -> Iterator[Problem]:
    """Check the text of an element and its attributes."""
    text = element.text.strip()
    required = find_requirement(parent, element)
    if required and not is_unexpanded(text):
        shown = f"'{text}', not" if text else "empty; it needs"
        fact = f"<{element.tag}> of <{parent}> is {shown} {required.text}"
        yield from _report(element, element, fact, required.effect)
    for name, value in element.attributes.items():
        required = find_requirement_of_attribute(element, name)
        if required and not is_unexpanded(value):
            fact = f"{name} of <{element.tag}> is '{value}', not {required.text}"
            yield from _report(element, element.locate_attribute(name), fact, required.effect)


def _report(element: Element, at: Element | Place, fact: str, effect: str) -> Iterator[Problem]:
    if effect == "reject":
        yield Problem(element, f"{fact}, so Gazebo rejects the model", at=at, effects=(_REJECTED,))
    elif effect == "beginning":
        text = f"{fact}; Gazebo reads its beginning"
        yield Problem(element, text, at=at, severity=WARNING, effects=(_CUT,))
