"""Comparison of a robot with one that was made of it, in the way that a correspondence declares.

Nothing is a convention here: each name, frame and mass must be what the correspondence says.
"""

from __future__ import annotations

import math
import random
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..errors import ConfigError
from ..mechanics.reference import Array, Mechanics, compute_mass_properties, get_origin_matrix
from ..model.elements import Joint, Link, Origin, Robot
from ..model.kinematics import get_limits
from ..model.provenance import NOWHERE
from ..model.settings import Value
from ..model.world import WORLD
from ..source.location import Place
from .compare import compare_robots
from .conventions import express_pair
from .correspondence import Correspondence
from .difference import Comparison, Difference
from .frames import describe_motion, describe_pose, format_vector, invert, measure_largest
from .images import add_images
from .inertia import combine, format_tensor
from .mesh_measure import MeshMeasures
from .names import NameMap, get_pair
from .pair import locate
from .references import list_references
from .rows import GLOBAL_ROWS, Row

_CONFIGURATIONS = 6
"""Configurations at which poses are compared; chosen, no source."""

_WIDEST = 3.0
"""Largest position of a joint [rad, m] at which poses are compared; chosen, no source."""


def compare_declared(
    a: Robot,
    b: Robot,
    declared: Correspondence,
    *,
    rows: Sequence[Row],
    meshes: MeshMeasures | None = None,
) -> Comparison:
    """Compare two robots in the conventions of the second.

    All that :func:`compare.compare_robots` compares is, and in addition: the names of links and
    joints; the pose of each link at random positions of all joints; mass, center of mass and tensor
    of each link in its frame, with those that were merged into it; soft limits and calibration.

    Raises:
        ConfigError: The first robot cannot be what is declared.
        ModelError: The links of a robot do not form a tree.
    """
    before = a, b
    a, b = express_pair(a, b, declared)
    a = add_images(a, declared.images)
    flags = {name: Value(None, content) for name, content in declared.settings}
    a = replace(a, settings={**a.settings, **flags})
    _check_merged(a, declared)
    names = get_pair(declared.names, 0, 1)
    comparison = compare_robots(a, b, rows=rows, names=names, meshes=meshes)
    _drop_conventions(comparison)
    if declared.tolerance:
        _leave_out_sums(comparison)
    gone = tuple(_list_lost(old, new) for old, new in zip(before, (a, b), strict=True))
    _drop_uncompared_blocks(comparison, before, gone)
    anchors = list(_compare_anchors(a, b, declared))
    if anchors:
        comparison.skipped.pop("base", None)
    for difference in (
        *anchors,
        *_compare_links(a, b, names, declared),
        *_compare_joints(a, b, names, declared, comparison.joints),
        *_compare_mounts(before[1], declared),
        *_compare_poses(a, b, names),
        *_compare_masses(a, b, names, declared, comparison.tolerances.get("mass", 0.0)),
    ):
        comparison.add(difference)
    return comparison


def _leave_out_sums(comparison: Comparison) -> None:
    """Leave rows of the whole robot out, which may be differences of nearly equal numbers."""
    comparison.differences[:] = [d for d in comparison.differences if d.row not in GLOBAL_ROWS]
    reason = "numbers are rounded"
    comparison.skipped |= dict.fromkeys(comparison.tolerances.keys() & set(GLOBAL_ROWS), reason)


def _list_lost(before: Robot, after: Robot) -> set[str]:
    """Return the names of links and joints that are not compared."""
    return {*before.link, *before.joint} - {*after.link, *after.joint}


def _drop_uncompared_blocks(
    comparison: Comparison, robots: tuple[Robot, Robot], gone: tuple[set[str], ...]
) -> None:
    """Remove differences of blocks that are about links and joints that are not compared."""
    kept = []
    for difference in comparison.differences:
        side = 1 if difference.values[0] in (None, "none") else 0
        place = difference.places[side]
        if (
            difference.row != "simulator data"
            or not {None, "none"} & {difference.values[0], difference.values[1]}
            or not _has_name_of(robots[side], place, gone[side])
        ):
            kept.append(difference)
    if len(kept) < len(comparison.differences):
        comparison.differences[:] = kept
        amounts = [d.amount for d in kept if d.row == "simulator data"]
        comparison.worst["simulator data"] = max(amounts, default=0.0)


