"""Comparison of two robots that were read from files of any format."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..mechanics.reference import Array
from ..model.elements import Joint, Robot
from ..model.world import WORLD
from .bodies import Body, compute_axis
from .difference import EXISTENCE, Comparison, Difference
from .drives import compare_drives
from .dynamics import compare_dynamics
from .equipment import compare_equipment
from .frames import describe_motion, describe_pose, invert, measure_largest
from .inertia import compare_inertia
from .joints import JointMatch, compare_joint, compare_mimic, get_kind
from .looks import skip_looks
from .matching import list_below, match_children
from .mesh_measure import MeshMeasures
from .names import EMPTY, NameMap
from .origins import (
    choose_parent_frame,
    compute_parent_frame,
    describe_origin,
    find_least_offset,
    get_member_poses,
    has_same_parent,
)
from .pair import Match, Pair, add_presence, locate, make_pair
from .plugins import compare_plugins
from .rows import ROWS, Row
from .sensors import compare_sensors
from .settings import compare_flags, compare_joint_settings, compare_robot_flags
from .shapes import compare_shapes
from .worlds import compare_worlds

_MANY = 3
"""Number of differences from which another frame is considered."""

_SAME = 1e-6
"""Distance [m] and angle [rad] of equal frames; above the rounding errors of printed angles."""

_FARTHEST = 0.02
"""Distance of two axes [m] up to which their frames may have different conventions."""


@dataclass
class _Walk:
    """State of the comparison."""

    pair: Pair
    comparison: Comparison
    compared: set[str] = field(default_factory=set)
    signs: dict[str, float] = field(default_factory=dict)


def compare_robots(
    a: Robot,
    b: Robot,
    *,
    rows: Sequence[Row] = ROWS,
    names: NameMap = EMPTY,
    meshes: MeshMeasures | None = None,
) -> Comparison:
    """Compare two robots as mechanisms: names of roots and merged links may differ.

    Joints are matched by name, then by the structure of the tree. Both robots are compared body by
    body from the root; a difference is recorded at its part, and not again below it.

    Raises:
        ModelError: The links of a robot do not form a tree.
    """
    walk = _Walk(make_pair(a, b, names, meshes or MeshMeasures()), Comparison(tuple(rows)))
    pair, comparison = walk.pair, walk.comparison
    one, two = pair.a.by_name[pair.a.root], pair.b.by_name[pair.b.root]
    comparison.record_parts("tree", a.links, b.links)
    _compare_base(pair, comparison)
    frame = _align_base(walk, one, two)
    if measure_largest(frame) > 1e-6 and (one.name == WORLD) == (two.name == WORLD):
        _add_base_pose(pair, Match(one, two, frame), comparison)
    _compare_tree(walk, Match(one, two, frame))
    for name, other in list(pair.joints.items()):
        if name not in walk.compared:  # its parent has no counterpart
            x, y = pair.a.joints[name], pair.b.joints[other]
            same = has_same_parent(pair, x, y)
            frame = compute_parent_frame(pair, x, y) if same else np.eye(4)
            _compare_child(walk, x, y, frame, parent_is_known=same)
    for name, other in pair.joints.items():
        joints = pair.a.joints[name], pair.b.joints[other]
        compare_mimic(pair, *joints, walk.signs, comparison)
    compare_robot_flags(pair, comparison)
    compare_sensors(pair, comparison)
    compare_drives(pair, comparison)
    skip_looks(pair, comparison)
    compare_plugins(pair, comparison)
    compare_worlds(pair, comparison)
    compare_equipment(pair, comparison)
    compare_dynamics(pair, frame, walk.signs, comparison)
    comparison.joints, comparison.links = dict(pair.joints), dict(pair.links)
    return comparison


def _compare_base(pair: Pair, comparison: Comparison) -> None:
    known = pair.a.is_free, pair.b.is_free
    if None in known:
        comparison.skipped["base"] = "not specified in every file"
        return
    roots = pair.a.robot.link[pair.a.root], pair.b.robot.link[pair.b.root]
    words = ["free" if free else "fixed" for free in known]
    comparison.add(
        Difference(
            "base",
            "link",
            (roots[0].name, roots[1].name),
            "base",
            (words[0], words[1]),
            "",
            0.0 if known[0] == known[1] else 1.0,
            (locate(pair.a.robot.base, roots[0]), locate(pair.b.robot.base, roots[1])),
        )
    )


def _add_base_pose(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Record another pose of the whole robot in its root link.

    It is a difference if the root has the same name in both files and another link is fixed to it;
    otherwise it is a convention.
    """
    if _has_root_at(match):
        return
    members = pair.match_members(match.one, match.two)
    others = [(x, y) for x, y in members if x != match.one.name and y != match.two.name]
    if others and (match.one.name, match.two.name) in members:
        plain = Match(match.one, match.two, np.eye(4))
        _compare_frame(pair, plain, *others[0], comparison)
        return
    poses = "identity", describe_pose(match.frame)
    _add_frame_convention(comparison, "base", pair, match, poses)


