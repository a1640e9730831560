"""Comparison of what two files of one format have in addition: sensors, actuators, plugins."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from ..mechanics.reference import Array, get_origin_matrix
from ..model.elements import Link, Robot
from ..model.mechanism import Closure
from ..model.settings import JOINT_TAGS, LINK_TAGS, SURFACE
from .bodies import Bodies
from .difference import EXISTENCE, RENAMED, Comparison, Difference
from .extensions import compare_extensions, list_block_tags, list_tags
from .frames import make_origin
from .mechanisms import ROW_OF, compare_mechanisms, list_parts_by_kind
from .native import are_of_one_format, compare_native, list_in_bodies
from .pair import Pair
from .rows import BLOCKS, LOOPS, NATIVE
from .uncompared import OPEN, Uncompared
from .unread import compare_unread

_COMPARED = frozenset(ROW_OF) - {"frame", "camera", "mounted sensor", "plugin"}
"""Kinds of parts; the others are compared in the frames of bodies, or by class."""

_ROWS = frozenset((*(ROW_OF[kind] for kind in _COMPARED), BLOCKS, NATIVE))

_TOLERANCE = 1e-6
"""Largest relative difference of equal numbers; chosen, no source."""

_WHY = {BLOCKS: "only URDF has such blocks"}

_READ = LINK_TAGS | JOINT_TAGS
"""Elements in blocks whose values are compared in rows of their own."""

_READ_IN_GAZEBO = _READ | {"sensor", "joint", "contact"}
"""Those in ``<gazebo>``, where a ``<joint>`` closes a loop."""

_READ_IN_CONTACT = frozenset(row.contact for row in SURFACE if row.contact)
"""Elements in Bullet's ``<contact>`` of a link that apply to each of its collisions."""


def compare_equipment(pair: Pair, comparison: Comparison) -> None:
    """Compare actuators, contact pairs, configurations and plugins of two files of one format.

    What a reader did not read is recorded. Of a URDF and an SDF, loops and what blocks have in
    addition are compared.
    """
    compare_unread(pair, comparison)
    rows = [row for row in comparison.tolerances if row in _ROWS]
    a, b = pair.a.robot, pair.b.robot
    shared = are_of_one_format(a, b)
    if pair.formats[0] != pair.formats[1]:
        compared = ("actuators", "sensors", *((LOOPS, NATIVE) if shared else ()))
        for row in rows:
            if row not in compared:
                comparison.skipped[row] = _WHY.get(row, "of two files of one format only")
        if shared:
            _compare_loops(pair, comparison)
            _compare_native(pair, comparison)
        else:
            _record_loops(pair, comparison)
        return
    if pair.formats[0] == "urdf":  # its actuators are elements of blocks
        others = [row for row in rows if row not in (BLOCKS, "sensors")]
        comparison.skipped.update(dict.fromkeys(others, f"in the row of {BLOCKS}"))
    elif BLOCKS in rows:
        comparison.skipped[BLOCKS] = _WHY[BLOCKS]
    _record_parts(pair, comparison)
    for difference in _list_differences(pair):
        comparison.add(difference)
    if shared:
        _compare_native(pair, comparison)


def _compare_native(pair: Pair, comparison: Comparison) -> None:
    comparison.record_parts(NATIVE, pair.a.robot.native, pair.b.robot.native)
    for difference in compare_native(*list_in_bodies(pair), _TOLERANCE, _get_names(pair)):
        comparison.add(difference)


def _record_loops(pair: Pair, comparison: Comparison) -> None:
    """Record the loops of robots whose formats describe them in other ways."""
    for robot in (pair.a.robot, pair.b.robot):
        for loop in robot.closures:
            if loop.is_active:
                name = f"{loop.name or f'{loop.parent} – {loop.child}'} ({loop.place})"
                comparison.record_uncompared(Uncompared(LOOPS, OPEN, name, "of this file"))