def _has_name_of(robot: Robot, place: Place, names: set[str]) -> bool:
    """Tell whether the block at a place has one of some names, or is one of the whole robot."""
    if not names or robot.xml is None:
        return False
    for block in robot.xml.children:
        if block.start <= place.start < max(block.end, block.start + 1):
            words = {w for e in block.walk() for w in (*e.attributes.values(), e.text.strip())}
            is_whole = block.tag == "gazebo" and not block.get("reference")
            return not names.isdisjoint(words) or is_whole
    return False


def _check_merged(a: Robot, declared: Correspondence) -> None:
    bodies = a.tree.bodies
    for name, into in declared.merged_links.items():
        for link in (name, into):
            if link not in a.link:
                raise ConfigError(f"merged link '{link}' is not in robot '{a.name}'")
        if bodies[name] != bodies[into]:
            raise ConfigError(f"link '{name}' is declared merged, but a joint moves it in '{into}'")


def _drop_conventions(comparison: Comparison) -> None:
    """Remove conventions: another link frame is found by its pose, which is compared, too."""
    comparison.differences[:] = [d for d in comparison.differences if not d.is_convention]


def _compare_anchors(a: Robot, b: Robot, declared: Correspondence) -> Iterator[Difference]:
    """Yield that only one of two URDF has the root ``world``, which Gazebo does not move."""
    one, two = a.tree.root, b.tree.root
    is_known = a.base is None and b.base is None and not any(declared.branch)
    if one is None or two is None or not is_known or (one.name == WORLD) == (two.name == WORLD):
        return
    words = [f"fixed by '{WORLD}'" if r.name == WORLD else "free in Gazebo" for r in (one, two)]
    names, places = (one.name, two.name), (locate(one, None), locate(two, None))
    yield Difference("base", "link", names, "base", (words[0], words[1]), "", 1.0, places)


def _compare_links(
    a: Robot, b: Robot, names: NameMap, declared: Correspondence
) -> Iterator[Difference]:
    """Yield links that only one robot has, but virtual ones."""
    merged = declared.merged_links
    expected = set()
    for link in a.links:
        name = names.links.get(link.name, link.name)
        expected.add(name)
        if (name in b.link) != (link.name not in merged) and not link.is_virtual:
            values = ("merged", "there") if link.name in merged else (name, None)
            yield _make("frames", "link", (link.name, ""), "name", values, math.inf, link)
    for link in b.links:
        if link.name not in expected and not link.is_frame:
            yield _make(
                "frames", "link", ("", link.name), "name", (None, link.name), math.inf, link
            )


def _compare_joints(
    a: Robot, b: Robot, names: NameMap, declared: Correspondence, moving: Collection[str]
) -> Iterator[Difference]:
    """Yield joints that only the first robot has, and soft limits of those that do not move."""
    for joint in a.joints:
        name = names.joints.get(joint.name, joint.name)
        child = a.link.get(joint.child)
        if child is None or child.name in declared.merged_links or joint.parent not in a.link:
            continue
        if name not in b.joint:
            if not a.link[joint.parent].is_virtual:
                values = name, None
                yield _make("tree", "joint", (joint.name, ""), "name", values, math.inf, joint)
            continue
        if joint.name not in moving:
            yield from list_references(joint, b.joint[name])


def _compare_mounts(b: Robot, declared: Correspondence) -> Iterator[Difference]:
    """Yield differences of the fixed joints that carry what the first robot does not have."""
    for link, parent, xyz, rpy in declared.mounts:
        joint = b.tree.get_parent_joint(link) if link in b.link else None
        if joint is None:
            raise ConfigError(f"mounted link '{link}' has no joint in robot '{b.name}'")
        pose, other = get_origin_matrix(Origin(None, xyz, rpy)), get_origin_matrix(joint.origin)
        offset = invert(pose) @ other
        places = NOWHERE, locate(joint.origin, joint)
        names, values = (link, joint.name), (describe_pose(pose), describe_pose(other))
        amount, note = measure_largest(offset), describe_motion(offset)
        kind = ("frames", "joint", names, "mount")
        yield Difference(*kind, values, "m, rad", amount, places, note)
        ends = f"fixed to {parent}", f"{joint.type} to {joint.parent}"
        amount = 0.0 if joint.is_fixed and joint.parent == parent else math.inf
        yield Difference("tree", "joint", names, "mount", ends, "", amount, places)


