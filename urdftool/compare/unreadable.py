"""Values of a URDF that cannot be read or are missing, and elements that are there twice.

Readers disagree about them: urdfdom drops the element or the robot, PyBullet reads the number at
the beginning of a text, MuJoCo rejects the file. So two files are equal in them only if they have
the same text.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..model.elements import Robot
from ..model.link import COMPONENTS
from ..model.numbers import parse_numbers
from ..model.settings import LIMIT_NAMES, RESISTANCE_OF_URDF
from ..source.document import Element

_MASS = ("mass", "mass matrix", "gravity")
_INERTIA = ("inertia", "mass matrix")
_SHAPES = ("collisions", "visuals")


class _Kind(NamedTuple):
    """Element with numbers.

    Attributes:
        rows: Rows that it concerns.
        required: Attributes that it must have.
        texts: Attributes that are not numbers.
    """

    rows: tuple[str, ...]
    required: tuple[str, ...] = ()
    texts: tuple[str, ...] = ()


_KINDS = {
    "mass": _Kind(_MASS, ("value",)),
    "inertia": _Kind(_INERTIA, COMPONENTS),
    "axis": _Kind(("axes",)),
    "limit": _Kind(("limits",)),
    "dynamics": _Kind(("joint physics",)),
    "mimic": _Kind(("tree",), texts=("joint",)),
    "safety_controller": _Kind(("limits",)),
    "calibration": _Kind(("limits",)),
    "box": _Kind(_SHAPES, ("size",)),
    "sphere": _Kind(_SHAPES, ("radius",)),
    "cylinder": _Kind(_SHAPES, ("radius", "length")),
    "capsule": _Kind(_SHAPES, ("radius", "length")),
    "mesh": _Kind(_SHAPES, texts=("filename",)),
    "color": _Kind(("colors",), ("rgba",)),
    "inertial": _Kind((*_MASS, "center of mass", "inertia")),
    "geometry": _Kind(_SHAPES),
    "parent": _Kind(("tree",), texts=("link",)),
    "child": _Kind(("tree",), texts=("link",)),
    "link": _Kind(("tree", "frames", "mass", "inertia", *_SHAPES), texts=("name", "type")),
    "joint": _Kind(("tree", "frames", "axes", "limits"), texts=("name", "type")),
}
"""Elements of URDF; those without an attribute here count if they are there twice."""

_ORIGINS = {
    "inertial": ("center of mass", "mass matrix", "gravity"),
    "joint": ("frames",),
    "visual": ("visuals",),
    "collision": ("collisions",),
}
"""Rows of an ``<origin>`` by what it is in."""

_COUNTS = {"xyz": 3, "rpy": 3, "size": 3, "scale": 3, "rgba": 4}
"""Number of the numbers of an attribute, if not one."""

_SEVERAL = frozenset(("link", "joint", "visual", "collision"))
"""Elements that may be there several times, with other names or with none."""


class Unreadable(NamedTuple):
    """A value or an element that readers take in different ways."""

    rows: tuple[str, ...]
    name: str
    reason: str
    content: str


def list_unreadable(robot: Robot) -> Iterator[Unreadable]:
    """Yield the unreadable values and repeated elements of links and joints of a URDF."""
    names: set[tuple[str, str]] = set()
    for element in [] if robot.xml is None else robot.xml.children:
        if element.tag not in ("link", "joint", "material"):
            continue
        name = f"{element.tag} '{element.get('name') or ''}'"
        key = element.tag, element.get("name") or ""
        if key in names and element.tag != "material":
            yield _make_repeated(element, name)
        names.add(key)
        yield from _list_below(element, name)


def _list_below(element: Element, owner: str) -> Iterator[Unreadable]:
    seen: set[str] = set()
    for number, child in enumerate(element.children):
        is_second = child.tag in seen or (element.tag == "geometry" and number > 0)
        if is_second and child.tag not in _SEVERAL:
            rows = _get_rows(element, child)
            if rows:
                yield _make_repeated(child, f"<{child.tag}> of {owner}", rows)
        seen.add(child.tag)
        yield from _list_values(element, child, owner)
        yield from _list_below(child, owner)


def _make_repeated(element: Element, name: str, rows: tuple[str, ...] = ()) -> Unreadable:
    text = element.file.data[element.start : element.end].decode(errors="replace")
    return Unreadable(rows or _KINDS[element.tag].rows, name, "which is there twice", text)


def _get_rows(parent: Element, element: Element) -> tuple[str, ...]:
    if element.tag == "origin":
        return _ORIGINS.get(parent.tag, ())
    kind = _KINDS.get(element.tag)
    return () if kind is None else kind.rows


def _list_values(parent: Element, element: Element, owner: str) -> Iterator[Unreadable]:
    rows = _get_rows(parent, element)
    kind = _KINDS.get(element.tag, _Kind(rows))
    if not rows:
        return
    for name in dict.fromkeys((*kind.required, *element.attributes)):
        text = element.get(name)
        label = f"{name} of <{element.tag}> of {owner}"
        if text is None:
            yield Unreadable(rows, label, "which is missing", "")
        elif name not in kind.texts and ":" not in name and _is_unreadable(name, text):
            yield Unreadable(rows, f"{label}: '{text}'", "which readers take differently", text)


def _is_unreadable(name: str, text: str) -> bool:
    return name in _NUMBERS and parse_numbers(text, _COUNTS.get(name, 1)) is None


_NUMBERS = frozenset((
    *_COUNTS, *COMPONENTS,
    *("value", "radius", "length", *LIMIT_NAMES, "acceleration", "jerk"),
    *RESISTANCE_OF_URDF, *("deceleration", "multiplier", "offset", "soft_lower_limit"),
    *("soft_upper_limit", "k_position", "k_velocity", "rising", "falling", "reference_position"),
))  # fmt: skip
"""Attributes that are numbers; others are ignored by every reader."""
