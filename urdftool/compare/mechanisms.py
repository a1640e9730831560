"""Differences of what plain URDF lacks: closed loops, actuators, frames, cameras, sensors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

from ..model.elements import Robot
from ..model.part import Origin, Part
from ..model.pose import make_pose
from ..model.settings import Value
from .change import Change
from .links import describe_pose
from .tolerance import are_close, close, is_same_pose

_REFERENCES = ("parent", "child", "link", "other", "joint")


def compare_mechanisms(
    a: Robot, b: Robot, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    """Yield the differences of parts that URDF lacks; their order is ignored.

    Args:
        a: The first robot.
        b: The second.
        tolerance: Tolerance as in ``closeness.TOLERANCE``.
        renamed: New names of links and joints by their old names.
    """
    in_blocks = a.xml is not None and b.xml is not None  # their elements are compared
    sides = list_parts_by_kind(a), list_parts_by_kind(b)
    for (kind, before), (_, after) in zip(*sides, strict=True):
        if in_blocks and kind in _IN_BLOCKS:
            continue
        one, two = _index_by_name(before, renamed), _index_by_name(after, {})
        for old_name, name in [*_find_renamed(one, two)] if kind == _LOOP else ():
            yield Change(kind, name, "renamed", old_name, name, place=two[name][0].place)
            one[name] = one.pop(old_name)
        for name in dict.fromkeys((*one, *two)):
            old, new = one.get(name), two.get(name)
            if old is None or new is None:
                part = old or new
                what = "added" if old is None else "removed"
                yield Change(kind, name, what, place=part[0].place if part else None)
                continue
            for field, value in new[1].items():
                if not _is_same(old[1][field], value, tolerance):
                    what, before_it = field.replace("_", " "), _convert_to_data(old[1][field])
                    yield Change(
                        kind, name, what, before_it, _convert_to_data(value), place=new[0].place
                    )


_LOOP = "closed loop"

_KINDS = (
    *(_LOOP, "frame", "joint actuator", "contact exclusion", "configuration", "camera"),
    *("mounted sensor", "light", "plugin"),
)

_IN_BLOCKS = (_LOOP, "camera", "mounted sensor", "light", "plugin")


def list_parts_by_kind(robot: Robot) -> list[tuple[str, Sequence[Part]]]:
    """Return each kind and its parts, without the frames of links, which the links have."""
    frames = [frame for frame in robot.frames if frame.kind != "body"]
    parts: tuple[Sequence[Part], ...] = (
        *(robot.closures, frames, robot.joint_actuators, robot.exclusions),
        *(robot.configurations, robot.cameras, robot.mounted_sensors, robot.lights),
        robot.mounted_plugins,
    )
    return list(zip(_KINDS, parts, strict=True))


def _index_by_name(
    parts: Iterable[Part], renamed: Mapping[str, str]
) -> dict[str, tuple[Part, dict[str, Any]]]:
    """Return each part and its values by name; parts without a name by their number."""
    found: dict[str, tuple[Part, dict[str, Any]]] = {}
    for number, part in enumerate(parts, 1):
        values = {
            field.name: getattr(part, field.name)
            for field in fields(part)
            if field.name not in ("provenance", "name")
        }
        if values.get("damping_ratio") is not None:  # of which MuJoCo computes the damping
            values["bias"] = (*values["bias"][:2], 0.0)
        for key in _REFERENCES:
            if key in values:
                values[key] = renamed.get(values[key], values[key])
        if "positions" in values:
            values["positions"] = {renamed.get(k, k): v for k, v in values["positions"].items()}
        name = getattr(part, "name", "") or _name_by_references(values, number)
        found.setdefault(name, (part, values))
    return found


def _find_renamed(
    one: Mapping[str, tuple[Part, dict[str, Any]]], two: Mapping[str, tuple[Part, dict[str, Any]]]
) -> Iterator[tuple[str, str]]:
    """Yield both names of the loops that only have other names: they connect the same links."""
    left = [name for name in two if name not in one]
    for old in [name for name in one if name not in two]:
        ends = _list_ends(one[old][1])
        new = next((name for name in left if _list_ends(two[name][1]) == ends), None)
        if new is not None:
            left.remove(new)
            yield old, new


def _list_ends(values: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(str(values[key]) for key in _REFERENCES if key in values)


def _name_by_references(values: Mapping[str, Any], number: int) -> str:
    """Return the parts that a part without a name concerns, or its number."""
    return " – ".join(str(values[key]) for key in _REFERENCES if values.get(key)) or str(number)


def _is_same(a: Any, b: Any, tolerance: float) -> bool:
    if isinstance(a, Origin) or isinstance(b, Origin):
        return is_same_pose(make_pose(a), make_pose(b), tolerance)
    if isinstance(a, Value) and isinstance(b, Value):
        return _is_same(a.content, b.content, tolerance)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_is_same(a[key], b[key], tolerance) for key in a)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and are_close(a, b, tolerance)
    if isinstance(a, float) and isinstance(b, float):
        return close(a, b, tolerance)
    return bool(a == b)


def _convert_to_data(value: Any) -> Any:
    """Return a value as data."""
    if isinstance(value, Origin):
        return describe_pose(make_pose(value))
    if isinstance(value, dict):
        return {key: _convert_to_data(one) for key, one in value.items()}
    return value.content if isinstance(value, Value) else value
