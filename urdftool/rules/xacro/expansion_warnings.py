"""Rules on warnings of the expansion."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...model.read import number
from ...source.comments import blank_comments
from ...source.description import Description
from ...source.document import Element
from ...source.location import Place, SourceFile
from ..fix import FixContext, Proposal, Span, remove_element, safe, set_attribute, unsafe
from ..rule import INFO, SAFE, UNSAFE, WARNING, Problem, rule
from .definitions import get_definitions

_ROUNDING = 1e-4
"""Difference of two numbers that are written alike. Chosen, no source."""

_GLOBAL = re.compile(r"redefining global symbol: (\w+)")
_ATTRIBUTE = re.compile(r"(\S+): unknown attribute\(s\): (.+)")
_DEPRECATED = re.compile(r"Using (\w+)\(\) directly is deprecated. Use ([\w.]+)\(\)")


def _match_warnings(
    description: Description, pattern: re.Pattern[str]
) -> Iterator[tuple[re.Match[str], Element, Place]]:
    """Yield the matches of a pattern in the warnings, once for each place."""
    if description.expansion is None:
        return
    root = description.document.root
    seen: set[tuple[str, str, int]] = set()
    for warned in description.expansion.warnings:
        match = pattern.search(warned.message)
        place = warned.place or root.place
        key = (match[0] if match else "", place.path, place.start)
        if match is None or key in seen:
            continue
        seen.add(key)
        yield match, root, place


@rule(WARNING, effects={"xacro": "warns, and uses the new value from there on"})
def shadowed_builtin(description: Description) -> Iterator[Problem]:
    """A property or parameter has the name of a built-in of xacro.

    ``pi``, ``e``, ``min``, ``len``, ``radians`` and the names of Python's ``math`` are available in
    every expression. A new definition replaces the built-in, also where ``${pi/2}`` means the
    number. If the value is the same, such as 3.14159 for ``pi``, or the name is a parameter, whose
    value ends with the macro, the finding is an info.
    """
    seen: set[tuple[str, str, int]] = set()
    for match, root, place in _match_warnings(description, _GLOBAL):
        parameter = _find_parameter(description, match[1], place)
        at = parameter or place
        key = (match[1], at.path, at.start)
        if key in seen:
            continue
        seen.add(key)
        if _is_the_constant(match[1], at):
            yield Problem(
                root,
                f"'{match[1]}' is a built-in name of xacro with this value; remove it",
                at=at,
                severity=INFO,
                data={"name": match[1]},
            )
        else:
            yield Problem(
                root,
                f"'{match[1]}' is a built-in name of xacro; rename it",
                at=at,
                severity=INFO if parameter is not None else None,
                data={"name": match[1]},
            )


def _is_the_constant(name: str, place: Place) -> bool:
    """Tell whether a property defines pi, e or tau with its correct value, to four digits."""
    value = getattr(math, name, None)
    span = place.file.locate_attributes(place.start).get("value")
    if not isinstance(value, float) or span is None:
        return False
    text = place.file.data[span[0] : span[1]].decode(place.file.encoding, "replace")
    try:
        written = float(text.partition("=")[2].strip().strip("\"'"))
    except ValueError:
        return False
    return abs(written - value) < _ROUNDING


def _find_parameter(description: Description, name: str, call: Place) -> Place | None:
    """Find the parameter of the macro that is called at a place; None for a property."""
    written = call.file.data[call.start : call.start + 200].decode(call.file.encoding, "replace")
    tag = re.match(r"<xacro:([\w.:-]+)", written)
    if tag is None or tag[1] in ("property", "arg"):
        return None
    called = re.search(r"\bmacro\s*=\s*[\"']([^\"']+)", written) if tag[1] == "call" else tag
    macro = called[1].rpartition(".")[2] if called is not None else ""
    for element in get_definitions(description).macros.get(macro, []):
        if re.search(rf"(?<![\w*]){re.escape(name)}(?!\w)", element.get("params") or ""):
            return element.locate_attribute("params")
    return None


@shadowed_builtin.fix(UNSAFE)
def rename_property(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove a property that equals the built-in value; rename a different one."""
    name = problem.data["name"]
    found = get_definitions(context.description)
    properties = found.properties.get(name, [])
    macros = [macro for same in found.macros.values() for macro in same]
    if len(properties) != 1 or any(
        re.search(rf"(?<!\w){re.escape(name)}(?!\w)", macro.get("params") or "") for macro in macros
    ):
        return None
    (element,), value = properties, number(properties[0].get("value"))
    if value is not None and math.isclose(value, _get_constant(name), rel_tol=1e-3):
        return unsafe(f"remove it, because xacro has '{name}'", remove_element(element))
    new = f"{name}_value"
    if any(new.encode() in file.data for file in context.description.files):
        return None
    spans = [
        span
        for file in context.description.files
        for span in _rename_in_expressions(file, name, new)
    ]
    return unsafe(f"rename it to '{new}'", set_attribute(element, "name", new), *spans)


def _get_constant(name: str) -> float:
    """Get the value of a built-in constant; infinity for other names."""
    found = getattr(math, name, math.inf)
    return found if isinstance(found, float) else math.inf


def _rename_in_expressions(file: SourceFile, name: str, new: str) -> Iterator[Span]:
    """Yield the edits of a property's name in expressions of a file, outside comments."""
    text = blank_comments(file.data)
    word = re.compile(rb"(?<![\w.'\"])" + name.encode() + rb"(?![\w('\"])")
    for expression in re.finditer(rb"\$\{[^}]{0,10000}\}", text):
        for match in word.finditer(text, expression.start(), expression.end()):
            yield Span(file, match.start(), match.end(), new.encode())


@rule(
    WARNING,
    effects={
        "xacro": "warns, and ignores it",
    },
)
def unknown_xacro_attribute(description: Description) -> Iterator[Problem]:
    """A xacro tag has an unknown attribute.

    xacro ignores it: a misspelled ``defualt`` leaves a property without a value.
    """
    for match, root, place in _match_warnings(description, _ATTRIBUTE):
        names = match[2].split(", ")
        at = place
        spans = place.file.locate_attributes(place.start)
        if names[0] in spans:
            at = Place(place.file, *spans[names[0]], place.calls)
        yield Problem(
            root, f"<{match[1]}> has the unknown attribute '{match[2]}', which xacro ignores", at=at
        )


@rule(WARNING, effects={"xacro": "warns at every expansion"})
def deprecated_global_function(description: Description) -> Iterator[Problem]:
    """A function has a deprecated name.

    ``load_yaml``, ``sorted`` and ``range`` are now in the namespaces ``xacro`` and ``python``. The
    old names still work, with a warning.
    """
    for match, root, place in _match_warnings(description, _DEPRECATED):
        message = f"{match[1]}() is deprecated; write {match[2]}()"
        data = {"name": match[1], "write": match[2]}
        yield Problem(root, message, at=place, data=data)


@deprecated_global_function.fix(SAFE)
def write_new_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the new name in the tag of the problem."""
    place = problem.place
    old, new = problem.data["name"].encode(), problem.data["write"].encode()
    data = place.file.data[place.start : place.end]
    calls = list(re.finditer(rb"(?<![\w.])" + old + rb"(?=\s*\()", data))
    spans = [
        Span(place.file, place.start + call.start(), place.start + call.end(), new)
        for call in calls
    ]
    return safe(f"write {new.decode()}()", *spans) if spans else None
