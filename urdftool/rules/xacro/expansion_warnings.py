"""What xacro warns of while it expands."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...source.description import Description
from ...source.document import Element
from ...source.location import Place
from ..rule import INFO, WARNING, Problem, rule

_ROUNDING = 1e-4
_GLOBAL = re.compile(r"redefining global symbol: (\w+)")
_ATTRIBUTE = re.compile(r"(\S+): unknown attribute\(s\): (.+)")
_DEPRECATED = re.compile(r"Using (\w+)\(\) directly is deprecated. Use ([\w.]+)\(\)")


def _warned(
    description: Description, pattern: re.Pattern[str]
) -> Iterator[tuple[re.Match[str], Element, Place]]:
    """What a pattern finds in the warnings: once for each place."""
    if description.expansion is None:
        return
    root = description.document.root
    told: set[tuple[str, str, int]] = set()
    for warned in description.expansion.warnings:
        match = pattern.search(warned.message)
        place = warned.place or root.place
        key = (match[0] if match else "", place.path, place.start)
        if match is None or key in told:
            continue
        told.add(key)
        yield match, root, place


@rule(WARNING, effects={"xacro": "warns, and uses the new value from there on"})
def shadowed_builtin(description: Description) -> Iterator[Problem]:
    """A property or parameter has the name of something that xacro has itself.

    ``pi``, ``e``, ``min``, ``len``, ``radians`` and the rest of Python's ``math`` are there in
    every expression. One that is defined again is another thing from there on, also where
    ``${pi/2}`` means the number. ``pi`` defined as 3.14159 is pi, and no more than an info.
    """
    told: set[tuple[str, str, int]] = set()
    for match, root, place in _warned(description, _GLOBAL):
        at = _parameter(description, match[1], place) or place
        key = (match[1], at.path, at.start)
        if key in told:
            continue
        told.add(key)
        if _is_the_constant(match[1], at):
            yield Problem(
                root,
                f"'{match[1]}' is a name that xacro has itself, with this value; remove it",
                at=at,
                severity=INFO,
            )
        else:
            yield Problem(
                root, f"'{match[1]}' is a name that xacro has itself; choose another", at=at
            )


def _is_the_constant(name: str, place: Place) -> bool:
    """Whether a property defines pi, e or tau as what it is, to four digits."""
    value = getattr(math, name, None)
    span = place.file.attribute_spans(place.start).get("value")
    if not isinstance(value, float) or span is None:
        return False
    text = place.file.data[span[0] : span[1]].decode(place.file.encoding, "replace")
    try:
        written = float(text.partition("=")[2].strip().strip("\"'"))
    except ValueError:
        return False
    return abs(written - value) < _ROUNDING


def _parameter(description: Description, name: str, call: Place) -> Place | None:
    """The ``params`` with a name, of the macro that is called at a place; None for a property."""
    from .definitions import definitions

    written = call.file.data[call.start : call.start + 200].decode(call.file.encoding, "replace")
    tag = re.match(r"<xacro:([\w.:-]+)", written)
    if tag is None or tag[1] in ("property", "arg"):
        return None
    called = re.search(r"\bmacro\s*=\s*[\"']([^\"']+)", written) if tag[1] == "call" else tag
    macro = called[1].rpartition(".")[2] if called is not None else ""
    for element in definitions(description).macros.get(macro, []):
        if re.search(rf"(?<![\w*]){re.escape(name)}(?!\w)", element.get("params") or ""):
            return element.attribute_place("params")
    return None


@rule(
    WARNING,
    effects={
        "xacro": "warns, and ignores it",
    },
)
def unknown_xacro_attribute(description: Description) -> Iterator[Problem]:
    """A tag of xacro has an attribute that it does not know.

    It is passed over: a misspelt ``defualt`` leaves a property without a value.
    """
    for match, root, place in _warned(description, _ATTRIBUTE):
        names = match[2].split(", ")
        at = place
        spans = place.file.attribute_spans(place.start)
        if names[0] in spans:
            at = Place(place.file, *spans[names[0]], place.calls)
        yield Problem(root, f"<{match[1]}> has no attribute '{match[2]}'", at=at)


@rule(WARNING, effects={"xacro": "warns at every expansion"})
def deprecated_global_function(description: Description) -> Iterator[Problem]:
    """A function is called by its old name.

    ``load_yaml``, ``sorted`` and ``range`` have moved into ``xacro`` and ``python``; the old names
    still work, with a warning.
    """
    for match, root, place in _warned(description, _DEPRECATED):
        yield Problem(root, f"{match[1]}() is now called {match[2]}(); write that", at=place)
