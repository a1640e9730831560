"""Comparison of what two files of one format have in addition: sensors, actuators, plugins."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..model.provenance import NOWHERE
from ..model.settings import JOINT_TAGS, LINK_TAGS
from .change import Change
from .difference import Comparison, Difference
from .extensions import compare_extensions
from .mechanisms import compare_mechanisms
from .pair import Pair

_BLOCKS = "simulator data"

_ROW_OF = {
    "camera": "sensors",
    "mounted sensor": "sensors",
    "joint actuator": "actuators",
    "contact exclusion": "contact pairs",
    "closed loop": "loops",
    "configuration": "configurations",
    **dict.fromkeys(("gazebo", "transmission", "ros2_control"), _BLOCKS),
}
"""Row of each kind of change; frames are in their own row."""

_TOLERANCE = 1e-6


def compare_equipment(pair: Pair, comparison: Comparison) -> None:
    """Compare sensors, actuators, loops, contact pairs and plugins of two files of one format."""
    rows = set(_ROW_OF.values()) & comparison.tolerances.keys()
    if pair.formats[0] != pair.formats[1]:
        comparison.skipped.update(dict.fromkeys(rows, "of two files of one format only"))
        return
    if pair.formats[0] == "urdf":  # its sensors and actuators are elements of blocks
        comparison.skipped.update(dict.fromkeys(rows - {_BLOCKS}, f"in the row of {_BLOCKS}"))
    elif _BLOCKS in rows:
        comparison.skipped[_BLOCKS] = "plugins are not read"
    for change in _list_changes(pair):
        if change.kind in _ROW_OF:
            comparison.add(_make_difference(_ROW_OF[change.kind], change))


def _list_changes(pair: Pair) -> Iterator[Change]:
    a, b = pair.a.robot, pair.b.robot
    renamed = {**pair.joints, **pair.links}
    yield from compare_mechanisms(a, b, _TOLERANCE, renamed)
    for change in compare_extensions(a, b, _TOLERANCE, renamed):
        if change.what.split("/")[0].split(" ")[0] not in LINK_TAGS | JOINT_TAGS:
            yield change  # the others are settings, which have rows of their own


def _make_difference(row: str, change: Change) -> Difference:
    values, places = (change.before, change.after), (NOWHERE, change.place or NOWHERE)
    if change.what.endswith("removed"):
        places = places[1], places[0]
    if change.what.endswith(("added", "removed")):
        values = ("none", "there") if change.what.endswith("added") else ("there", "none")
    names = (change.name or "of the robot",) * 2
    kind, what, unit = change.kind, change.what, change.unit
    return Difference(row, kind, names, what, values, unit, math.inf, places)
