"""Fixes of xacro source that could be read."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from math import inf, isclose

from ...model.read import number
from ...source.document import Element
from ...source.location import SourceFile
from ..renaming import find_joint_references as joints_named
from ..renaming import find_link_references as links_named
from ..rule import Problem
from ..xacro.definitions import definitions
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
    say,
    sub,
    sub_text,
    to_write,
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


def hard_coded_name_in_macro(problem: Problem, around: Around) -> Proposal | None:
    """With its prefix, also where the macro names it."""
    macro: Element | None = problem.element
    while macro is not None and macro.tag != "xacro:macro":
        macro = macro.parent
    name, new = problem.element.get("name") or "", to_write(problem)
    if macro is None or not new:
        return None
    named = links_named if problem.element.tag == "link" else joints_named
    changes = [put(e, at, new) if at else say(e, new) for e, at in named(macro, name)]
    return unsafe(f"write {new}, here and where the macro names it", *changes)


def shadowed_builtin(problem: Problem, around: Around) -> Proposal | None:
    """Without it, where it is what xacro has; else by another name, where a property has it."""
    match = re.match(r"'(\w+)' is a name", problem.message)
    found = definitions(around.description)
    name = match[1] if match is not None else ""
    properties = found.properties.get(name, [])
    macros = [macro for same in found.macros.values() for macro in same]
    if len(properties) != 1 or any(
        re.search(rf"(?<!\w){name}(?!\w)", macro.get("params") or "") for macro in macros
    ):
        return None
    (element,), value = properties, number(properties[0].get("value"))
    if value is not None and isclose(value, _constant(name), rel_tol=1e-3):
        return unsafe(f"take it away, as xacro has '{name}'", remove(element))
    new = f"{name}_value"
    if any(new.encode() in file.data for file in around.description.files):
        return None
    spans = [span for file in around.description.files for span in _said(file, name, new)]
    return unsafe(f"call it '{new}'", put(element, "name", new), *spans)


def _constant(name: str) -> float:
    """A number that is there in every expression; infinity where it is none."""
    found = getattr(math, name, inf)
    return found if isinstance(found, float) else inf


def _said(file: SourceFile, name: str, new: str) -> Iterator[Span]:
    """Where expressions of a file name a property, but for those in comments."""
    text = re.sub(rb"<!--.*?-->", lambda m: b" " * len(m[0]), file.data, flags=re.DOTALL)
    word = re.compile(rb"(?<![\w.'\"])" + name.encode() + rb"(?![\w('\"])")
    for expression in re.finditer(rb"\$\{[^}]*\}", text):
        for match in word.finditer(text, expression.start(), expression.end()):
            yield Span(file, match.start(), match.end(), new.encode())
