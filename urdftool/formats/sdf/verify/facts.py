"""Elements of SDF and of ``<gazebo>`` blocks as facts: paths with comparable values."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping

from ....compare.check import Check
from ....source.document import Element

Value = str | tuple[float, ...]
Facts = dict[str, Value]

EXACT = 1e-9
WORDS = {"true": "1", "yes": "1", "false": "0", "no": "0"}


def get_value(text: str | None) -> Value:
    """Return numbers as a tuple, true and false as 1 and 0, and other text unchanged."""
    stripped = (text or "").strip()
    words = WORDS.get(stripped.lower(), stripped).split()
    try:
        found = tuple(float(word) for word in words)
    except ValueError:
        return " ".join(words)
    return found if all(map(math.isfinite, found)) else " ".join(words)


def get_facts(element: ET.Element | Element, *, without: Iterable[str] = ()) -> Facts:
    """Return the values of an element's leaves and attributes by path.

    Elements without content have no facts.

    Args:
        element: An element of the export or the source.
        without: Tags of children to skip.
    """
    facts: Facts = {}
    _collect(facts, element, "", frozenset(without))
    return facts


def _collect(
    facts: Facts, element: ET.Element | Element, path: str, without: frozenset[str]
) -> None:
    attributes = element.attributes if isinstance(element, Element) else element.attrib
    children = element.children if isinstance(element, Element) else list(element)
    for name, text in attributes.items():
        if path or name not in ("name", "type"):
            if not name.startswith("xmlns"):
                _put(facts, f"{path}@{_remove_namespace(name)}", get_value(text))
    kept = [child for child in children if isinstance(child.tag, str) and child.tag not in without]
    if path and not kept and (element.text or "").strip():
        _put(facts, path, get_value(element.text))
    for child in kept:
        inner = f"{path}/{_remove_namespace(child.tag)}" if path else _remove_namespace(child.tag)
        _collect(facts, child, inner, frozenset())


def _remove_namespace(tag: str) -> str:
    """Remove the namespace of a tag or attribute."""
    return re.sub(r"^(\{.*\}|\w+:)", "", tag)


def _put(facts: Facts, path: str, value: Value) -> None:
    """Set a value; later values at the same path get a number."""
    if path in facts:
        number = 2
        while f"{path}[{number}]" in facts:
            number += 1
        path = f"{path}[{number}]"
    facts[path] = value


def describe_differences(found: Mapping[str, Value], expected: Mapping[str, Value]) -> list[str]:
    """Describe the differences between facts."""
    texts = []
    for path in expected.keys() | found.keys():
        one, other = found.get(path), expected.get(path)
        if one is None:
            texts.append(f"{path} is missing, {format_value(other)} expected")
        elif other is None:
            texts.append(f"{path} is {format_value(one)}, which is not in the description")
        elif not is_equal(one, other):
            texts.append(f"{path} is {format_value(one)}, not {format_value(other)}")
    return sorted(texts)


def is_equal(one: Value, other: Value) -> bool:
    """Tell whether two values are equal; numbers up to rounding."""
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    if len(one) != len(other):
        return False
    return all(abs(a - b) <= EXACT * max(1.0, abs(a)) for a, b in zip(one, other, strict=True))


def format_value(value: Value | None) -> str:
    """Format a value."""
    if isinstance(value, tuple):
        return " ".join(f"{part:.9g}" for part in value)
    return f"'{value}'"


def compare_facts(
    check: Check,
    about: str,
    found: Mapping[str, Value],
    expected: Mapping[str, Value],
    *,
    known: bool = False,
) -> None:
    """Record each difference between facts in a row."""
    for text in describe_differences(found, expected):
        (check.announced if known else check.differing).append(f"{about}: {text}")