def _has_root_at(match: Match) -> bool:
    """Tell whether the root of one body is a link or frame of the other at that pose."""
    one, two, back = match.one, match.two, invert(match.frame)
    for body, name, pose in ((two, one.name, back), (one, two.name, match.frame)):
        known = body.members.get(name, body.frames.get(name, (None, None))[1])
        if name != body.name and known is not None:
            return measure_largest(invert(known) @ pose) <= _SAME
    return False


def _align_base(walk: _Walk, one: Body, two: Body) -> Array:
    """Return the pose of the second root body in the first with the fewest differences."""
    pair = walk.pair
    candidates = [np.eye(4)]
    for x, y in pair.match_members(one, two):
        candidates.append(one.members[x] @ invert(two.members[y]))
    for joint in one.joints:
        other = _find_joint(pair, joint)
        if other is not None and pair.b.body_of[other.parent] == two.name:
            poses = pair.a.compute_joint_pose(joint), pair.b.compute_joint_pose(other)
            candidates.append(poses[0] @ invert(poses[1]))
    has_same_root = pair.links.get(one.name, one.name) == two.name
    return _choose(walk, one, two, candidates, prefers_first=has_same_root)


def _choose(
    walk: _Walk, one: Body, two: Body, candidates: list[Array], *, prefers_first: bool
) -> Array:
    """Return the pose with the fewest differences of two bodies.

    Candidates are poses of the second body in the first, 4 × 4; the first one is preferred, unless
    that causes several differences and another none.
    """
    different: list[Array] = []
    for pose in candidates:
        if all(measure_largest(invert(other) @ pose) > 1e-6 for other in different):
            different.append(pose)
    if len(different) == 1:
        return different[0]
    counts = [_count(walk, Match(one, two, pose)) for pose in different]
    least = min(counts)
    is_better = not prefers_first or (not least and counts[0] >= _MANY)
    return different[counts.index(least)] if is_better else different[0]


def _count(walk: _Walk, match: Match) -> int:
    """Count the differences of two bodies and of the joints on them."""
    pair = walk.pair
    trial = Comparison(ROWS)
    _compare_content(pair, match, trial)
    for joint in match.one.joints:
        other = _find_joint(pair, joint)
        if other is not None and pair.b.body_of[other.parent] == match.two.name:
            pose = pair.a.compute_joint_pose(joint)
            frame = choose_parent_frame(pair, joint, other, match.frame)
            offset = invert(pose) @ frame @ pair.b.compute_joint_pose(other)
            trial.worst["frames"] = 0.0
            if measure_largest(offset) > trial.tolerances["frames"]:
                trial.add(describe_origin(pair, joint, other, offset, match.frame))
    return len({(d.row, d.title) for d in trial.differences})


def _find_joint(pair: Pair, joint: Joint) -> Joint | None:
    name = pair.joints.get(joint.name)
    return None if name is None else pair.b.joints[name]


