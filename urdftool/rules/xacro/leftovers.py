"""Expressions that are still there after the expansion."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...source.description import Description
from ...source.document import Element
from ...source.location import Place
from ..fix import (
    FixContext,
    Proposal,
    attribute_at,
    element_at,
    substitute,
    substitute_text,
    unsafe,
)
from ..rule import ERROR, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from .definitions import definitions

_BRACED = re.compile(r"(?<!\$)\{(\w+)\}")


@rule(
    ERROR,
    effects={
        "urdfdom (robot)": (
            "takes it as a name; where a number is required, the link loses its shapes"
        ),
        "gz, gazebo-classic (block)": (
            "ignore a reference with it; a friction with it ends the process (sdformat 12.3)"
        ),
        "gz, gazebo-classic (plugin)": "pass it to the plugin as it is written",
    },
)
def unexpanded_expression(description: Description) -> Iterator[Problem]:
    """An expression of xacro is still there in the robot.

    A brace that lost its ``$`` (``{prefix}``), the escape ``$${…}``, or ``${…}`` in a file that is
    not expanded. The text itself becomes the name, the number or the reference: names do not
    match, and nobody says so. A plain URDF that is full of them is xacro whose ``xmlns:xacro`` is
    missing; that is one finding.
    """
    root = description.document.root
    found = [item for element in root.walk() for item in _leftovers(element)]
    if description.expansion is None:
        if found:
            element, text, place = found[0]
            # such a file is put through xacro by its launch file, more often than not
            meant = ".xacro" in description.path
            others = "place" if len(found) == 2 else "places"
            more = f" (and in {len(found) - 1} other {others})" if len(found) > 1 else ""
            braced = _BRACED.search(text)
            if braced and "${" not in text and "$(" not in text:
                remedy = f"write what '{braced[0]}' stands for"
            else:
                remedy = "if this is xacro, declare its namespace on <robot> and name the file "
                remedy += ".urdf.xacro"
            yield Problem(
                element,
                f"'{_short(text)}' is not expanded{more}; {remedy}",
                at=place,
                severity=WARNING if meant else None,
                effects=_readers_of(element),
            )
        return
    if not found:
        return
    known = definitions(description)
    names = {*known.properties, *known.arguments}
    for macros in known.macros.values():
        for macro in macros:
            names.update(re.findall(r"\w+", macro.get("params") or ""))
    for element, text, place in found:
        braced = _BRACED.search(text)
        if braced is None or "${" in text or "$(" in text:
            yield Problem(
                element,
                f"'{_short(text)}' is not expanded; a doubled '$' escapes it",
                at=place,
                effects=_readers_of(element),
            )
        elif place is not None or braced[1] in names:
            yield Problem(
                element,
                f"'{_short(text)}' is not expanded: it lacks its '$'; "
                f"write '${{{braced[1]}}}' for '{braced[0]}'",
                at=place,
                data={"name": braced[1]},
                effects=_readers_of(element),
            )


def _readers_of(element: Element) -> tuple[str, ...]:
    """Select the effects by which readers look at an element."""
    above: Element | None = element
    tags = []
    while above is not None and above.parent is not None:
        tags.append(above.tag)
        above = above.parent
    if "plugin" in tags:
        return ("gz, gazebo-classic (plugin)",)
    if tags and tags[-1] == "gazebo":
        return ("gz, gazebo-classic (block)",)
    return ("urdfdom (robot)",) if not tags or tags[-1] in ("link", "joint", "material") else ()


def _leftovers(element: Element) -> Iterator[tuple[Element, str, Place | None]]:
    """The values in an element that hold an expression: the element, the text, its attribute."""
    for name, text in element.attributes.items():
        if is_unexpanded(text):
            yield element, text, element.attribute_place(name)
    text = element.text
    if text and is_unexpanded(text):
        yield element, " ".join(text.split()), None


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "…"


@unexpanded_expression.fix(UNSAFE)
def add_dollar(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the ``$``, where the name is known."""
    name = problem.data.get("name", "")
    if not name:
        return None
    found = attribute_at(problem)
    pattern = rf"(?<!\$)\{{{name}\}}"
    new = rf"${{{name}}}"
    if found is not None:
        if not _is_in_scope(name, found[0], context):
            return None
        return unsafe(f"write ${{{name}}}", substitute(*found, pattern, new))
    element = element_at(problem) or problem.element
    if element.children or not _is_in_scope(name, element, context):
        return None
    return unsafe(f"write ${{{name}}}", substitute_text(element, pattern, new))


def _is_in_scope(name: str, element: Element, context: FixContext) -> bool:
    """Whether a name is a parameter of the macro an element is written in, or a property."""
    known = definitions(context.description)
    if name in known.properties:
        return True
    for macros in known.macros.values():
        for macro in macros:
            if macro.file.path == element.file.path and macro.start < element.start < macro.end:
                return re.search(rf"\b{name}\b", macro.get("params") or "") is not None
    return False
