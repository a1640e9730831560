"""Rules on the namespace and the tags of xacro."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.urdf_schema import VOCABULARY
from ...source.description import Description
from ...source.document import Document, Element
from ...source.xacro_names import UNPREFIXED
from ..fix import FixContext, Proposal, rename_element, safe, set_attribute, unsafe
from ..rule import ERROR, INFO, SAFE, UNSAFE, Problem, rule
from .definitions import get_macro_names

XMLNS = "http://www.ros.org/wiki/xacro"

_DIALECT_TAGS = frozenset(("gazebo", "ros2_control", "mujoco", "transmission", "plugin", "sensor"))
_URDF = VOCABULARY.keys()


@rule(
    INFO,
    effects={
        "xacro": "compares only the prefix, and writes the same robot",
    },
    default=False,
    group="robot",
)
def nonstandard_xmlns(document: Document) -> Iterator[Problem]:
    """The xacro namespace has a nonstandard spelling.

    The name is ``http://www.ros.org/wiki/xacro``; ``http://ros.org/…`` and
    ``http://wiki.ros.org/…`` are also in use. xacro only compares the prefix ``xacro:`` and expands
    both spellings. XML tools treat tags of two spellings as different. No reader of robots does, so
    the rule is off by default.
    """
    root = document.root
    name = root.get("xmlns:xacro")
    if name is not None and name != XMLNS:
        yield Problem(
            root,
            f"xacro namespace is '{name}'; write {XMLNS}",
            at=root.locate_attribute("xmlns:xacro"),
            group=f"{{count}} files have a xacro namespace other than {XMLNS}",
        )


@nonstandard_xmlns.fix(SAFE)
def write_xmlns(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the standard spelling."""
    return safe(f"write {XMLNS}", set_attribute(problem.element, "xmlns:xacro", XMLNS))


@rule(
    ERROR,
    effects={
        "xacro": "copies the tag to its output",
        "urdfdom": "ignores it: that part of the robot is missing",
    },
)
def unprefixed_xacro_tag(document: Document, description: Description) -> Iterator[Problem]:
    """A xacro tag or a macro call has no prefix ``xacro:``.

    Old versions of xacro expanded ``<include>``, ``<property>`` and ``<wheel …/>`` without the
    prefix. Current versions copy them to the output, where readers of URDF ignore them without a
    message, so parts of the robot are missing.
    """
    if "xmlns:xacro" not in document.root.attributes:
        return
    macros = get_macro_names(description)
    if document.elements_by_tag.keys().isdisjoint((macros | UNPREFIXED) - (_URDF - UNPREFIXED)):
        return
    for element in document.root.children:
        yield from _find_unprefixed(element, macros)


def _find_unprefixed(element: Element, macros: frozenset[str]) -> Iterator[Problem]:
    tag = element.tag
    if tag in _DIALECT_TAGS:
        return
    if tag in UNPREFIXED or (tag in macros and tag not in _URDF):
        what = "is not expanded" if tag in UNPREFIXED else "does not call the macro"
        yield Problem(element, f"<{tag}> without the prefix xacro: {what}; write <xacro:{tag}>")
    for child in element.children:
        yield from _find_unprefixed(child, macros)


@unprefixed_xacro_tag.fix(UNSAFE, reveals=True)
def add_prefix(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the prefix."""
    tag = f"xacro:{problem.element.tag}"
    return unsafe(f"write <{tag}>", rename_element(problem.element, tag))
