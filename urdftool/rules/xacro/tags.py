"""The namespace and the tags of xacro."""

from __future__ import annotations

from collections.abc import Iterator

from ...source.description import Description
from ...source.document import Document, Element
from ..fix import FixContext, Proposal, rename_element, safe, set_attribute, unsafe
from ..rule import ERROR, INFO, SAFE, UNSAFE, Problem, rule
from ..words import words
from .definitions import macro_names

XMLNS = "http://www.ros.org/wiki/xacro"

_TAGS = frozenset(("include", "macro", "property", "if", "unless", "insert_block", "arg"))
_OTHERS = frozenset(("gazebo", "ros2_control", "mujoco", "transmission", "plugin", "sensor"))
_URDF = words(
    "robot link joint material inertial visual collision origin mass inertia geometry box cylinder "
    "sphere capsule mesh color texture parent child axis limit dynamics mimic safety_controller "
    "calibration"
)


@rule(
    INFO,
    effects={
        "xacro": "looks at the prefix only, and writes the same robot",
    },
    default=False,
    group="robot",
)
def nonstandard_xmlns(document: Document) -> Iterator[Problem]:
    """The xacro namespace is spelled in a way of its own.

    The name is ``http://www.ros.org/wiki/xacro``; ``http://ros.org/…`` and
    ``http://wiki.ros.org/…`` are seen as well. xacro itself compares the prefix ``xacro:`` and no
    more, and expands a file of either spelling; its warning of inconsistent namespaces comes for
    other prefixes only. Tools that follow the standard of XML take the tags of two spellings for
    different ones. No reader of robots does, so the rule is off by default.
    """
    root = document.root
    name = root.get("xmlns:xacro")
    if name is not None and name != XMLNS:
        yield Problem(
            root,
            f"the xacro namespace is spelled '{name}'; write {XMLNS}",
            at=root.attribute_place("xmlns:xacro"),
            group=f"{{count}} files spell the xacro namespace differently from {XMLNS}",
        )


@nonstandard_xmlns.fix(SAFE)
def write_xmlns(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the usual spelling."""
    return safe(f"write {XMLNS}", set_attribute(problem.element, "xmlns:xacro", XMLNS))


@rule(
    ERROR,
    effects={
        "xacro": "copies the tag to its output",
        "urdfdom": "ignores it: that part of the robot is missing",
    },
)
def unprefixed_xacro_tag(document: Document, description: Description) -> Iterator[Problem]:
    """A tag of xacro, or a call of a macro, lacks its ``xacro:``.

    Old xacro took ``<include>``, ``<property>`` and ``<wheel …/>`` without the prefix; today's
    copies them to the output as they are, and readers of URDF pass over what they do not know.
    Nothing is said, and the robot has no wheels.
    """
    if "xmlns:xacro" not in document.root.attributes:
        return
    macros = macro_names(description)
    for element in document.root.children:
        yield from _unprefixed(element, macros)


def _unprefixed(element: Element, macros: frozenset[str]) -> Iterator[Problem]:
    tag = element.tag
    if tag in _OTHERS:
        return
    if tag in _TAGS or (tag in macros and tag not in _URDF):
        what = "is copied and not expanded" if tag in _TAGS else "does not call the macro"
        yield Problem(element, f"<{tag}> without its prefix {what}; write <xacro:{tag}>")
    for child in element.children:
        yield from _unprefixed(child, macros)


@unprefixed_xacro_tag.fix(UNSAFE)
def add_prefix(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the prefix."""
    tag = f"xacro:{problem.element.tag}"
    return unsafe(f"write <{tag}>", rename_element(problem.element, tag))
