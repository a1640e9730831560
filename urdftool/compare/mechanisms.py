"""Differences of what plain URDF lacks: closed loops, actuators, frames, cameras, sensors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

from ..model.elements import Robot
from ..model.part import Origin, Part
from ..model.pose import make_pose
from ..model.settings import Value
from .difference import RENAMED, Difference, describe_change, describe_presence
from .links import collect_pose_values
from .rows import LOOPS
from .tolerance import is_same

Parts = dict[str, tuple[Part, dict[str, Any]]]
"""Parts with their values, by name."""

_REFERENCES = ("parent", "child", "link", "other", "joint")


def compare_mechanisms(
    a: Robot, b: Robot, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Difference]:
    """Yield the differences of parts that URDF lacks; their order is ignored."""
    in_blocks = a.xml is not None and b.xml is not None  # their elements are compared
    sides = list_parts_by_kind(a), list_parts_by_kind(b)
    for (kind, before), (_, after) in zip(*sides, strict=True):
        if not (in_blocks and kind in _IN_BLOCKS):
            one, two = _index_by_name(before, renamed), _index_by_name(after, {})
            yield from _compare_kind(kind, one, two, tolerance)


def _compare_kind(kind: str, one: Parts, two: Parts, tolerance: float) -> Iterator[Difference]:
    row = ROW_OF[kind]
    for old, name in [*_find_renamed(one, two)] if row == LOOPS else ():
        sides = one[old][0], two[name][0]
        yield describe_change(row, kind, name, RENAMED, (old, name), sides)
        one[name] = one.pop(old)
    for name in dict.fromkeys((*one, *two)):
        (x, before), (y, after) = one.get(name, (None, {})), two.get(name, (None, {}))
        if x is None or y is None:
            yield describe_presence(row, kind, name, (x, y))
            continue
        for key, value in after.items():
            if not is_same(before[key], value, tolerance):
                what, values = key.replace("_", " "), (before[key], value)
                data = _convert_to_data(values[0]), _convert_to_data(values[1])
                yield describe_change(row, kind, name, what, data, (x, y))


ROW_OF = {
    "closed loop": LOOPS,
    "frame": "frames",
    "joint actuator": "actuators",
    "contact exclusion": "contact pairs",
    "configuration": "configurations",
    "camera": "sensors",
    "mounted sensor": "sensors",
    "light": "sensors",
    "plugin": "plugins",
}
"""Row of each kind of part."""

_IN_BLOCKS = ("closed loop", "camera", "mounted sensor", "light", "plugin")


def list_parts_by_kind(robot: Robot) -> list[tuple[str, Sequence[Part]]]:
    """Return each kind and its parts, without the frames of links, which the links have."""
    frames = [frame for frame in robot.frames if frame.kind != "body"]
    parts: tuple[Sequence[Part], ...] = (
        *(robot.closures, frames, robot.joint_actuators, robot.exclusions),
        *(robot.configurations, robot.cameras, robot.mounted_sensors, robot.lights),
        robot.mounted_plugins,
    )
    return list(zip(ROW_OF, parts, strict=True))


def _index_by_name(parts: Iterable[Part], renamed: Mapping[str, str]) -> Parts:
    """Return each part and its values by name; parts without a name by their number."""
    found: Parts = {}
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


def _find_renamed(one: Parts, two: Parts) -> Iterator[tuple[str, str]]:
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


def _convert_to_data(value: Any) -> Any:
    """Return a value as data."""
    if isinstance(value, Origin):
        return collect_pose_values(make_pose(value))
    if isinstance(value, dict):
        return {key: _convert_to_data(one) for key, one in value.items()}
    return value.content if isinstance(value, Value) else value
