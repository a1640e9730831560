"""Differences of friction, contact, springs and flags, unless two URDF write them in blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ..model.elements import Robot
from ..model.settings import (
    ALL_OF_JOINTS,
    ALL_OF_LINKS,
    ALL_SURFACE,
    Content,
    Setting,
    Value,
)
from .change import Change
from .tolerance import are_close, close

_Key = tuple[str, str, str]


def compare_settings(
    a: Robot, b: Robot, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    """Yield the differences of settings of parts that both robots have.

    Args:
        a: The first robot.
        b: The second robot.
        tolerance: Relative tolerance.
        renamed: New names of links and joints by their old names.
    """
    if a.xml is not None and b.xml is not None:
        return  # the elements of their blocks are compared
    one, two = _collect(a, renamed), _collect(b, {})
    for key in dict.fromkeys((*one, *two)):
        kind, name, what = key
        if name not in (b.link if kind == "link" else b.joint):
            continue
        (x, row), (y, other) = one.get(key, (None, None)), two.get(key, (None, None))
        setting = row or other
        assert setting is not None
        before, after = (_get_content(value, setting) for value in (x, y))
        if not _is_same(before, after, tolerance):
            place = (y or x or Value()).place
            yield Change(kind, name, what, before, after, setting.unit, place=place)


def _collect(robot: Robot, renamed: Mapping[str, str]) -> dict[_Key, tuple[Value, Setting]]:
    """Return values and rows by kind and name of the part, and name of the setting."""
    found: dict[_Key, tuple[Value, Setting]] = {}
    for link in robot.links:
        name = renamed.get(link.name, link.name)
        for row in ALL_OF_LINKS:
            if row.name in link.settings:
                found["link", name, _show(row)] = link.settings[row.name], row
        for number, shape in enumerate(link.collisions, 1):
            about = f"collision {shape.name or number}: "
            for row in ALL_SURFACE:
                if row.name in shape.surface:
                    found["link", name, about + _show(row)] = shape.surface[row.name], row
    for joint in robot.joints:
        name = renamed.get(joint.name, joint.name)
        for row in ALL_OF_JOINTS:
            if row.name in joint.settings:
                found["joint", name, _show(row)] = joint.settings[row.name], row
    return found


def _show(row: Setting) -> str:
    return row.name.replace("_", " ")


def _get_content(value: Value | None, row: Setting) -> Content:
    """Return a value; that which SDF has without it if it is not set."""
    return row.default if value is None else value.content


def _is_same(a: Content, b: Content, tolerance: float) -> bool:
    if isinstance(a, tuple) and isinstance(b, tuple):
        return are_close(a, b, tolerance)
    if isinstance(a, tuple | str) or isinstance(b, tuple | str):
        return a == b
    return close(float(a), float(b), tolerance)
