"""Find links that interpenetrate: with joints at rest, and when a joint moves."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...diagnostic import Severity
from ...model.elements import Joint, Link, Mesh, Robot
from ...model.kinematics import MOVABLE, compute_motion, get_limits
from ...model.pose import IDENTITY, Pose, compute_dot, make_pose, rotate
from ...model.read import parse_numbers
from ...model.settings import is_set
from ...source.description import Description
from ..mujoco import reads_collisions
from ..rule import GAZEBO, INFO, WARNING, Problem, rule
from ..tree.mounted import is_mobile
from ..words import join_some, quote
from .convex_bodies import ConvexBodies, compute_depth, get_bodies_at_zero, get_convex_bodies
from .exact_contact import find_contact
from .intended_overlap import find_centered_joints, remove_intended

APPLIES_TO = ("collision",)

STEPS = 9
"""Number of positions at which a joint is checked within its range."""

RESTING = 10_000
"""Largest number of pairs of bodies that are checked with joints at rest. Chosen, no source."""

TRIES = 6000
"""Largest number of pairs of bodies whose convex pieces are compared. Chosen, no source."""

PAIRS = 150_000
"""Largest number of pairs of bodies, a joint apart, whose distance is computed. Chosen, no source.
"""

_Pair = tuple[Link, Link, float]
"""Two links that overlap, and the depth [m]."""


@rule(
    INFO,
    raised={"moveit": WARNING},
    effects={
        "moveit": (
            "finds the start state in collision and plans nothing, unless the SRDF disables the "
            "pair"
        ),
        "mujoco (loaded)": (
            "makes contact between the two from the first step, if it loads the robot"
        ),
    },
)
def self_collision_at_zero(
    robot: Robot,
    description: Description,
    targets: frozenset[str],
    *,
    deeper: float = 0.001,
    deep: float = 0.02,
) -> Iterator[Problem]:
    """Two links that no joint connects overlap with all joints at zero.

    A motion planner finds the start state in collision, and MuJoCo makes contact between the links
    from the first step. Links that are fixed to each other count as one, and links that share a
    joint may overlap. Not reported are pairs that an SRDF next to the file disables, the stages of
    a telescope, and parts inside a link that encloses several, such as a safety box. A mesh counts
    as its convex hull, as in MuJoCo, which may overlap by a centimeter; the meshes themselves,
    which MoveIt compares, may be apart. A joint whose range excludes zero is in the middle of its
    range, as in MoveIt, and the message names it; MuJoCo starts it at zero. ``deeper`` [m] is the
    tolerated overlap. One finding counts the pairs, the deepest first, and a second one the pairs
    that include the convex hull of a mesh. It is a warning if the center of a link is in another of
    similar size, and the overlap is more than ``deep`` [m]. Other overlaps are reported for the
    targets MoveIt and MuJoCo; those of a robot that drives, walks or flies if MuJoCo reads its
    collisions, or if it has an SRDF.
    """
    loaded = ("mujoco (loaded)",) if reads_collisions(robot) else ()
    found = remove_intended(robot, description, find_resting_overlaps(robot, deeper))
    exact = [pair for pair in found if not any(map(has_mesh, pair[:2]))]
    hulls = _place_at_zero(robot, [pair for pair in found if pair not in exact], deeper)
    started = _place_at_zero(robot, exact, deeper) if loaded else []
    planned = ("moveit",) if "moveit" in targets or not is_mobile(robot) else ()
    keys = (*planned, *(loaded if started else ()))
    for pairs, what, readers in (
        (exact if planned or not loaded else started, "links", keys),
        (hulls if loaded else [], "the convex hulls of links", loaded),
    ):
        pairs.sort(key=lambda pair: -pair[2])
        inside = [pair for pair in pairs if pair[2] > deep and _is_inside(robot, *pair[:2])]
        if inside:
            yield _report_overlap(robot, inside, readers, what, WARNING)
        rest = [pair for pair in pairs if pair not in inside]
        # of MoveIt the hulls say nothing; without a known reader, no reader acts
        if rest and readers and not targets.isdisjoint(("moveit", "mujoco")):
            yield _report_overlap(robot, rest, readers, what, None if "moveit" in readers else INFO)


def _place_at_zero(robot: Robot, pairs: list[_Pair], deeper: float) -> list[_Pair]:
    """Compute overlaps with all joints at zero, where a joint between two links is elsewhere."""
    known = get_bodies_at_zero(robot)
    found = []
    for pair in pairs:
        if find_centered_joints(robot, [pair]):
            bodies = [known.body_of.get(link.name, link.name) for link in pair[:2]]
            placed = known.find_deepest_overlap(bodies[0], bodies[1], least=deeper)
        else:
            placed = pair
        if placed is not None:
            found.append(placed)
    return found


def _is_inside(robot: Robot, one: Link, other: Link, core: float = 0.5) -> bool:
    """Tell whether the center of one link is deep in the other, of a similar size.

    ``core`` is the depth as a part of the half width.
    """
    pieces = [get_convex_bodies(robot).get_pieces_of(end) for end in (one, other)]
    return any(
        0.5 < piece.radius / around.radius < 2
        and compute_depth(around, piece.pose.translation) > core
        for first, second in (pieces, pieces[::-1])
        for piece in first
        for around in second
    )


def has_mesh(link: Link) -> bool:
    """Tell whether a collision of a link is a mesh."""
    return any(isinstance(collision.geometry, Mesh) for collision in link.collisions)


def _report_overlap(
    robot: Robot,
    pairs: list[_Pair],
    effects: tuple[str, ...],
    what: str,
    severity: Severity | None = None,
) -> Problem:
    """Report the pairs of links that overlap, the deepest at the second link."""
    _, other, depth = pairs[0]
    joints = find_centered_joints(robot, pairs) if "moveit" in effects else []
    where = "with all joints at zero"
    if joints:
        where = f"with {quote(joints)} in the middle of the range and other joints at zero"
    if len(pairs) == 1:
        message = f"{what} {_format_pairs(pairs)} overlap by up to {depth * 1000:.3g} mm {where}"
    else:
        message = (
            f"{len(pairs)} pairs of {what.removeprefix('the ')} overlap {where}, by up to "
            f"{depth * 1000:.3g} mm: {_format_pairs(pairs)}"
        )
    names = [[one.name, other.name] for one, other, _ in pairs]
    data = {"pairs": names, "depth": depth}
    at = other.collisions[0]
    return Problem(other, message, at=at, effects=effects, data=data, severity=severity)


def _format_pairs(found: list[_Pair]) -> str:
    return join_some([f"'{one.name}' and '{other.name}'" for one, other, _ in found], "pairs")


def find_resting_overlaps(robot: Robot, deeper: float = 0.001) -> list[tuple[Link, Link, float]]:
    """Find pairs of links that no joint connects and that overlap at rest, with the depth [m]."""

    def compute() -> tuple[list[tuple[Link, Link, float]], bool]:
        known = get_convex_bodies(robot)
        pairs, complete = (
            known.find_candidate_pairs(RESTING) if _has_known_poses(robot) else ([], True)
        )
        deepest = (known.find_deepest_overlap(one, other, least=deeper) for one, other in pairs)
        return [found for found in deepest if found is not None], complete

    return robot.memo.get(_RESTING, compute)[0]


_RESTING, _SWEPT = "overlaps at rest", "overlaps in motion"


def _has_known_poses(robot: Robot) -> bool:
    """Tell whether all joint origins have three numbers; readers differ for others."""
    origins = (joint.origin.element for joint in robot.joints if joint.origin is not None)
    texts = (element.get(name) for element in origins for name in ("xyz", "rpy"))
    return all(text is None or parse_numbers(text, 3) is not None for text in texts)


def is_partly_checked(robot: Robot) -> bool:
    """Tell whether only some pairs were checked, because too many links are near each other."""
    resting = robot.memo.peek(_RESTING)
    return resting is not None and not resting[1]


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "create contacts between the two links from the first step (they keep self_collide)"
        ),
    },
)
def self_collide_at_spawn(robot: Robot, *, together: float = 4) -> Iterator[Problem]:
    """Links that overlap at rest have self-collision enabled.

    With ``<self_collide>true</self_collide>`` Gazebo creates contacts between the links of a robot.
    Two links that overlap at spawn are pushed apart, and the robot moves or diverges. Gazebo
    compares the triangles of meshes, so links are not reported whose convex hulls overlap while
    their surfaces are apart. More than ``together`` pairs are one finding.
    """
    whole = is_set(robot.settings, "self_collide")
    enabled = {link.name for link in robot.links if is_set(link.settings, "self_collide", whole)}
    found = [
        (one, other, depth)
        for one, other, depth in find_resting_overlaps(robot)
        if one.name in enabled and other.name in enabled
        if not (has_mesh(one) or has_mesh(other)) or find_contact(robot, one, other)
    ]
    many = len(found) > together
    more = f"; so do {_format_pairs(found[1:])}" if many else ""
    for one, other, depth in found[:1] if many else found:
        yield Problem(
            other,
            f"links '{one.name}' and '{other.name}' overlap{_format_depth(one, other, depth)} at "
            f"spawn and have self_collide enabled, so Gazebo creates contacts{more}",
            at=other.collisions[0],
        )


def _format_depth(one: Link, other: Link, depth: float) -> str:
    """Format the depth of an overlap [m]; empty if it is that of convex hulls of meshes."""
    return "" if has_mesh(one) or has_mesh(other) else f" by {depth * 1000:.3g} mm"


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco": "place both links there",
    },
)
def link_inside_parent(
    robot: Robot, *, core: float = 0.5, together: float = 4
) -> Iterator[Problem]:
    """A link is in the middle of its parent link.

    Links that share a joint overlap at the joint, not with their centers. Usually the ``<origin>``
    of the joint was lost, so that the child is at the frame of its parent. Joints with an
    ``<origin>``, even ``0 0 0``, are not reported, nor joints at right angles to the joint before,
    as in a wrist. It is reported if the center of the child's collision is deeper inside the
    parent's than ``core`` of the parent's half width, and both have similar sizes. More than
    ``together`` such joints are one finding.
    """
    known = get_convex_bodies(robot)
    found = []
    for joint in robot.joints:
        if joint.type not in MOVABLE or joint.child not in known.poses:
            continue
        if joint.origin is not None and "xyz" in joint.origin.element.attributes:
            continue
        if _is_across(known, joint):
            continue
        depth, parent = _compute_center_depth(known, joint, IDENTITY)
        if depth > core and parent is not None:
            found.append((joint, parent))
    many = len(found) > together
    names = join_some([f"'{joint.name}'" for joint, _ in found[1:]], "joints")
    for joint, parent in found[:1] if many else found:
        yield Problem(
            joint,
            f"joint '{joint.name}' places link '{joint.child}' in the middle of '{parent.name}'; "
            f"add its <origin>{f'. The same holds for {names}' if many else ''}",
            at=joint.origin or joint,
        )


def _is_across(known: ConvexBodies, joint: Joint) -> bool:
    """Tell whether a joint axis is at right angles to that of the moving joint before it."""
    before = known.robot.tree.get_parent_joint(joint.parent)
    while before is not None and before.is_fixed:
        before = known.robot.tree.get_parent_joint(before.parent)
    if before is None or before.child not in known.poses:
        return False
    one, other = (
        rotate(known.poses[each.child].rotation, each.axis.xyz if each.axis else (1.0, 0.0, 0.0))
        for each in (before, joint)
    )
    return abs(compute_dot(one, other)) < 0.1 * math.hypot(*one) * math.hypot(*other)


def _compute_center_depth(
    known: ConvexBodies, joint: Joint, moved: Pose
) -> tuple[float, Link | None]:
    """Compute how deep the center of a joint's child is in its parent, in half widths of it.

    The result is negative outside, and 1 at the center. Children much smaller than the parent are
    skipped, because they may be built into it.
    """
    best: tuple[float, Link | None] = (-1.0, None)
    own = known.robot.link[joint.child]
    for link, piece in known.bodies.get(known.body_of.get(joint.child, joint.child), ()):
        if link is not own:
            continue
        at = moved.transform(piece.pose.translation)
        for parent, around in known.bodies.get(known.body_of.get(joint.parent, joint.parent), ()):
            if not 0.5 < piece.radius / around.radius < 2:
                continue
            depth = compute_depth(around, at)
            if depth > best[0]:
                best = depth, parent
    return best


@rule(
    INFO,
    default=False,
    effects={
        "mujoco (contact)": "makes contact, which stops the joint before its limit",
        "mujoco (neighbors)": (
            "lets the two links interpenetrate: it makes no contact between parent and child"
        ),
    },
)
def self_collision_in_range(robot: Robot, *, deeper: float = 0.01) -> Iterator[Problem]:
    """A joint moves a link into a link near its base, within its limits.

    Many arms can collide with themselves, which planners avoid. But if a single joint, with all
    others at rest, moves a link into a body at most two joints above it, its limits are too wide,
    or its origin or axis is wrong. Each joint is checked at nine positions between its limits; a
    mesh counts as its convex hull. ``deeper`` [m] is the tolerated overlap. One finding names the
    joints, and a second one those whose two links are parent and child. For a robot with very many
    links only the first joints are checked, which ``analysis-incomplete`` reports.
    """
    known = get_convex_bodies(robot)
    taken = {
        frozenset((known.body_of[a.name], known.body_of[b.name]))
        for a, b, _ in find_resting_overlaps(robot)
    }
    found = []
    skipped: list[Joint] = []
    tries = pairs = 0
    for joint in robot.joints:
        if joint.type not in MOVABLE or joint.mimic is not None:
            continue
        if joint.child not in known.poses or joint.parent not in known.poses:
            continue
        if tries > TRIES or pairs > PAIRS:
            skipped.append(joint)
            continue
        below = sum(1 for _ in robot.tree.list_descendants(joint.child)) + 1
        pairs += below * max(len(known.bodies) - below, 1)
        met, count = _sweep(known, joint, taken, deeper)
        tries += count
        if met is not None:
            found.append((joint, *met))
    robot.memo.get(_SWEPT, lambda: skipped)
    alike: dict[str, list[tuple[Joint, Link, Link, float]]] = {}
    for hit in found:
        alike.setdefault(_select_case(known, hit[1], hit[2]), []).append(hit)
    for case, hits in alike.items():
        joint, one, other, where = hits[0]
        unit = "m" if joint.type == "prismatic" else "rad"
        others = [f"'{j.name}' ('{a.name}' into '{b.name}')" for j, a, b, _ in hits[1:]]
        more = f"; also {join_some(others, 'joints')}"
        yield Problem(
            joint,
            f"joint '{joint.name}' can move link '{one.name}' into '{other.name}', at "
            f"{where:.3g} {unit}; reduce its limits{more if len(hits) > 1 else ''}",
            at=joint.limit or joint,
            effects=(f"mujoco ({case})",) if reads_collisions(robot) else (),
        )


def _select_case(known: ConvexBodies, one: Link, other: Link) -> str:
    """Select the case of MuJoCo: no contact of parent and child, unless the parent is world."""
    body, carrier = known.body_of[one.name], known.body_of[other.name]
    is_root = known.robot.tree.get_parent_joint(carrier) is None
    return "neighbors" if _find_carrier(known, body) == carrier and not is_root else "contact"


def get_skipped_joints(robot: Robot) -> list[Joint]:
    """List the joints that were not checked in motion, because there are too many."""
    skipped: list[Joint] | None = robot.memo.peek(_SWEPT)
    return skipped or []


def _sweep(
    known: ConvexBodies, joint: Joint, taken: set[frozenset[str]], deeper: float
) -> tuple[tuple[Link, Link, float] | None, int]:
    """Find the first two links that overlap as one joint moves, the position, and pairs tried."""
    robot, rest = known.robot, known.rest.get(joint.name, 0.0)
    moving = {joint.child, *robot.tree.list_descendants(joint.child)}
    bodies = {known.body_of.get(name, name) for name in moving}
    inside = [body for body in known.bodies if body in bodies]
    along = known.find_followers(joint)  # mimic joints move at the same time
    outside = [body for body in known.bodies if body not in bodies and body not in along]
    at = known.poses[joint.parent] @ make_pose(joint.origin)
    back = (at @ compute_motion(joint, rest)).invert()
    excluded = known.neighbors | taken
    carrier = known.body_of[joint.parent]
    partners = {
        one: [
            (other, *known.spheres[other])
            for other in outside
            if frozenset((one, other)) not in excluded
            and carrier in (other, _find_carrier(known, one))
            and _find_carrier(known, _find_carrier(known, one)) == other
        ]
        for one in inside
    }
    into = _compute_center_depth(known, joint, IDENTITY)[0] <= 0
    count = 0
    for value in _get_positions(joint, rest):
        moved = at @ compute_motion(joint, value) @ back
        if into:
            depth, link = _compute_center_depth(known, joint, moved)
            if depth > 0.3 and link is not None:
                return (robot.link[joint.child], link, value), count
        for one in inside:
            middle, radius = known.spheres[one]
            there = moved.transform(middle)
            for other, place, reach in partners[one]:
                if math.dist(there, place) >= radius + reach:
                    continue
                count += 1
                deepest = known.find_deepest_overlap(one, other, moved, deeper)
                if deepest is not None:
                    return (deepest[0], deepest[1], value), count
    return None, count


def _find_carrier(known: ConvexBodies, body: str) -> str:
    """Find the body that carries a body with a joint; empty for the root."""
    joint = known.robot.tree.get_parent_joint(body)
    return "" if joint is None else known.body_of.get(joint.parent, "")


def _get_positions(joint: Joint, rest: float) -> list[float]:
    lower, upper = get_limits(joint)
    if not (math.isfinite(lower) and math.isfinite(upper)) or upper - lower > 2 * math.pi:
        if joint.type == "prismatic":
            return []
        lower, upper = rest - math.pi, rest + math.pi
    if upper <= lower:
        return []
    return [lower + (upper - lower) * step / (STEPS - 1) for step in range(STEPS)]