def _compare_loops(pair: Pair, comparison: Comparison) -> None:
    robots = put_loops_into_bodies(pair)
    comparison.record_parts(LOOPS, *(robot.closures for robot in robots))
    for difference in compare_mechanisms(*robots, _TOLERANCE, _get_names(pair)):
        if difference.row == LOOPS and difference.what != RENAMED:
            comparison.add(replace(difference, owners=("",)))


def _get_names(pair: Pair) -> dict[str, str]:
    """Return the names of parts in the second robot by those in the first."""
    return {**pair.parts, **pair.joints, **pair.links}


def _record_parts(pair: Pair, comparison: Comparison) -> None:
    """Record which rows compare something: the kinds of parts that a robot has."""
    for robot in (pair.a.robot, pair.b.robot):
        for kind, parts in list_parts_by_kind(robot):
            if kind in _COMPARED:
                comparison.record_parts(ROW_OF[kind], *parts)
        if robot.xml is not None:
            for tag in list_block_tags(robot):
                comparison.record_parts(BLOCKS, *robot.xml.list_children(tag))


def _list_differences(pair: Pair) -> Iterator[Difference]:
    a, b = put_loops_into_bodies(pair)
    renamed = _get_names(pair)
    for difference in compare_mechanisms(a, b, _TOLERANCE, renamed):
        if difference.kind in _COMPARED and difference.what != RENAMED:
            yield difference
    for difference in compare_extensions(a, b, _TOLERANCE, renamed):
        read = _READ_IN_GAZEBO if difference.kind == "gazebo" else _READ
        if difference.what == EXISTENCE:
            one = difference.values[1] is None
            tags = list_tags(a if one else b, difference, renamed if one else {})
            if not tags or tags - read:
                yield difference
        elif not _is_read(re.split(r"[/ \[(]", difference.what), read, a.link.get(difference.name)):
            yield difference


def _is_read(path: list[str], read: frozenset[str], link: Link | None) -> bool:
    """Tell whether a row of its own compares what is at a path of a block, link or joint."""
    if link is not None and path[0] == "contact" and path[1:]:
        return bool(link.collisions) and path[1] in _READ_IN_CONTACT
    if path[0] == "sensor" and (len(path) == 1 or "plugin" in path):
        return False  # its name, of which topics are made, and its plugins
    return path[0] in read


_SAME = {"ball": "connect", "fixed": "weld"}
"""Constraint of MJCF that is that of a joint of SDF, by type."""


def put_loops_into_bodies(pair: Pair) -> tuple[Robot, Robot]:
    """Return both robots with each end of a loop at a rigid body of the first robot.

    Links of a body may differ in the two files. A joint of SDF is the constraint that it makes.
    """
    frames = {two: (one, frame) for one, (two, frame) in pair.frames.items()}
    own = {one: (one, np.eye(4)) for one in pair.a.by_name}
    a, b = pair.a.robot, pair.b.robot
    return (
        replace(a, closures=[_put_into_bodies(closure, pair.a, own) for closure in a.closures]),
        replace(b, closures=[_put_into_bodies(closure, pair.b, frames) for closure in b.closures]),
    )


def _put_into_bodies(
    closure: Closure, bodies: Bodies, frames: Mapping[str, tuple[str, Array]]
) -> Closure:
    """Return a loop whose ends are at bodies; they are unchanged if one has no counterpart.

    A ``connect`` has a common point, so the axes of its frame are those of the bodies.

    ``frames`` are name and pose, 4 × 4, of each body in the first robot.
    """
    closure = replace(closure, type=_SAME.get(closure.type, closure.type))
    ends = []
    for link, origin in ((closure.parent, closure.origin), (closure.child, closure.child_origin)):
        body = bodies.body_of.get(link, "")
        if body not in frames:
            return closure
        name, frame = frames[body]
        pose: Array = frame @ bodies.by_name[body].members[link] @ get_origin_matrix(origin)
        if closure.type == "connect":
            pose[:3, :3] = np.eye(3)
        ends.append((name, make_origin(pose)))
    (parent, origin), (child, child_origin) = ends
    return replace(closure, parent=parent, child=child, origin=origin, child_origin=child_origin)
