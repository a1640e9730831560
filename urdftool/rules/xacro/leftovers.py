"""Rules on expressions that remain after the expansion."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.urdf_schema import VOCABULARY
from ...source.description import Description
from ...source.document import Element
from ...source.location import Place
from ..cross_file_references import find_including_file
from ..fix import (
    FixContext,
    Proposal,
    find_attribute,
    find_element,
    substitute,
    substitute_text,
    unsafe,
)
from ..rule import ERROR, INFO, ROS, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_part, is_unexpanded
from .definitions import get_definitions

_BRACED = re.compile(r"(?<!\$)\{(\w+)\}")


@rule(
    ERROR,
    effects={
        "urdfdom (robot)": (
            "takes it as a name; if a number is required, the link loses its shapes"
        ),
        "mujoco (number)": "rejects the file: a number is required",
        "drake (number)": "rejects the file: a number is required",
        "gz, gazebo-classic (block)": (
            "ignore a reference with it; a friction with it aborts the process (sdformat 12.3)"
        ),
        "gz, gazebo-classic (plugin)": "pass it to the plugin unchanged",
    },
)
def unexpanded_expression(description: Description, targets: frozenset[str]) -> Iterator[Problem]:
    """The robot contains an unexpanded xacro expression.

    Either ``$`` is missing before a brace (``{prefix}``), or ``$${…}`` is an escape, or the file
    with ``${…}`` is not expanded. The text itself becomes the name, the number or the reference, so
    names do not match, without a message. A URDF with many of them is a xacro file without
    ``xmlns:xacro``; this is one finding. It is an info for a file that uses arguments with
    ``$(arg …)``, declares none, and is included by a file of a package around it, and for a file
    that has them only in ``<ros2_control>``, if nothing shows that ROS reads it.
    """
    root = description.document.root
    written = filter(_may_be_unexpanded, description.document.elements)
    found = [item for element in written for item in _find_expressions(element)]
    if description.expansion is None:
        if found:
            element, text, place = found[0]
            # the launch file of such a file mostly calls xacro
            meant = ".xacro" in description.path
            others = "place" if len(found) == 2 else "places"
            more = f" (and in {len(found) - 1} other {others})" if len(found) > 1 else ""
            braced = _BRACED.search(text)
            user = find_including_file(description, computed=True) if is_part(root) else ""
            if user:
                remedy = f"this file may be a part of {user}: check that"
            elif braced and "${" not in text and "$(" not in text:
                remedy = f"write the value of '{braced[0]}'"
            else:
                remedy = (
                    "if it is a xacro file, declare the xacro namespace in <robot> and "
                    "rename it to "
                )
                remedy += ".urdf.xacro"
            unread = all(_is_of_control(one) for one, *_ in found) and targets.isdisjoint(ROS)
            yield Problem(
                element,
                f"'{_shorten(text)}' is not expanded{more}; {remedy}",
                at=place,
                severity=INFO if user or unread else WARNING if meant else None,
                effects=tuple(dict.fromkeys(e for one, *_ in found for e in _select_effects(one))),
            )
        return
    if not found:
        return
    known = get_definitions(description)
    names = {*known.properties, *known.arguments}
    for macros in known.macros.values():
        for macro in macros:
            names.update(re.findall(r"\w+", macro.get("params") or ""))
    for element, text, place in found:
        braced = _BRACED.search(text)
        if braced is None or "${" in text or "$(" in text:
            yield Problem(
                element,
                f"'{_shorten(text)}' is not expanded, because '$$' escapes it; write one '$'",
                at=place,
                effects=_select_effects(element),
            )
        elif place is not None or braced[1] in names:
            yield Problem(
                element,
                f"'{_shorten(text)}' is not expanded, because '$' is missing; "
                f"write '${{{braced[1]}}}' for '{braced[0]}'",
                at=place,
                data={"name": braced[1]},
                effects=_select_effects(element),
            )


def _is_of_control(element: Element) -> bool:
    """Tell whether an element is in ``<ros2_control>``, which only controllers of ROS 2 read."""
    above: Element | None = element
    while above is not None and above.tag != "ros2_control":
        above = above.parent
    return above is not None


def _select_effects(element: Element) -> tuple[str, ...]:
    """Select the effects of readers that read an element."""
    above: Element | None = element
    tags = []
    while above is not None and above.parent is not None:
        tags.append(above.tag)
        above = above.parent
    if "plugin" in tags:
        return ("gz, gazebo-classic (plugin)",)
    if tags and tags[-1] == "gazebo":
        return ("gz, gazebo-classic (block)",)
    if tags and tags[-1] not in ("link", "joint", "material"):
        return ()
    return ("urdfdom (robot)", *_select_rejecting(element, tags))


def _select_rejecting(element: Element, tags: list[str]) -> Iterator[str]:
    """Yield the effects of the readers that reject a text in a number of an element."""
    numbers = VOCABULARY[element.tag].numbers if element.tag in VOCABULARY else {}
    texts = [name for name in numbers if is_unexpanded(element.get(name) or "")]
    if set(texts) - {"velocity"} and not {"visual", "material"} & {*tags}:
        yield "mujoco (number)"
    if texts and {"inertial", "joint"} & {*tags}:
        yield "drake (number)"


def _may_be_unexpanded(element: Element) -> bool:
    """Tell whether an element has a bracket of an expression, which nearly all have not."""
    text = "".join(element.attributes.values()) + element.text
    return "{" in text or "$" in text


def _find_expressions(element: Element) -> Iterator[tuple[Element, str, Place | None]]:
    """Yield values with an expression: the element, the text, and the place of its attribute."""
    for name, text in element.attributes.items():
        if is_unexpanded(text):
            yield element, text, element.locate_attribute(name)
    text = element.text
    if text and is_unexpanded(text):
        yield element, " ".join(text.split()), None


def _shorten(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "…"


@unexpanded_expression.fix(UNSAFE, reveals=True)
def add_dollar(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the ``$``, if the name is defined."""
    name = problem.data.get("name", "")
    if not name:
        return None
    found = find_attribute(problem)
    pattern = rf"(?<!\$)\{{{name}\}}"
    new = rf"${{{name}}}"
    if found is not None:
        if not _is_in_scope(name, found[0], context):
            return None
        return unsafe(f"write ${{{name}}}", substitute(*found, pattern, new))
    element = find_element(problem) or problem.element
    if element.children or not _is_in_scope(name, element, context):
        return None
    return unsafe(f"write ${{{name}}}", substitute_text(element, pattern, new))


def _is_in_scope(name: str, element: Element, context: FixContext) -> bool:
    """Tell whether a name is a property, or a parameter of the macro around an element."""
    known = get_definitions(context.description)
    if name in known.properties:
        return True
    for macros in known.macros.values():
        for macro in macros:
            if macro.file.path == element.file.path and macro.start < element.start < macro.end:
                return re.search(rf"\b{name}\b", macro.get("params") or "") is not None
    return False
