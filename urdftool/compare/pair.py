"""Two robots that are compared."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from ..mechanics.reference import Array
from ..model.elements import Joint, Link, Robot
from ..model.kinematics import link_poses
from ..model.part import Part
from ..model.pose import get_origin_at, make_pose
from ..model.provenance import NOWHERE
from ..model.world import WORLD
from ..source.location import Place
from .bodies import Bodies, Body, find_locked_joints
from .difference import Comparison, Difference
from .mesh_measure import MeshMeasures
from .names import NameMap, match_names


@dataclass
class Pair:
    """Two robots, and the names of the parts of one in the other.

    Attributes:
        a: Bodies of the first robot.
        b: Bodies of the second.
        joints: Joints of the second robot by those of the first.
        links: Links of the second robot by those of the first.
        meshes: Measured meshes of both robots.
        frames: Of each body of the first robot that was compared, the body of the second and the
            pose of its frame in that of the first, 4 × 4.
        parts: Given names of parts to which blocks for simulators refer.
    """

    a: Bodies
    b: Bodies
    joints: dict[str, str]
    links: dict[str, str]
    meshes: MeshMeasures = field(default_factory=MeshMeasures)
    frames: dict[str, tuple[str, Array]] = field(default_factory=dict)
    parts: Mapping[str, str] = field(default_factory=dict)

    @property
    def formats(self) -> tuple[str, str]:
        """Return the names of the formats of both robots."""
        return self.a.robot.format, self.b.robot.format

    def match_members(self, one: Body, two: Body) -> list[tuple[str, str]]:
        """Return the links of two bodies that have equal or mapped names."""
        pairs = [(name, self.links.get(name, name)) for name in one.members]
        return [(x, y) for x, y in pairs if y in two.members]


def make_pair(a: Robot, b: Robot, names: NameMap, meshes: MeshMeasures) -> Pair:
    """Return both robots as bodies; a locked joint that the other lacks counts as fixed."""
    given = a, b
    a, b, names = _release_floating(a, b, names)
    moving, moving2 = ({j.name for j in robot.joints if not j.is_fixed} for robot in (a, b))
    welded = {n for n in find_locked_joints(a) if names.joints.get(n, n) not in moving2}
    back = {new: old for old, new in names.joints.items()}
    welded2 = {n for n in find_locked_joints(b) if back.get(n, n) not in moving}
    one, two = Bodies(a, welded), Bodies(b, welded2)
    keep_root = _has_one_skipped_root(one, two)
    joints = match_names(list(one.joints), list(two.joints), names.joints)
    links = match_names(list(a.link), list(b.link), names.links)
    _match_children(a, b, joints, links)
    fixed = _find_fixed_in_one(one, two, joints, links)
    if fixed:
        one = Bodies(a, welded, kept=fixed.keys())
        two = Bodies(b, welded2, kept=fixed.values())
        joints |= fixed
    if keep_root:
        for bodies in (one, two):
            bodies.reset_root()
    for bodies, robot in zip((one, two), given, strict=True):
        if bodies.robot is not robot and robot.base is None and robot.tree.root is not None:
            bodies.is_free = bodies.is_free if robot.tree.root.name == WORLD else None
    return Pair(one, two, joints, links, meshes, parts=names.parts)


def _release_floating(a: Robot, b: Robot, names: NameMap) -> tuple[Robot, Robot, NameMap]:
    """Return both robots with the same floating joints as children of the world, and all names."""
    back = {new: old for old, new in names.links.items()}
    here, there = find_released(a, b, names.links), find_released(b, a, back)
    if not here and not there:
        return a, b, names
    joints = {**names.joints, **here, **{old: new for new, old in there.items()}}
    one, two = release(a, here, b) if here else a, release(b, there, a) if there else b
    return one, two, names._replace(joints=joints)


def _has_one_skipped_root(one: Bodies, two: Bodies) -> bool:
    """Tell whether only one of two equal roots was left out as an empty world."""
    skipped = one.root != one.top, two.root != two.top
    return one.top == two.top and skipped[0] != skipped[1]


def _match_children(a: Robot, b: Robot, joints: dict[str, str], links: dict[str, str]) -> None:
    """Match links without a counterpart whose joints have equal names."""
    known = set(links.values())
    for x in a.joints:
        y = b.joint.get(joints.get(x.name, x.name))
        if y is not None and x.child not in links and y.child not in known:
            links[x.child] = y.child


def _find_fixed_in_one(
    one: Bodies, two: Bodies, joints: dict[str, str], links: dict[str, str]
) -> dict[str, str]:
    """Return joints between the same links that are fixed in one robot and move in the other."""
    by_links = {(j.parent, j.child): j for j in two.robot.joints}
    known, found = set(joints.values()), dict[str, str]()
    for x in one.robot.joints:
        y = by_links.get((links.get(x.parent, ""), links.get(x.child, "")))
        if y is None or x.name in joints or y.name in known:
            continue
        if (x.name in one.joints and y.is_fixed) or (y.name in two.joints and x.is_fixed):
            found[x.name] = y.name
    return found


@dataclass
class Match:
    """Two bodies that are compared.

    Attributes:
        one: Body of the first robot.
        two: Body of the second.
        frame: Pose of the frame of ``two`` in that of ``one``, 4 × 4.
    """

    one: Body
    two: Body
    frame: Array


def locate(part: Part | None, owner: Part | None) -> Place:
    """Return the place of a part, or that of its owner if it is None or generated."""
    for candidate in (part, owner):
        if candidate is not None and candidate.provenance is not None:
            return candidate.place
    return NOWHERE


def add_presence(
    comparison: Comparison,
    row: str,
    kind: str,
    what: str,
    side: int,
    part: Part,
    name: str,
    value: object,
    *,
    other: Part | None = None,
    counterpart: str = "",
    owners: tuple[str, ...] = (),
    is_convention: bool = False,
) -> None:
    """Record a part that only one robot has."""
    here, there = locate(part, None), locate(other, None)
    names = (name, counterpart) if side == 0 else (counterpart, name)
    values = (value, None) if side == 0 else (None, value)
    places = (here, there) if side == 0 else (there, here)
    difference = Difference(row, kind, names, what, values, "", float("inf"), places, owners=owners)
    comparison.add(replace(difference, is_convention=is_convention))


def find_released(a: Robot, b: Robot, links: Mapping[str, str]) -> dict[str, str]:
    """Return floating joints inside of a robot whose child is free in the world of the other.

    Args:
        a: The robot.
        b: The other.
        links: Names of links in the other by those in the robot.

    Returns:
        Names of the joints of the other by those of the robot.
    """
    free = {j.child: j.name for j in b.joints if j.type == "floating" and j.parent == WORLD}
    inner = [j for j in a.joints if j.type == "floating" and j.parent != WORLD]
    found = ((joint.name, free.get(links.get(joint.child, joint.child))) for joint in inner)
    return {name: other for name, other in found if other is not None}


def release(robot: Robot, names: Iterable[str], other: Robot) -> Robot:
    """Return a robot whose floating joints of some names are children of the world.

    The root then is a tree of the world, too. It is fixed or free as the base of the robot is; if
    that is unknown, as the root of the other robot.
    """
    root, poses = robot.tree.root, link_poses(robot)
    if root is None:
        return robot
    base = robot.base
    start = make_pose(None if base is None else base.origin)
    chosen = set(names)
    joints = [
        replace(j, parent=WORLD, origin=get_origin_at(start @ poses[j.child], j.provenance))
        if j.name in chosen
        else j
        for j in robot.joints
    ]
    if root.name == WORLD:
        return replace(robot, joints=joints)
    anchor = next((j.type for j in other.joints if j.parent == WORLD and j.child == root.name), "")
    is_fixed = anchor == "fixed" if base is None else not base.is_free
    kind = "fixed" if is_fixed else "floating"
    origin = None if base is None else base.origin
    first = Joint(robot.provenance, f"{root.name}_floating", kind, WORLD, root.name, origin=origin)
    links = [Link(robot.provenance, WORLD), *robot.links]
    return replace(robot, links=links, joints=[first, *joints], base=None)
