"""Proof of an export: the robot that is read back from its file, compared with the source.

An export declares what it loses, each loss with a code and the name of its link or joint. A table
of :class:`Excuse` of each format says which rows a code explains, and for which parts. A difference
that no loss explains fails the proof. Messages are not read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple, Protocol

from ..diagnostic import Severity
from ..errors import ModelError
from ..listing import list_first
from ..mechanics.reference import Array
from ..model.elements import Joint, Link, Robot
from ..model.kinematics import link_poses
from ..model.mechanism import Base
from ..model.pose import make_pose
from ..model.provenance import NOWHERE
from ..model.settings import LOST_SETTINGS, is_set
from ..model.world import WORLD
from .check import Check
from .compare import compare_robots
from .difference import EXISTENCE, Comparison, Difference, name_part
from .frames import describe_pose, make_matrix
from .mesh_measure import MeshMeasures
from .names import NameMap
from .pair import add_presence
from .rows import GLOBAL_ROWS, ROWS, Row
from .worlds import record_decided

Extent = Literal["part", "body", "below", "robot"]
"""Parts whose difference a loss explains.

``part`` is the link or joint of the loss, ``body`` every link that fixed joints connect to it, or
to the parent of the joint,
``below`` it and all below it in the tree, ``robot`` everything.
"""

_MOTION = frozenset(
    ("tree", "frames", "axes", "mass", "center of mass", "inertia", "base", "joint physics")
)
"""Rows on which the rows of the whole robot depend."""

TOLERANCE_OF_POSE = 1e-9
"""Largest difference of the poses of two models [m, rad] that counts as equal; chosen, above the
rounding errors of angles.
"""

_NOT_IN_NAMES = re.compile(r"\W")
"""Characters that identifiers of USD do not have."""

MOVED_FRAME = "lossy-link-frame"
"""Code of a link whose frame is elsewhere in the source: the comparison is that of rigid bodies."""

_SHOWN = 9
"""Digits of the numbers in a difference; chosen, above the strictest tolerance of 1e-9."""


class Loss(Protocol):
    """A loss that an export or its reading declares."""

    code: str
    message: str
    name: str
    severity: Severity

    @property
    def data(self) -> Mapping[str, Any]:
        """Return the values of the message."""


class Excuse(NamedTuple):
    """Differences that losses explain: of the settings that the data of a loss names, or of all.

    Attributes:
        rows: Names of the rows.
        codes: Codes of the losses.
        extent: Parts that are explained.
        ends: Ends of the names of parts that replace one, such as ``_x``.
        least: Least severity of the losses.
        properties: Beginnings of the names of what differs; by default all of a row.
    """

    rows: tuple[str, ...]
    codes: frozenset[str]
    extent: Extent = "part"
    ends: tuple[str, ...] = ()
    least: Severity = Severity.INFO
    properties: tuple[str, ...] = ("",)

    def covers(self, difference: Difference) -> bool:
        """Tell whether a difference is one of those that the losses of a part explain."""
        return difference.row in self.rows and difference.what.startswith(self.properties)


@dataclass
class Claims:
    """What an export says about itself.

    Attributes:
        losses: Declared losses.
        renamed: New names by ``kind`` and old name.
        excuses: Differences that codes of losses explain.
        unread: What the reader does not hold of the exported file.
        unseen: Parts that ``unread`` explains where the result seems to lack them: they are not
            compared.
    """

    losses: Sequence[Loss] = ()
    renamed: Mapping[tuple[str, str], str] = field(default_factory=dict)
    excuses: Sequence[Excuse] = ()
    unread: Sequence[Loss] = ()
    unseen: Sequence[Excuse] = ()

    @property
    def names(self) -> NameMap:
        """Return the new names of joints and links."""
        return NameMap(*(
            {old: new for (of, old), new in self.renamed.items() if of == kind}
            for kind in ("joint", "link")
        ))  # fmt: skip


def prove(
    source: Robot,
    result: Robot,
    claims: Claims,
    *,
    rows: Sequence[Row] = ROWS,
    meshes: MeshMeasures | None = None,
    has_frames: bool = False,
    described: Robot | None = None,
) -> list[Check]:
    """Compare an export, which was read back, with its source.

    With ``has_frames``, each link of the source must be a link or a frame of the result.
    ``described`` is the robot as its file describes it, if the source has another format; its world
    decides which rows say nothing of the result.

    Returns:
        A row for each property, also for those that could not be compared, and one for what the
        result does not hold.
    """
    one, two = join_trees(_drop_world(source, claims)), join_trees(result)
    if _has_free_trees(two) and one.base is not None and one.base.is_free:
        one = _put_on_world(one)
    try:
        comparison = compare_robots(one, two, rows=rows, names=claims.names, meshes=meshes)
    except ModelError as error:
        return [Check("tree", "links and joints", 0.0, differing=[error.message])]
    if described is not None:
        record_decided(described, two, comparison)
    if has_frames:
        _add_missing_links(one, two, comparison, claims)
    _compare_pose(source, result, claims.names, comparison)
    checks = make_checks(one, comparison, claims)
    moved = [f"'{loss.name}'" for loss in claims.losses if loss.code == MOVED_FRAME]
    for check in checks:
        if check.name == "frames" and moved:
            check.announced.append(f"frames of links are at their joints: {list_first(moved, 2)}")
    return [*checks, *_list_unread(comparison, claims)]


def _add_missing_links(
    source: Robot, result: Robot, comparison: Comparison, claims: Claims
) -> None:
    """Record the links that are neither links nor frames of the result."""
    present = {*result.link, *(frame.name for frame in result.frames)}
    for link in source.links:
        new = comparison.links.get(link.name, claims.names.links.get(link.name, link.name))
        if new not in present and link.name != WORLD:
            add_presence(comparison, "frames", "link", "frame", 0, link, link.name, link.name)


def _compare_pose(source: Robot, result: Robot, names: NameMap, comparison: Comparison) -> None:
    """Compare the poses of the robots in their worlds, at a link that both have."""
    if source.base is None or result.base is None:
        return
    here, there = (
        _compute_world_poses(source, source.base),
        _compute_world_poses(result, result.base),
    )
    shared = [(x, y) for x in here if (y := names.links.get(x, x)) in there]
    if not shared:
        return
    x, y = shared[0]
    amount = max(abs(a - b) for a, b in zip(here[x].flat, there[y].flat, strict=True))
    if amount > TOLERANCE_OF_POSE:
        texts = describe_pose(here[x]), describe_pose(there[y])
        places, what = (source.link[x].place, NOWHERE), "pose in the world"
        comparison.add(Difference("base", "link", (x, y), what, texts, "m, rad", amount, places))


def _compute_world_poses(robot: Robot, base: Base) -> dict[str, Array]:
    """Return the poses of links and frames in the world with all joints at zero, 4 × 4."""
    origin = make_pose(base.origin)
    found = {name: origin @ pose for name, pose in link_poses(robot).items()}
    for frame in robot.frames:
        if frame.name not in found and frame.link in found:
            found[frame.name] = found[frame.link] @ make_pose(frame.origin)
    return {name: make_matrix(pose) for name, pose in found.items()}


def join_trees(robot: Robot) -> Robot:
    """Return a robot of several trees with its roots on a link ``world``.

    A reader of SDF does the same with a model of several trees.
    """
    return robot if len(robot.tree.roots) < 2 else _put_on_world(robot)


def _put_on_world(robot: Robot) -> Robot:
    """Return a robot with its roots on a link ``world``, free, or fixed if the robot is static."""
    roots = [link.name for link in robot.tree.roots if link.name != WORLD]
    links = robot.links if WORLD in robot.link else [Link(robot.provenance, WORLD), *robot.links]
    origin = None if robot.base is None else robot.base.origin
    kind = "fixed" if is_set(robot.settings, "static") else "floating"
    joints = [Joint(None, f"{name}_floating", kind, WORLD, name, origin=origin) for name in roots]
    return replace(robot, links=links, joints=[*robot.joints, *joints], base=None)


def _has_free_trees(robot: Robot) -> bool:
    """Tell whether a robot is several free trees on a link ``world``."""
    root = robot.tree.root
    below = [] if root is None or root.name != WORLD else robot.tree.get_child_joints(WORLD)
    return len(below) > 1 and all(joint.type == "floating" for joint in below)


def _drop_world(robot: Robot, claims: Claims) -> Robot:
    """Return a robot without a link ``world`` that is a tree of its own, which is not exported.

    A link with mass or geometry stays, unless its loss is declared.
    """
    link = robot.link.get(WORLD)
    if link is None or link not in robot.tree.roots or len(robot.tree.roots) < 2:
        return robot
    is_declared = any(loss.code == "lossy-world" for loss in claims.losses)
    is_empty = link.inertial is None and not (link.visuals or link.collisions)
    if robot.tree.get_child_joints(WORLD) or not (is_empty or is_declared):
        return robot
    return replace(robot, links=[other for other in robot.links if other is not link])


def make_checks(source: Robot, comparison: Comparison, claims: Claims) -> list[Check]:
    """Return a row for each compared property, in which explained differences are announced."""
    back = {new: old for (_, old), new in claims.renamed.items()}
    explained = [(excuse, _find_explained(source, excuse, claims)) for excuse in claims.excuses]
    checks = {row.name: comparison.start_check(row) for row in comparison.rows}
    ordered = sorted(comparison.differences, key=lambda d: d.row in GLOBAL_ROWS)
    for difference in ordered:
        check = checks[difference.row]
        if unread := _find_unread(difference, claims):
            check.skipped = f"not read: {unread}"
            continue
        names = _list_names(source, difference, back)
        known = difference.is_convention or any(
            excuse.covers(difference) and _is_explained(difference, names, losses)
            for excuse, losses in explained
        )
        if difference.row in GLOBAL_ROWS:
            known = known or any(checks[row].announced for row in _MOTION & checks.keys())
        place = check.announced if known else check.differing
        text = describe(difference)
        if text not in place:
            place.append(text)
    return list(checks.values())


def _find_unread(difference: Difference, claims: Claims) -> str:
    """Return why a part of the source is not in the result: its reader does not hold it."""
    if difference.values[1] not in (None, "none"):
        return ""
    name = _NOT_IN_NAMES.sub("_", difference.name)
    for excuse in claims.unseen:
        for loss in claims.unread if excuse.covers(difference) else ():
            names = loss.data.get("names", ())
            if loss.code in excuse.codes and (excuse.extent == "robot" or name in names):
                return loss.message
    return ""


def describe(difference: Difference) -> str:
    """Describe a difference with both values."""
    one, two = difference.values
    title = difference.title
    if difference.what == EXISTENCE:
        title = name_part(difference.kind, difference.name)
    if difference.is_convention or difference.row in GLOBAL_ROWS:
        return f"{title}: {difference.note}" if difference.note else title
    if two is None:
        return f"{title} is missing"
    if one is None:
        return f"{title} is not in the source"
    return f"{title} is {_format(two)}, not {_format(one)}"


def _format(value: object) -> str:
    return f"{value:.{_SHOWN}g}" if isinstance(value, float) else str(value)


def _list_names(source: Robot, difference: Difference, back: Mapping[str, str]) -> set[str]:
    """Return the parts of the source that a difference concerns."""
    one, two = difference.names
    if difference.owners:
        return {one, two, *difference.owners}
    if one:
        return {one}
    name = back.get(two, two)
    return {name, *_list_body(source, name)}


_Explained = dict[frozenset[str], set[str] | None]
"""Names of the parts that losses of an excuse explain, None for all, by the words of the settings
that their data names; no word for all that differs."""


def _find_explained(source: Robot, excuse: Excuse, claims: Claims) -> _Explained:
    """Return what the losses of an excuse explain."""
    found: _Explained = {}
    for loss in claims.losses:
        if loss.code in excuse.codes and loss.severity >= excuse.least:
            settings = loss.data.get(LOST_SETTINGS, ())
            words = frozenset(name.replace("_", " ") for name in settings)
            parts = found.setdefault(words, set())
            if excuse.extent == "robot":
                found[words] = None
            elif parts is not None:
                parts |= {loss.name, *(loss.name + end for end in excuse.ends)}
                parts |= set(_list_extent(source, excuse.extent, loss.name))
    return found


def _is_explained(difference: Difference, names: set[str], explained: _Explained) -> bool:
    """Tell whether losses are about a difference of the parts with some names."""
    return any(
        (not words or difference.what in words) and (parts is None or not parts.isdisjoint(names))
        for words, parts in explained.items()
    )


def _list_extent(source: Robot, extent: Extent, name: str) -> Iterator[str]:
    if extent == "body":
        yield from _list_body(source, name)
    elif extent == "below":
        top = source.joint[name].child if name in source.joint else name
        if top in source.link:
            links = {top, *source.tree.list_descendants(top)}
            yield from links
            yield from (joint.name for joint in source.joints if joint.parent in links)


def _list_body(source: Robot, name: str) -> set[str]:
    """Return the links that fixed joints connect to a link or the parent of a joint."""
    if name not in source.link and name in source.joint:
        name = source.joint[name].parent
    if name not in source.link:
        return set()
    found, todo = {name}, [name]
    while todo:
        link = todo.pop()
        for joint in source.joints:
            ends = {joint.parent, joint.child}
            if joint.is_fixed and link in ends and not ends <= found:
                todo += ends - found
                found |= ends
    return found


def _list_unread(comparison: Comparison, claims: Claims) -> list[Check]:
    """Return a row for what a format lacks, or its reader does not hold; none without such."""
    texts = [f"not read, so not compared: {loss.message}" for loss in claims.unread]
    texts += comparison.not_comparable
    what = "what one of the files does not have, or the reader does not read"
    return [Check("other data", what, 0.0, skipped="; ".join(texts))] if texts else []
