"""Comparison of what two files of one format have in addition: sensors, actuators, plugins."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace

from ..model.provenance import NOWHERE
from ..model.settings import JOINT_TAGS, LINK_TAGS
from .change import Change
from .difference import EXISTENCE, Comparison, Difference
from .extensions import BLOCKS, collect_tags, compare_extensions
from .loops import put_loops_into_bodies
from .mechanisms import compare_mechanisms, list_parts_by_kind
from .native import are_of_one_format, compare_native, list_in_bodies
from .pair import Pair
from .rows import NATIVE

_BLOCKS = "simulator data"
_LOOPS = "loops"

_ROW_OF = {
    "joint actuator": "actuators",
    "contact exclusion": "contact pairs",
    "closed loop": _LOOPS,
    "configuration": "configurations",
    "light": "sensors",
    **dict.fromkeys(("gazebo", "transmission", "ros2_control"), _BLOCKS),
}
"""Row of each kind of change; frames are in their own row."""

_TOLERANCE = 1e-6
"""Largest relative difference of equal numbers; chosen, no source."""

_WHY = {"simulator data": "only URDF has such blocks"}

_READ = LINK_TAGS | JOINT_TAGS | {"sensor"}
"""Elements in blocks whose values are compared in rows of their own."""

_READ_IN_GAZEBO = _READ | {"joint"}
"""Those in ``<gazebo>``, where a ``<joint>`` closes a loop."""


def compare_equipment(pair: Pair, comparison: Comparison) -> None:
    """Compare actuators, contact pairs, configurations and plugins of two files of one format.

    Of a URDF and an SDF, loops and what blocks have in addition are compared.
    """
    rows = [row for row in comparison.tolerances if row in (*_ROW_OF.values(), NATIVE)]
    a, b = pair.a.robot, pair.b.robot
    shared = are_of_one_format(a, b)
    if pair.formats[0] != pair.formats[1]:
        compared = ("actuators", "sensors", *((_LOOPS, NATIVE) if shared else ()))
        for row in rows:
            if row not in compared:
                comparison.skipped[row] = _WHY.get(row, "of two files of one format only")
        if shared:
            _compare_loops(pair, comparison)
            _compare_native(pair, comparison)
        return
    if pair.formats[0] == "urdf":  # its actuators are elements of blocks
        others = [row for row in rows if row not in (_BLOCKS, "sensors")]
        comparison.skipped.update(dict.fromkeys(others, f"in the row of {_BLOCKS}"))
    elif _BLOCKS in rows:
        comparison.skipped[_BLOCKS] = _WHY[_BLOCKS]
    _record_parts(pair, comparison)
    for change in _list_changes(pair):
        if change.kind in _ROW_OF and change.what != "renamed":
            comparison.add(_make_difference(_ROW_OF[change.kind], change))
    if shared:
        _compare_native(pair, comparison)


def _compare_native(pair: Pair, comparison: Comparison) -> None:
    comparison.record_parts(NATIVE, pair.a.robot.native, pair.b.robot.native)
    for change in compare_native(*list_in_bodies(pair), _TOLERANCE, _get_names(pair)):
        comparison.add(_make_difference(NATIVE, change))


def _compare_loops(pair: Pair, comparison: Comparison) -> None:
    robots = put_loops_into_bodies(pair)
    comparison.record_parts(_LOOPS, *(robot.closures for robot in robots))
    for change in compare_mechanisms(*robots, _TOLERANCE, _get_names(pair)):
        if change.kind == "closed loop" and change.what != "renamed":
            comparison.add(_make_difference(_LOOPS, replace(change, owner="")))


def _get_names(pair: Pair) -> dict[str, str]:
    """Return the names of parts in the second robot by those in the first."""
    return {**pair.parts, **pair.joints, **pair.links}


def _record_parts(pair: Pair, comparison: Comparison) -> None:
    """Record which rows compare something: the kinds of parts that a robot has."""
    for robot in (pair.a.robot, pair.b.robot):
        for kind, parts in list_parts_by_kind(robot):
            if kind in _ROW_OF:
                comparison.record_parts(_ROW_OF[kind], *parts)
        if robot.xml is not None:
            for tag in BLOCKS:
                comparison.record_parts(_BLOCKS, *robot.xml.list_children(tag))


def _list_changes(pair: Pair) -> Iterator[Change]:
    a, b = put_loops_into_bodies(pair)
    renamed = _get_names(pair)
    yield from compare_mechanisms(a, b, _TOLERANCE, renamed)
    for change in compare_extensions(a, b, _TOLERANCE, renamed):
        read = _READ_IN_GAZEBO if change.kind == "gazebo" else _READ
        if change.what in ("added", "removed"):
            one = change.what == "removed"
            tags = collect_tags(a if one else b, change, renamed if one else {})
            if not tags or tags - read:
                yield change
        elif re.split(r"[/ \[(]", change.what)[0] not in read:
            yield change


def _make_difference(row: str, change: Change) -> Difference:
    values, places = (change.before, change.after), (NOWHERE, change.place or NOWHERE)
    if change.what.endswith("removed"):
        values, places = ("there", None), (places[1], places[0])
    elif change.what.endswith("added"):
        values = (None, "there")
    what = EXISTENCE if change.what in ("added", "removed") else change.what
    names = (change.name, change.name)
    owners = () if change.owner is None else (change.owner,)
    return Difference(
        row, change.kind, names, what, values, change.unit, math.inf, places, owners=owners
    )
