"""Differences of elements that only one format has, such as tendons, lights and copied settings."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import zip_longest

import numpy as np

from ..mechanics.reference import Array
from ..model.elements import Robot
from ..model.mechanism import NativeElement
from ..model.pose import Pose, rotation_from_rpy, rpy_from_rotation
from .bodies import Bodies
from .difference import Difference, describe_change, describe_presence
from .extensions import compare_elements
from .frames import describe_pose, make_matrix
from .pair import Pair
from .rows import NATIVE
from .tolerance import is_same_pose

_Key = tuple[str, str, str]

_MOST = 200
"""Largest number of elements without a name whose order does not matter. Chosen, for time."""

_CLASSES = frozenset(("class",))
"""Attributes whose effect is in the values of an element."""


def compare_native(
    a: Iterable[NativeElement],
    b: Iterable[NativeElement],
    tolerance: float,
    renamed: Mapping[str, str],
) -> Iterator[Difference]:
    """Yield the differences of elements that only the format of two robots has.

    Elements correspond by section, tag and name, and those without a name by their order. What
    another part of a robot holds is compared there.
    """
    one, two = _group(a, renamed), _group(b, {})
    for key in dict.fromkeys((*one, *two)):
        compare = partial(_list_changes, key, tolerance=tolerance, renamed=renamed)
        for old, new in _pair_elements(one.get(key, []), two.get(key, []), compare):
            for difference in compare(old, new):
                yield replace(difference, owners=(key[0].partition(" ")[2],))


def are_of_one_format(a: Robot, b: Robot) -> bool:
    """Tell whether two robots have elements of one format, which can be compared.

    The elements of ``<gazebo>`` blocks of a URDF are those of SDF. Blocks of two URDF are compared
    as they are written.
    """
    one, two = (robot.format for robot in (a, b))
    return one == two != "urdf" or {one, two} == {"urdf", "sdf"}


def list_in_bodies(pair: Pair) -> tuple[list[NativeElement], list[NativeElement]]:
    """Return the elements of both robots, those of links in the rigid bodies of the first robot.

    Their poses are in the frames of these bodies; links of a body may differ in the two files.
    """
    frames = {two: (one, frame) for one, (two, frame) in pair.frames.items()}
    own = {one: (one, np.eye(4)) for one in pair.a.by_name}
    one = [_put_into_body(e, pair.a, own) for e in pair.a.robot.native]
    return one, [_put_into_body(e, pair.b, frames) for e in pair.b.robot.native]


def _put_into_body(
    element: NativeElement, bodies: Bodies, frames: Mapping[str, tuple[str, Array]]
) -> NativeElement:
    """Return an element of a link as one of its body.

    Args:
        element: The element.
        bodies: Bodies of its robot.
        frames: Name and pose of each body in the first robot.
    """
    kind, _, link = element.section.partition(" ")
    body = bodies.body_of.get(link, "") if kind == "link" else ""
    if body not in frames:
        return element
    name, frame = frames[body]
    values = dict(element.values)
    if "pose" in values:
        inner = make_matrix(_make_pose(values["pose"]))
        pose: Array = frame @ bodies.by_name[body].members[link] @ inner
        x, y, z = pose[:3, 3].tolist()
        values["pose"] = (x, y, z, *rpy_from_rotation(pose[:3, :3].tolist()))
    return replace(element, section=f"body {name}", values=values)


def _group(
    elements: Iterable[NativeElement], renamed: Mapping[str, str]
) -> dict[_Key, list[NativeElement]]:
    """Return the elements by their section in the second robot, tag and name."""
    found: defaultdict[_Key, list[NativeElement]] = defaultdict(list)
    for element in elements:
        if element.section != "default":  # whose values are those of its elements
            kind, space, owner = element.section.partition(" ")
            owner = owner if kind == "body" else renamed.get(owner, owner)
            section = kind + space + owner
            found[section, element.tag, element.name].append(element)
    return found


_Compare = Callable[[NativeElement | None, NativeElement | None], list[Difference]]


def _pair_elements(
    one: list[NativeElement], two: list[NativeElement], compare: _Compare
) -> Iterator[tuple[NativeElement | None, NativeElement | None]]:
    """Yield the elements of both robots that correspond: equal ones, then by their order."""
    left, right = list(one), list(two)
    for old in one if 1 < max(len(one), len(two)) <= _MOST else ():
        equal = next((new for new in right if not compare(old, new)), None)
        if equal is not None:
            left = [other for other in left if other is not old]
            right = [other for other in right if other is not equal]
    yield from zip_longest(left, right)


def _list_changes(
    key: _Key,
    old: NativeElement | None,
    new: NativeElement | None,
    *,
    tolerance: float,
    renamed: Mapping[str, str],
) -> list[Difference]:
    return list(_compare(key, old, new, tolerance, renamed))


def _compare(
    key: _Key,
    old: NativeElement | None,
    new: NativeElement | None,
    tolerance: float,
    renamed: Mapping[str, str],
) -> Iterator[Difference]:
    section, tag, name = key
    name = name or section.partition(" ")[2]
    is_xml = all(one is None or one.is_xml for one in (old, new))
    kind = f"<{tag}>" if is_xml else tag
    if not section:  # attributes of a part that the robot has
        old, new = (one or NativeElement(None, "", tag, {"name": name}) for one in (old, new))
    if old is None or new is None:
        part = old or new
        if part is not None and part.held is None:
            yield describe_presence(NATIVE, kind, name, (old, new))
        return
    held = (old.held or frozenset()) & (new.held or frozenset())
    is_named = False
    for change in compare_elements(NATIVE, kind, name, (old, new), tolerance, renamed):
        if change.what.partition("/")[0].lstrip("@") not in held | _CLASSES:
            is_named = True
            yield change if is_xml else replace(change, what=change.what.lstrip("@"))
    if held and is_named:  # the values are those of the attributes
        return
    for what in _list_values(old, new):
        value, other = old.values.get(what, ()), new.values.get(what, ())
        if not _is_same(what, value, other, tolerance):
            shown = _show(what, value), _show(what, other)
            yield describe_change(NATIVE, kind, name, what.replace("_", " "), shown, (old, new))


def _list_values(old: NativeElement, new: NativeElement) -> list[str]:
    """Return the names of values of two elements, of both if only one of them is held elsewhere."""
    names = dict.fromkeys((*old.values, *new.values))
    if (old.held is None) == (new.held is None):
        return list(names)
    return [name for name in names if name in old.values and name in new.values]


def _show(what: str, value: Sequence[float]) -> object:
    """Return values as text or data."""
    return describe_pose(make_matrix(_make_pose(value))) if what == "pose" and value else value


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