def _compare_content(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Compare frames, inertia and shapes of two bodies."""
    members = pair.match_members(match.one, match.two)
    fixed = [(x, y) for x, y in members if x != match.one.name or y != match.two.name]
    for x, y in fixed:
        _compare_frame(pair, match, x, y, comparison)
    _compare_named_frames(pair, match, comparison)
    chosen = match
    if any(_is_moved(match, x, y) for x, y in fixed):
        local = _put_members_at(match, fixed)
        trials = [Comparison(comparison.rows), Comparison(comparison.rows)]
        for trial, candidate in zip(trials, (match, local), strict=True):
            compare_inertia(pair, candidate, trial)
            compare_shapes(pair, candidate, trial)
        if len(trials[1].differences) < len(trials[0].differences):
            chosen = local
    compare_inertia(pair, chosen, comparison)
    compare_shapes(pair, chosen, comparison)
    compare_flags(pair, chosen, comparison)


def _compare_named_frames(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Compare the poses of frames and sites with those of frames or links of the same name."""
    sides = [
        {
            **{name: (bodies.robot.link[name], pose) for name, pose in body.members.items()},
            **body.frames,
        }
        for bodies, body in ((pair.a, match.one), (pair.b, match.two))
    ]
    _add_missing_sites(pair, match, comparison)
    for x, (part, pose) in sides[0].items():
        y = pair.links.get(x, x)
        if y not in sides[1] or (x in match.one.members and y in match.two.members):
            continue
        other, there = sides[1][y]
        offset = find_least_offset(pair, match, pose, there)
        comparison.add(
            Difference(
                "frames",
                "link",
                (x, y),
                f"pose in '{match.one.name}'",
                (describe_pose(pose), describe_pose(match.frame @ there)),
                "m, rad",
                measure_largest(offset),
                (locate(part, None), locate(other, None)),
                describe_motion(offset),
            )
        )


def _add_missing_sites(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Record the sites and frames of a body that the other robot has in another, or not at all.

    That one is missing is a difference of two MJCF and of two SDF; other formats have links there.
    """
    kind = {frozenset(("mjcf",)): "site", frozenset(("sdf",)): "frame"}.get(frozenset(pair.formats))
    for side, (body, other) in enumerate(((match.one, match.two), (match.two, match.one))):
        bodies = (pair.b, pair.a)[side]
        elsewhere = {n for one in bodies.by_name.values() for n in (*one.frames, *one.members)}
        for name, (frame, _) in body.frames.items():
            if name in other.frames or name in other.members or name in bodies.robot.joint:
                continue
            if frame.kind == kind or name in elsewhere:
                add_presence(
                    comparison, "frames", "link", frame.kind, side, frame, name, frame.kind
                )


def _is_moved(match: Match, x: str, y: str) -> bool:
    """Tell whether a link is at another pose in its body."""
    one, two = get_member_poses(match, x, y)
    return measure_largest(invert(one) @ two) > 1e-6


def _put_members_at(match: Match, members: list[tuple[str, str]]) -> Match:
    """Return the bodies with the links of the second at the poses of those of the first.

    The contents of links are then compared in the frames of the links.
    """
    back = invert(match.frame)
    poses = {y: back @ match.one.members[x] for x, y in members}
    two = replace(match.two, members={**match.two.members, **poses})
    return Match(match.one, two, match.frame)


def _compare_frame(pair: Pair, match: Match, x: str, y: str, comparison: Comparison) -> None:
    """Compare the pose of a link that a fixed joint connects to the body."""
    one, two = get_member_poses(match, x, y)
    offset = invert(one) @ two
    above = pair.a.robot.tree.get_parent_joint(x), pair.b.robot.tree.get_parent_joint(y)
    owner = match.one.name
    if above[0] is not None and above[1] is not None and measure_largest(offset) > 1e-9:
        parents = above[0].parent, above[1].parent
        on_top = parents == (match.one.name, match.two.name)
        if not on_top and parents in pair.match_members(match.one, match.two):
            local = invert(match.one.members[parents[0]]) @ one
            other = invert(match.two.members[parents[1]]) @ match.two.members[y]
            if measure_largest(invert(local) @ other) < measure_largest(offset):
                one, two, owner = local, other, parents[0]
                offset = invert(one) @ two
    links = pair.a.robot.link[x], pair.b.robot.link[y]
    comparison.add(
        Difference(
            "frames",
            "link",
            (x, y),
            f"pose in '{owner}'",
            (describe_pose(one), describe_pose(two)),
            "m, rad",
            measure_largest(offset),
            (locate(above[0], links[0]), locate(above[1], links[1])),
            describe_motion(offset),
        )
    )


def _compare_tree(walk: _Walk, match: Match) -> None:
    """Compare two bodies and everything below them."""
    todo = [match]
    pair = walk.pair
    links, known = set(pair.links.values()), set(pair.joints.values())
    while todo:
        match = todo.pop()
        if match.two.name not in links:
            links.add(pair.links.setdefault(match.one.name, match.two.name))
        pair.frames[match.one.name] = match.two.name, match.frame
        _compare_content(pair, match, walk.comparison)
        pairs = [(j, other) for j in match.one.joints if (other := _find_joint(pair, j))]
        left = [j for j in match.one.joints if j.name not in pair.joints]
        right = [j for j in match.two.joints if j.name not in known]
        for x, y in match_children(pair.a, pair.b, left, right, match.frame):
            pair.joints[x.name] = y.name
            known.add(y.name)
            pairs.append((x, y))
        for side, joints in enumerate((left, right)):
            for joint in joints:
                if joint.name not in (pair.joints, known)[side]:
                    _add_unmatched(walk, side, joint, match)
        for x, y in pairs:
            frame, same = match.frame, pair.b.body_of[y.parent] == match.two.name
            if not same and has_same_parent(pair, x, y):  # a joint above is fixed in one robot
                frame, same = compute_parent_frame(pair, x, y), True
            if not same and not _has_unmatched_parent(pair, y):
                _add_other_parent(walk, x, y)
            todo += _compare_child(walk, x, y, frame, parent_is_known=same, walk_on=False)


def _add_unmatched(walk: _Walk, side: int, joint: Joint, match: Match) -> None:
    """Record a joint that only one robot has."""
    pair = walk.pair
    bodies = (pair.a, pair.b)[side]
    count = len(list_below(bodies, joint)) - 1
    text = f"{joint.type} joint" + (f" with {count} more below it" if count else "")
    other = (pair.b.robot.link[match.two.name], pair.a.robot.link[match.one.name])[side]
    add_presence(
        walk.comparison, "tree", "joint", EXISTENCE, side, joint, joint.name, text, other=other
    )


def _has_unmatched_parent(pair: Pair, joint: Joint) -> bool:
    """Tell whether the joint above one of the second robot has no counterpart."""
    above = pair.b.by_name[pair.b.body_of[joint.parent]].joint
    return above is not None and above.name not in pair.joints.values()


def _add_other_parent(walk: _Walk, x: Joint, y: Joint) -> None:
    places = locate(x, None), locate(y, None)
    names, parents = (x.name, y.name), (x.parent, y.parent)
    walk.comparison.add(
        Difference("tree", "joint", names, "parent", parents, "", float("inf"), places)
    )


def _compare_child(
    walk: _Walk,
    x: Joint,
    y: Joint,
    frame: Array,
    *,
    parent_is_known: bool,
    walk_on: bool = True,
) -> list[Match]:
    """Compare a joint and its position; return the bodies that it moves, to be compared next.

    ``frame`` is the pose of the second parent body in the first, 4 × 4.
    """
    if x.name in walk.compared:
        return []
    walk.compared.add(x.name)
    pair, comparison = walk.pair, walk.comparison
    one, two = pair.a.get_child(x), pair.b.get_child(y)
    child = np.eye(4)
    if parent_is_known:
        frame = choose_parent_frame(pair, x, y, frame)
        offset = invert(pair.a.compute_joint_pose(x)) @ frame @ pair.b.compute_joint_pose(y)
        if measure_largest(offset) > min(1e-6, comparison.tolerances.get("frames", 1e-6)):
            child = _choose_child_frame(walk, x, y, offset)
        difference = describe_origin(pair, x, y, invert(child) @ offset, frame)
        comparison.add(difference)
    match = Match(one, two, child)
    joint = JointMatch(x, y, child[:3, :3])
    walk.signs[x.name] = compare_joint(pair, joint, comparison)
    compare_joint_settings(pair, joint, walk.signs[x.name], comparison)
    if walk_on:
        _compare_tree(walk, match)
        return []
    return [match]


def _choose_child_frame(walk: _Walk, x: Joint, y: Joint, offset: Array) -> Array:
    """Return the pose of the second child body in the first.

    It is the identity, with which the origin of the joint differs, unless the bodies then differ
    in more properties than if their frames are at the same place in the world. The axes must be
    parallel in that case; their distance is the difference of the origins.
    """
    pair = walk.pair
    one, two = pair.a.get_child(x), pair.b.get_child(y)
    if get_kind(x) != get_kind(y):
        return np.eye(4)
    moved = JointMatch(x, y, offset[:3, :3])
    trial = Comparison(ROWS)
    compare_joint(pair, moved, trial)
    direction = compute_axis(x)
    at = offset[:3, 3]
    on_axis = direction * float(direction @ at) if get_kind(x) == "hinge" else at
    distance = float(np.linalg.norm(at - on_axis))
    if any(d.row == "axes" and d.amount < 3 for d in trial.differences) or distance > _FARTHEST:
        return np.eye(4)
    frame: Array = offset.copy()
    frame[:3, 3] = on_axis
    unmoved = Comparison(ROWS)
    compare_joint(pair, JointMatch(x, y, np.eye(3)), unmoved)
    plain = _count(walk, Match(one, two, np.eye(4))) + 1
    plain += sum(d.row == "axes" for d in unmoved.differences)
    other = _count(walk, Match(one, two, frame)) + (distance > trial.tolerances["frames"])
    if other >= plain or not pair.a.has_content(one) or not pair.b.has_content(two):
        return np.eye(4)
    match = Match(one, two, frame)
    poses = "identity", describe_pose(frame)
    _add_frame_convention(walk.comparison, "frames", pair, match, poses)
    return frame


def _add_frame_convention(
    comparison: Comparison, row: str, pair: Pair, match: Match, poses: tuple[str, str]
) -> None:
    """Record a frame that is elsewhere in the body, while the body is the same."""
    links = pair.a.robot.link[match.one.name], pair.b.robot.link[match.two.name]
    comparison.add(
        Difference(
            row,
            "link",
            (links[0].name, links[1].name),
            "link frame",
            poses,
            "m, rad",
            float("inf"),
            (locate(links[0], None), locate(links[1], None)),
            f"{describe_motion(match.frame)}; more parts of the body agree then",
            is_convention=True,
        )
    )
