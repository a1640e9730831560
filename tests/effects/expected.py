"""Whether what a reader did is what a row of the table expects of it.

An expectation maps paths of facts, such as ``joints.swing.upper`` or ``links.arm.visuals.#`` (how
many), to values: a number, within a millionth; a text; a list; ``"~part"``, which the text or one
of the lines must contain; ``"!~part"``, which it must not; ``"> 0.1"`` and ``"< 0.1"``; ``absent``.
``same as: good.urdf`` expects the facts, except messages, that the reader gives of another robot.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

ABSENT = "absent"
SAME_AS = "same as"
_NOT_COMPARED = ("messages", "sdf", "name")


def differences(facts: Mapping[str, Any], expected: Mapping[str, Any]) -> Iterator[str]:
    """What is not as expected, a line each; ``same as`` is left to :func:`unlike`."""
    for path, value in expected.items():
        if path == SAME_AS:
            continue
        found = value_at(facts, path)
        if not _is_as(found, value):
            yield f"{path}: {found!r} instead of {value!r}"


def unlike(facts: Mapping[str, Any], other: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """In what two robots differ, as one reader sees them."""
    for key in sorted({*facts, *other}):
        if not path and key in _NOT_COMPARED:
            continue
        here = f"{path}.{key}" if path else key
        one, two = facts.get(key, ABSENT), other.get(key, ABSENT)
        if isinstance(one, Mapping) and isinstance(two, Mapping):
            yield from unlike(one, two, here)
        elif not _is_as(one, two):
            yield f"{here}: {one!r} instead of {two!r}"


def value_at(facts: Any, path: str) -> Any:
    """The value at a path; ``absent`` where there is none."""
    if not path:
        return facts
    if isinstance(facts, Mapping):
        # names have dots: the longest key that the path begins with
        for key in sorted(facts, key=len, reverse=True):
            if path == key or path.startswith(f"{key}."):
                return value_at(facts[key], path[len(key) + 1 :])
        return ABSENT
    if isinstance(facts, list):
        first, _, rest = path.partition(".")
        if first == "#":
            return len(facts)
        if first.isdigit() and int(first) < len(facts):
            return value_at(facts[int(first)], rest)
    return ABSENT


def _is_as(found: Any, value: Any) -> bool:
    if isinstance(value, list):
        return (
            isinstance(found, list) and len(found) == len(value) and all(map(_is_as, found, value))
        )
    if isinstance(value, str):
        return _is_as_text(found, value)
    if isinstance(value, bool) or isinstance(found, bool) or value is None:
        return found is value
    if isinstance(value, (int, float)):
        return isinstance(found, (int, float)) and (
            found == value or math.isclose(found, value, rel_tol=1e-6, abs_tol=1e-12)
        )
    return bool(found == value)


def _is_as_text(found: Any, value: str) -> bool:
    if value.startswith(("~", "!~")):
        part = value.partition("~")[2]
        lines = found if isinstance(found, list) else [found]
        is_there = any(part in str(line) for line in lines)
        return is_there is not value.startswith("!")
    if value[:2] in ("> ", "< ") and isinstance(found, (int, float)):
        bound = float(value[2:])
        return found > bound if value[0] == ">" else found < bound
    if isinstance(found, float) and value in ("inf", "-inf", "nan"):
        return str(found) == value
    return bool(found == value)
