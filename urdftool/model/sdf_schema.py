"""The elements of SDF with their children, attributes and types of values.

``sdf_schema.json`` has them by name of the parent, because elements with the same name have similar
children in all places; names of elements outside of models that models use, too, begin with
``world/``. ``@`` begins the name of an attribute. A value is described by its type in SDFormat,
``LEAST:MOST`` if it has bounds, and ``required`` if it may not be empty. ``old`` precedes what SDF
1.9 no longer has, and libsdformat copies unread. ``python -m measure.libsdformat.schema`` writes
the file.

What libsdformat does with other values was run with sdformat 12.3: it rejects the whole file.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from ..source.document import Element
from .numbers import number, parse_numbers

_LEADING = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+|inf|nan)", re.IGNORECASE)
"""A number at the beginning of a text, as C++ reads it: libsdformat ignores what follows."""

_LEADING_WHOLE = re.compile(r"[-+]?\d+")

_WORDS = {
    ("force_torque", "frame"): ("parent", "child", "sensor"),
    ("force_torque", "measure_direction"): ("parent_to_child", "child_to_parent"),
}
"""Allowed words of elements, by parent tag and tag; libsdformat takes the default for others."""

KINDS = {
    "double": "number",
    "float": "number",
    "int": "count",
    "unsigned-int": "count",
    "bool": "flag",
    "vector3": "vector",
    "color": "color",
    "string": "text",
}
"""Kinds of the types of SDFormat."""

_LENGTHS = {"vector2d": 2, "vector2i": 2, "vector3": 3, "quaternion": 4}
_COUNTS = {2: "two", 3: "three", 4: "four", 6: "six", 7: "seven"}
_FLAGS = frozenset(("true", "false", "1", "0"))


class Requirement(NamedTuple):
    """What a value has to be, and is not.

    Attributes:
        text: Such as ``a finite number``.
        effect: What libsdformat does: ``reject`` the file, read the ``beginning`` of the value, or
            take the ``default`` in its place.
    """

    text: str
    effect: str = "reject"


class _Value(NamedTuple):
    """The schema of a value: type, bounds, whether it may not be empty, and is old."""

    kind: str
    bounds: str
    is_needed: bool
    is_old: bool


@cache
def _load() -> dict[str, dict[str, str]]:
    text = Path(__file__).with_suffix(".json").read_text("utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


def get_children(tag: str, *, newest: bool = False) -> frozenset[str] | None:
    """Return the children that an element of a model may have; None if it is not known.

    Args:
        tag: Its tag.
        newest: Leave out those that only versions before SDF 1.9 have.
    """
    known = _load().get(tag)
    if known is None:
        return None
    return frozenset(
        name
        for name, described in known.items()
        if not name.startswith("@") and not (newest and described.startswith("old"))
    )


def get_value_type(parent: str, tag: str) -> str:
    """Return the type of the value of an element; empty for none."""
    return _describe(parent, tag).kind


def get_bounds(parent: str, tag: str) -> tuple[float, float]:
    """Return the smallest and largest value of an element; infinite for none."""
    return _parse_bounds(_describe(parent, tag).bounds)


def _parse_bounds(text: str) -> tuple[float, float]:
    least, _, most = text.partition(":")
    return (float(least), float(most)) if text else (-math.inf, math.inf)


def describe_bounds(least: float, most: float) -> str:
    """Describe bounds of a number, in words that follow it; empty without any."""
    if math.isinf(most):
        return "" if math.isinf(least) else f" of at least {least:g}"
    return f" from {least:g} to {most:g}"


def describe_kind(kind: str) -> str:
    """Describe the values of a kind."""
    return {
        "number": "a finite number",
        "count": "a whole number",
        "vector": "three finite numbers",
        "list": "finite numbers",
        "color": "three or four finite numbers from 0 to 1",
        "flag": "true or false",
        "text": "a text",
    }[kind]


def walk_values(parent: str, element: Element) -> Iterator[tuple[str, Element]]:
    """Yield an element and all below it in document order, each after the tag that holds it.

    Parameters of plugins have no type, and are left out.
    """
    todo = [(parent, element)]
    while todo:
        parent, element = todo.pop()
        if element.tag != "plugin":
            yield parent, element
            todo += [(element.tag, child) for child in reversed(element.children)]


def find_requirement(parent: str, element: Element) -> Requirement | None:
    """Return what the content of an element has to be; None if it is valid or not known."""
    value = _describe(parent, element.tag)
    if not value.kind or element.children:
        return None
    text = element.text.strip()
    allowed = _WORDS.get((parent, element.tag), ())
    if allowed and text not in allowed:
        return Requirement(" or ".join(allowed), "default")
    if not text:
        return Requirement("a value") if value.is_needed else None
    if value.kind == "pose":
        count = 7 if element.get("rotation_format") == "quat_xyzw" else 6
        needed = Requirement(f"{_COUNTS[count]} finite numbers")
        return needed if parse_numbers(text, count) is None else None
    required = _find_requirement(value.kind, value.bounds, text)
    return required._replace(effect="default") if required and value.is_old else required


def find_requirement_of_attribute(element: Element, name: str) -> Requirement | None:
    """Return what the value of an attribute has to be; None if it is valid or not known."""
    value = _describe(element.tag, f"@{name}")
    text = (element.get(name) or "").strip()
    return _find_requirement(value.kind, value.bounds, text) if text else None


def _describe(parent: str, name: str) -> _Value:
    schema = _load()
    described = schema.get(parent, {}).get(name)
    if described is None:
        described = schema.get(f"world/{parent}", {}).get(name, "")
    words = described.removeprefix("old").split()
    bounds = next((word for word in words if ":" in word), "")
    is_old = described.startswith("old")
    return _Value((words or [""])[0], bounds, "required" in words and not is_old, is_old)


def _find_requirement(kind: str, bounds: str, text: str) -> Requirement | None:
    words = text.split()
    if kind == "bool":
        return None if text.lower() in _FLAGS else Requirement(describe_kind("flag"))
    if kind == "color":
        return None if _is_color(text) else Requirement(describe_kind("color"))
    if kind in _LENGTHS:
        count = _LENGTHS[kind]
        if parse_numbers(" ".join(words[:count]), count) is None:
            return Requirement(f"{_COUNTS[count]} finite numbers")
        if len(words) != count:
            return Requirement(f"{_COUNTS[count]} finite numbers", "beginning")
        return None
    if kind in ("double", "float", "int", "unsigned-int"):
        return _find_requirement_of_number(kind, bounds, text)
    return None


def _find_requirement_of_number(kind: str, bounds: str, text: str) -> Requirement | None:
    text = {"true": "1", "false": "0"}.get(text.lower(), text)  # as libsdformat does
    is_whole = kind.endswith("int")
    what = describe_kind(KINDS[kind])
    if not (_LEADING_WHOLE if is_whole else _LEADING).match(text):
        return Requirement(what)
    value = number(text)
    if value is None:
        is_infinite = text.lower().lstrip("+-") in ("inf", "infinity") and not is_whole
        return None if is_infinite else Requirement(what, "beginning")
    least, most = _parse_bounds(bounds)
    return None if least <= value <= most else Requirement(what + describe_bounds(least, most))


def _is_color(text: str) -> bool:
    values = parse_numbers(text, 3) or parse_numbers(text, 4)
    return values is not None and all(0 <= value <= 1 for value in values)
