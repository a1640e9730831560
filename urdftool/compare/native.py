"""Differences of elements that only one format has, such as tendons, lights and copied settings."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest

from ..model.elements import Robot
from ..model.mechanism import NativeElement
from ..model.pose import Pose, rotation_from_rpy
from .change import Change
from .extensions import compare_elements
from .tolerance import is_same_pose

_Key = tuple[str, str, str]

_CLASSES = frozenset(("class",))
"""Attributes whose effect is in the values of an element."""


def compare_native(
    a: Robot, b: Robot, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Change]:
    """Yield the differences of elements that only the format of two robots has.

    Elements correspond by section, tag and name, and those without a name by their order. What
    another part of a robot holds is compared there.

    Args:
        a: The first robot.
        b: The second.
        tolerance: Tolerance as in ``tolerance.TOLERANCE``.
        renamed: New names of parts by their old names.
    """
    if a.format != b.format:
        return
    one, two = _group(a, renamed), _group(b, {})
    for key in dict.fromkeys((*one, *two)):
        for old, new in zip_longest(one.get(key, ()), two.get(key, ())):
            yield from _compare(key, old, new, tolerance, renamed)


def _group(robot: Robot, renamed: Mapping[str, str]) -> dict[_Key, list[NativeElement]]:
    """Return the elements by their section in the second robot, tag and name."""
    found: defaultdict[_Key, list[NativeElement]] = defaultdict(list)
    for element in robot.native:
        if element.section != "default":  # whose values are those of its elements
            kind, space, owner = element.section.partition(" ")
            section = kind + space + renamed.get(owner, owner)
            found[section, element.tag, element.name].append(element)
    return found


def _compare(
    key: _Key,
    old: NativeElement | None,
    new: NativeElement | None,
    tolerance: float,
    renamed: Mapping[str, str],
) -> Iterator[Change]:
    section, tag, name = key
    name = name or section.partition(" ")[2]
    kind = f"<{tag}>"
    if not section:  # attributes of a part that the robot has
        old, new = (one or NativeElement(None, "", tag, {"name": name}) for one in (old, new))
    if old is None or new is None:
        part = old or new
        if part is not None and part.held is None:
            what = "added" if old is None else "removed"
            yield Change(kind, name, what, place=part.place)
        return
    held = (old.held or frozenset()) | (new.held or frozenset())
    for change in compare_elements(kind, name, old, new, tolerance, renamed):
        if change.what.partition("/")[0].lstrip("@") not in held | _CLASSES:
            yield change
    if held:  # the values are those of the attributes
        return
    for what, value in old.values.items():
        other = new.values.get(what, ())
        if not _is_same(what, value, other, tolerance):
            yield Change(kind, name, what.replace("_", " "), value, other, place=new.place)


def _is_same(what: str, a: Sequence[float], b: Sequence[float], tolerance: float) -> bool:
    if len(a) != len(b):
        return False
    if what == "pose":
        return is_same_pose(_make_pose(a), _make_pose(b), tolerance)
    return all(
        abs(x - y) <= tolerance * max(abs(x), abs(y), 1.0) for x, y in zip(a, b, strict=True)
    )


def _make_pose(six: Sequence[float]) -> Pose:
    """Return the pose of a translation [m] and fixed-axis angles [rad]."""
    x, y, z, roll, pitch, yaw = six
    return Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))