def _make(
    row: str,
    kind: str,
    names: tuple[str, str],
    what: str,
    values: tuple[object, object],
    amount: float,
    part: Link | Joint,
) -> Difference:
    """Return the difference of a part that one robot has."""
    here = locate(part, None)
    places = (here, NOWHERE) if names[0] else (NOWHERE, here)
    return Difference(row, kind, names, what, values, "", amount, places)


def _compare_poses(a: Robot, b: Robot, names: NameMap) -> Iterator[Difference]:
    """Yield the first link of a branch whose pose differs at random positions of all joints."""
    one, two = Mechanics(a), Mechanics(b)
    pairs = [(link, b.link.get(names.links.get(link.name, link.name))) for link in a.links]
    known = {x.name: y for x, y in pairs if y is not None}
    if one.root not in known:
        return
    offsets = dict.fromkeys(known, np.eye(4))
    poses: dict[str, tuple[Array, Array]] = {}
    generator = random.Random(0)
    for number in range(_CONFIGURATIONS):
        here = {j.name: _draw(j, generator) if number else 0.0 for j in one.joints}
        there = {names.joints.get(name, name): value for name, value in here.items()}
        frames, frames2 = one.compute_frames(here), two.compute_frames(there)
        back = invert(frames2[known[one.root].name])
        for name, other in known.items():
            x, y = frames[name], back @ frames2[other.name]
            offset = invert(x) @ y
            if name not in poses or measure_largest(offset) > measure_largest(offsets[name]):
                offsets[name], poses[name] = offset, (x, y)
    wrong: set[str] = set()
    for name in a.tree.order:
        if name not in known:
            continue
        amount = measure_largest(offsets[name])
        if not wrong.isdisjoint(a.tree.list_ancestors(name)):
            continue
        if amount > 1e-9:
            wrong.add(name)
        x, y = poses[name]
        yield Difference(
            *("frames", "link", (name, known[name].name), "pose at random positions"),
            *((describe_pose(x), describe_pose(y)), "m, rad", amount),
            (locate(a.link[name], None), locate(known[name], None)),
            describe_motion(offsets[name]),
        )


def _draw(joint: Joint, generator: random.Random) -> float:
    lower, upper = (max(-_WIDEST, min(_WIDEST, value)) for value in get_limits(joint))
    return generator.uniform(lower, upper) if lower < upper else generator.uniform(-1.0, 1.0)


def _compare_masses(
    a: Robot, b: Robot, names: NameMap, declared: Correspondence, floor: float
) -> Iterator[Difference]:
    """Yield differences of the mass properties of links, with those merged into them."""
    frames = Mechanics(a).compute_frames({})
    groups: dict[str, list[str]] = {}
    for link in a.links:
        groups.setdefault(declared.merged_links.get(link.name, link.name), []).append(link.name)
    for name, members in groups.items():
        other = b.link.get(names.links.get(name, name))
        if other is None or name not in frames:
            continue
        back = invert(frames[name])
        own = [compute_mass_properties(a.link[m], back @ frames[m]) for m in members]
        one = combine([properties for properties in own if properties is not None])
        two = compute_mass_properties(other, np.eye(4)) or combine([])
        places = locate(a.link[name].inertial, a.link[name]), locate(other.inertial, other)
        ends = (name, other.name)
        unit = abs(one[0] - two[0]) / max(one[0], two[0], 1e-12)
        masses = one[0], two[0]
        yield Difference("mass", "link", ends, "own mass", masses, "kg", unit, places)
        if unit > floor or not one[0]:
            continue
        texts = format_vector(one[1]), format_vector(two[1])
        size = float(np.linalg.norm(one[1] - two[1]))
        what = "own center of mass"
        yield Difference("center of mass", "link", ends, what, texts, "m", size, places)
        texts = (format_tensor(one[2]), format_tensor(two[2]))
        scale = max(float(np.trace(one[2])), float(np.trace(two[2])), 1e-15)
        size = float(np.abs(one[2] - two[2]).max()) / scale
        yield Difference("inertia", "link", ends, "own tensor", texts, "kg·m²", size, places)
