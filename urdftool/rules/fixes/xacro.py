"""Fixes of xacro source that could be read."""

from __future__ import annotations

import re

from ...source.document import Element
from ..rule import Problem
from ..xacro.tags import XMLNS
from .proposal import (
    Around,
    Proposal,
    Span,
    attribute_at,
    element_at,
    put,
    remove,
    retag,
    safe,
    sub,
    sub_text,
    unsafe,
)

_FOR_LAUNCH = {"find-pkg-share": "find", "find-pkg-prefix": "find", "var": "arg"}


def nonstandard_xmlns(problem: Problem, around: Around) -> Proposal | None:
    """As all spell it."""
    return safe(f"write {XMLNS}", put(problem.element, "xmlns:xacro", XMLNS))


def unprefixed_xacro_tag(problem: Problem, around: Around) -> Proposal | None:
    """With its prefix."""
    return unsafe(
        f"write <xacro:{problem.element.tag}>",
        retag(problem.element, f"xacro:{problem.element.tag}"),
    )


def unexpanded_expression(problem: Problem, around: Around) -> Proposal | None:
    """With its ``$``, where the name is known."""
    match = re.search(r"write '(\$\{\w+\})' for '(\{\w+\})'", problem.message)
    if match is None:
        return None
    name = match[1][2:-1]
    found = attribute_at(problem)
    pattern = rf"(?<!\$)\{{{name}\}}"
    new = rf"${{{name}}}"
    if found is not None:
        if not _is_in_scope(name, found[0], around):
            return None
        return unsafe(f"write {match[1]}", sub(*found, pattern, new))
    element = element_at(problem) or problem.element
    if element.children or not _is_in_scope(name, element, around):
        return None
    return unsafe(f"write {match[1]}", sub_text(element, pattern, new))


def _is_in_scope(name: str, element: Element, around: Around) -> bool:
    """Whether a name is a parameter of the macro an element is written in, or a property."""
    from ..xacro.definitions import definitions

    known = definitions(around.description)
    if name in known.properties:
        return True
    for macros in known.macros.values():
        for macro in macros:
            if macro.file.path == element.file.path and macro.start < element.start < macro.end:
                return re.search(rf"\b{name}\b", macro.get("params") or "") is not None
    return False


def bad_substitution_command(problem: Problem, around: Around) -> Proposal | None:
    """What xacro calls it."""
    match = re.search(r"no \$\(([\w-]+) …\)", problem.message)
    found = attribute_at(problem)
    if match is None or match[1] not in _FOR_LAUNCH:
        return None
    name = _FOR_LAUNCH[match[1]]
    pattern = rf"\$\(\s*{match[1]}(?=\s)"
    if found is not None:
        return safe(f"write $({name} …)", sub(*found, pattern, f"$({name}"))
    return safe(f"write $({name} …)", sub_text(problem.element, pattern, f"$({name}"))


def unused_arg(problem: Problem, around: Around) -> Proposal | None:
    """Gone."""
    return unsafe("take it out", remove(problem.element))


def unused_property(problem: Problem, around: Around) -> Proposal | None:
    """Gone."""
    return unsafe("take it out", remove(problem.element))


def unused_macro(problem: Problem, around: Around) -> Proposal | None:
    """Gone."""
    return unsafe("take it out", remove(problem.element))


def deprecated_global_function(problem: Problem, around: Around) -> Proposal | None:
    """By its new name, in the tag that is spoken of."""
    match = re.search(r"(\w+)\(\) is now called ([\w.]+)\(\)", problem.message)
    place = problem.place
    if match is None:
        return None
    old, new = match[1].encode(), match[2].encode()
    data = place.file.data[place.start : place.end]
    calls = list(re.finditer(rb"(?<![\w.])" + old + rb"(?=\s*\()", data))
    spans = [
        Span(place.file, place.start + call.start(), place.start + call.end(), new)
        for call in calls
    ]
    return safe(f"write {match[2]}()", *spans) if spans else None
