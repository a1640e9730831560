"""What a reader did not read of the parts that a row compares."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ..diagnostic import Severity
from ..model.elements import Robot, UnknownShape
from .difference import Comparison
from .pair import Pair
from .rows import LOOPS, NATIVE
from .uncompared import UNREAD, Uncompared
from .unreadable import list_unreadable


class _Row(NamedTuple):
    """Rows that a kind of unread parts concerns.

    Attributes:
        names: The rows.
        section: Section of MJCF whose elements are compared as they are written, and these parts
            with them; ``*`` for parts that two files of one format always have as elements.
    """

    names: tuple[str, ...]
    section: str = ""


_ACTUATORS = _Row(("actuators",), "actuator")
_TENDONS = _Row((NATIVE,), "tendon")
_EQUALITIES = _Row((NATIVE,), "equality")
_ELEMENTS = _Row((NATIVE,), "*")
_OTHERS = _Row((NATIVE,))
_SHAPES = _Row(("collisions", "visuals"))
_TREE = _Row(("tree",))

_ROWS = {
    "activation": _ACTUATORS,
    "actuator": _ACTUATORS,
    "gain": _ACTUATORS,
    "coupling": _Row(("tree",), "equality"),
    "equality-tendon": _EQUALITIES,
    "equality-flex": _EQUALITIES,
    "equality-flexvert": _EQUALITIES,
    "tendon": _TENDONS,
    "contact-pair": _Row(("contact pairs",), "contact"),
    "paired-scenery": _Row(("contact pairs",)),
    "sensor": _Row(("sensors",), "sensor"),
    "world-site": _Row(("actuators", "sensors", NATIVE)),
    "camera-mode": _Row(("sensors",), "*"),
    "setting": _ELEMENTS,
    "element": _ELEMENTS,
    "mocap": _Row(("base",), "*"),
    "created": _OTHERS,
    "attribute": _OTHERS,
    "display-attribute": _OTHERS,
    "plugin": _OTHERS,
    "contradiction": _OTHERS,
    "nested-plugin": _Row(("plugins",)),
    "flex": _SHAPES,
    "shape": _SHAPES,
    "skin": _Row(("visuals",)),
    "approximation": _Row(("collisions",)),
    "hidden-geom": _Row(("visuals",)),
    "force-range": _Row(("limits",)),
    "base-dynamics": _Row(("joint physics",)),
    "damping": _Row(("joint physics",)),
    "spring": _Row(("joint physics",)),
    "discarded-visual": _Row(("visuals", "colors", "textures")),
    "material-script": _Row(("colors", "textures")),
    "texture": _Row(("textures",)),
    "made-texture": _Row(("textures",)),
    "look": _Row(("looks",)),
    "friction": _Row(("surface",)),
    "collision-group": _Row(("contact pairs",)),
    "self-collision": _Row(("link flags",)),
    "self-collide": _Row(("link flags",)),
    "kinematic": _Row(("base", "link flags")),
    "world": _Row(("base",)),
    "added-mass": _Row(("inertia", "mass matrix")),
    "auto-inertia": _Row(("mass", "center of mass", "inertia", "mass matrix", "gravity")),
    "inertial": _Row(("inertia",)),
    "mass": _Row(("mass", "mass matrix", "gravity")),
    "center-of-mass": _Row(("center of mass", "mass matrix", "gravity")),
    "inertia": _Row(("inertia", "mass matrix")),
    "gearbox": _TREE,
    "gripper": _TREE,
    "mimic": _TREE,
    "mimic-offset": _TREE,
    "joint": _TREE,
    "joint-type": _TREE,
    "joint-body": _TREE,
    "joint-apart": _Row(("tree", "frames")),
    "drive-type": _Row(("actuators", "limits")),
    "disabled-joint": _Row((LOOPS,)),
}
"""Rows by the code of a loss of reading, after ``unread-``; shapes that are not read and images
are recorded where they are compared.
"""

NO_ROW = frozenset((
    *("anchor", "articulation", "body", "camera", "custom", "display"),
    *("end-tag", "keyframe", "light", "mesh", "mesh-scale", "missing-model", "model"),
    *("not-well-formed", "scenery", "submesh", "units", "up-axis", "variant", "version", "warning"),
    *("hfield", "plane", "sdf"),
))  # fmt: skip
"""Codes of what is around a robot, of how a file is read, of what is compared as it is written in
two files of one format and moves nothing, and of shapes and images.
"""

_OF_ONE_FORMAT = frozenset(("display-attribute",))
"""Codes of what only two files of one format have; it moves nothing."""

_SHAPE = "shape-"
"""Beginning of the codes of shapes of SDF."""

_AROUND = {"sdf": frozenset(("world",)), "usd": frozenset(("setting",))}
"""Further such codes by format: elements of a world; solvers, and states at the start."""

_PLUGINS_IN_ROW = "sdf"
"""Format whose plugins have a row of their own."""


def compare_unread(pair: Pair, comparison: Comparison) -> None:
    """Record which rows of a comparison concern parts that a reader did not read."""
    has_elements = any(row.name == NATIVE for row in comparison.rows)
    for part in list_unread(pair.a.robot, pair.b.robot, has_elements=has_elements):
        comparison.record_uncompared(part)


def list_unread(a: Robot, b: Robot, *, has_elements: bool = True) -> Iterator[Uncompared]:
    """Yield the parts that a reader did not read, unless both files have them in equal words.

    Nothing is yielded for what is compared as the elements of one format, if ``has_elements`` says
    that these are compared.
    """
    if is_one_text(a, b):
        return
    yield from _list_unreadable(a, b)
    sides = [_collect(one, two, has_elements=has_elements) for one, two in ((a, b), (b, a))]
    for code in dict.fromkeys((*sides[0], *sides[1])):
        one, two = (side.get(code, Counter()) for side in sides)
        is_known = a.format == b.format and all(text is not None for _, _, text in (*one, *two))
        if code in _OF_ONE_FORMAT and a.format != b.format:
            continue
        left = (one - two) + (two - one) if is_known else one + two
        for name, reason, _ in left:
            for row in _ROWS.get(code, _OTHERS).names:
                yield Uncompared(row, UNREAD, name, reason)


def _list_unreadable(a: Robot, b: Robot) -> Iterator[Uncompared]:
    """Yield values of URDF that readers take differently, unless both have them in equal words."""
    one, two = (Counter(list_unreadable(robot)) for robot in (a, b))
    left = (one - two) + (two - one) if a.format == b.format else one + two
    for part in left:
        for row in part.rows:
            yield Uncompared(row, UNREAD, part.name, part.reason)


def list_unseen(a: Robot, b: Robot) -> Iterator[Uncompared]:
    """Yield the parts that a reader did not read, with shapes of which nothing is known."""
    yield from list_unread(a, b)
    if is_one_text(a, b):
        return
    for robot in (a, b):
        for link, shape in robot.shapes:
            geometry = shape.geometry
            if isinstance(geometry, UnknownShape) and geometry.content is None:
                name = f"<{geometry.tag}> of link '{link.name}'"
                yield Uncompared("collisions", UNREAD, name, "what it contains is not read")


_Part = tuple[str, str, str | None]
"""Name of an unread part, why it is not read, and what is written of it; None if unknown."""


def _collect(robot: Robot, other: Robot, *, has_elements: bool) -> dict[str, Counter[_Part]]:
    """Return the unread parts of a robot by the code of their loss."""
    found: dict[str, Counter[_Part]] = {}
    for loss in robot.unread:
        code = loss.code.removeprefix("unread-")
        row = _find_row(robot, code, loss.severity)
        if row is not None and not (has_elements and _is_compared_natively(row, robot, other)):
            if (code, robot.format) != ("plugin", _PLUGINS_IN_ROW):
                found[code] = Counter(_list_parts(loss.data, loss.name, loss.message))
    return found


def _find_row(robot: Robot, code: str, severity: Severity) -> _Row | None:
    """Return the rows of an unread part; those of a code without some if it may move the robot."""
    around = NO_ROW | _AROUND.get(robot.format, frozenset())
    if (
        code in around
        or code.startswith(_SHAPE)
        or (code not in _ROWS and severity < Severity.WARNING)
    ):
        return None
    return _ROWS.get(code, _OTHERS)


def _list_parts(data: Mapping[str, Any], name: str, message: str) -> Iterator[_Part]:
    """Yield the parts in the data of a loss of reading; a remark on a value is one part."""
    if "names" not in data:
        yield name or "without a name", message, None
        return
    for name, content in zip(data["names"], data["contents"], strict=True):
        yield name or "without a name", data["what"], content


def _is_compared_natively(row: _Row, robot: Robot, other: Robot) -> bool:
    """Tell whether two robots of one format have the elements of a row as they are written."""
    if robot.format != other.format or not row.section:
        return False
    return row.section == "*" or any(element.section == row.section for element in robot.native)


def is_one_text(a: Robot, b: Robot) -> bool:
    """Tell whether two robots are read from equal files in one folder, with equal arguments."""
    if a.source is None or b.source is None or a.source.arguments != b.source.arguments:
        return False
    one, two = (
        [(os.path.dirname(os.path.realpath(file.path)), file.data) for file in robot.source.files]
        for robot in (a, b)
        if robot.source is not None
    )
    return one == two
