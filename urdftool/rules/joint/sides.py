"""Rules on the symmetry of joints on the left and right side of a robot."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from ...model.elements import Joint, Robot, Vector
from ..rule import ANY_FORMAT, INFO, WARNING, Problem, rule
from ..symmetry import Pair, Sides, get_family, get_sides
from ..words import join_some, quote
from .idle import moves_nothing


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco": "place the joint as written",
    },
    group="robot",
    formats=ANY_FORMAT,
)
def joint_not_mirrored(robot: Robot, *, small: float = 0.01) -> Iterator[Problem]:
    """A joint is not at the mirror image of the corresponding joint on the other side.

    Left and right are recognized by link names; ambiguous names are not compared. Reported are
    joints that move, of robots where most pairs are symmetric. Only the first displaced joint of a
    limb is reported. Limbs whose joints have the same ``<origin>`` on both sides are copies, and
    not reported, neither is a displacement that the next joint takes back, or that takes back one,
    nor two joints of one link that are mirror images in its own frame, as in a turned gripper, nor
    a joint that is the mirror image of a sibling of the other: a gripper that is mounted twice.
    Up to ``small`` [m] it is an info.
    """
    sides = get_sides(robot)
    for pair, gap in sides.off:
        right = pair.right_joint
        if right.is_fixed or sides.is_taken_back(pair) or sides.is_mirrored_in_root(pair):
            continue
        if sides.is_mirrored_in_parent(pair) or sides.is_image_of_sibling(robot, pair):
            continue
        if right.parent != pair.left_joint.parent and _has_the_same_origin(pair):
            continue
        yield Problem(
            right,
            f"joint '{right.name}' is {gap * 1000:.3g} mm from the mirror image of "
            f"'{pair.left_joint.name}'; correct the origin of one of them",
            at=right.origin or right,
            severity=INFO if gap <= small else WARNING,
            data={"twin": pair.left_joint.name, "distance": gap},
        )


def _has_the_same_origin(pair: Pair) -> bool:
    one, other = pair.left_joint.origin, pair.right_joint.origin
    if one is None or other is None:
        return one is other
    return all(
        math.isclose(a, b, abs_tol=_ROUNDED)
        for a, b in zip((*one.xyz, *one.rpy), (*other.xyz, *other.rpy), strict=True)
    )


_ROUNDED = 1e-5
"""Difference [m or rad] of two numbers that an exporter rounded differently. Chosen, no source."""


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "keep the two ranges as written"
        ),
    },
    pedantic="ranges of equal width, which differ in where the zero is",
    infos=True,
    formats=ANY_FORMAT,
)
def limits_not_mirrored(
    robot: Robot, *, tolerance: float = 0.03, together: float = 3
) -> Iterator[Problem]:
    """A joint and the corresponding joint on the other side have ranges that are not symmetric.

    Left and right are recognized by link names. If both axes are mirrored, the limits must be
    equal; if one axis is reversed, the limits must be negated and swapped. Usually one axis or one
    pair of limits has the wrong sign. Gripper joints with equal limits are copies, and not
    reported, neither are displaced joints, joints that move no mass or geometry, and a mimic joint
    whose range has all positions that its leader asks of it. ``tolerance``
    [rad or m] is the difference that is ignored. More than ``together`` such joints are one
    finding, those with a wrong sign apart from the others, whose mirrored ranges are written.
    Two ranges of equal width differ only in the zero of a joint, usually by a calibration.
    """
    found = get_sides(robot)
    if found.normal is None:
        return
    kinds: dict[tuple[bool, bool], list[_Unlike]] = {}
    for one in _find_asymmetric_ranges(robot, found, tolerance):
        kinds.setdefault((one.has_wrong_sign, bool(one.shift)), []).append(one)
    for unlike in kinds.values():
        yield from _report_ranges(unlike, together)


class _Unlike(NamedTuple):
    """A pair of joints whose ranges are not symmetric."""

    pair: Pair
    expected: tuple[float, float]
    """Range that mirrors the left joint [rad or m]."""
    right: tuple[float, float]
    has_wrong_sign: bool
    """Whether the other sign of the axis makes the ranges symmetric."""
    shift: float
    """Displacement of a range that is as wide [rad or m]; 0 if the widths differ."""


def _report_ranges(unlike: list[_Unlike], together: float) -> Iterator[Problem]:
    """Report pairs of one diagnosis; many as one finding, with the range that each should have."""
    many = len(unlike) > together
    for one in unlike[:1] if many else unlike:
        joint, (low, high) = one.pair.right_joint, one.expected
        what = f"the mirrored range is {low:g} to {high:g}"
        if one.shift:
            what += f", as wide and displaced by {one.shift:.3g}"
        if one.has_wrong_sign:
            what = "its axis or its limits have the wrong sign"
        message = (
            f"range {one.right[0]:g} to {one.right[1]:g} of joint '{joint.name}' is not the mirror "
            f"image of the range of '{one.pair.left_joint.name}': {what}"
        )
        if many and one.has_wrong_sign:
            names = ", ".join(f"'{other.pair.right_joint.name}'" for other in unlike[1:])
            message += f"; the same applies to {names}"
        elif many:
            shown = [
                f"'{other.pair.right_joint.name}' ({other.expected[0]:g} to {other.expected[1]:g})"
                for other in unlike[1:]
            ]
            message += f"; also {join_some(shown, 'joints')}"
        data = {"twin": one.pair.left_joint.name, "mirrored": list(one.expected)}
        yield Problem(joint, message, at=joint.limit, data=data, pedantic=bool(one.shift))


_GRIPPER = re.compile(r"gripper|finger|thumb|knuckle", re.IGNORECASE)


def _covers_demand(robot: Robot, joint: Joint, limits: tuple[float, float]) -> bool:
    """Tell whether the range of a mimic joint [rad or m] has all positions that its leader asks."""
    mimic = joint.mimic
    leader = robot.joint.get(mimic.joint) if mimic is not None else None
    demand = _get_range(leader) if leader is not None else None
    if mimic is None or demand is None:
        return False
    ends = [mimic.multiplier * end + mimic.offset for end in demand]
    return limits[0] <= min(ends) and max(ends) <= limits[1]


def _find_asymmetric_ranges(robot: Robot, found: Sides, tolerance: float) -> Iterator[_Unlike]:
    """Find pairs of joints with ranges that are not symmetric."""
    for pair in found.pairs:
        if found.is_displaced(pair):
            continue
        if any(moves_nothing(robot, one, 0) for one in (pair.left_joint, pair.right_joint)):
            continue
        alike = found.is_mirrored_at_equal_positions(pair)
        left, right = _get_range(pair.left_joint), _get_range(pair.right_joint)
        if alike is None or left is None or right is None:
            continue
        opposite = (-left[1], -left[0])
        expected, other = (left, opposite) if alike else (opposite, left)
        if _is_near(right, expected, tolerance):
            continue
        if _covers_demand(robot, pair.right_joint, right):
            continue
        if _is_near(right, left, tolerance) and _GRIPPER.search(pair.right_joint.name):
            continue
        wrong = _is_near(right, other, tolerance)
        shifts = [mine - its for mine, its in zip(right, expected, strict=True)]
        shifted = not wrong and abs(shifts[1] - shifts[0]) <= 0.1 * tolerance
        yield _Unlike(pair, expected, right, wrong, sum(shifts) / 2 if shifted else 0.0)


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": (
            "keep the axis: the same command turns one of them in the opposite direction"
        ),
    },
    pedantic="a pair of joints with symmetric limits that is alone of its kind, without wheels",
    formats=ANY_FORMAT,
)
def axis_against_others(robot: Robot) -> Iterator[Problem]:
    """The axis of a joint is reversed compared with similar joints.

    Legs or wheels have joints of the same kind, recognized by their names. If three of four axes
    have one direction, or a pair of sides differs from the other pairs, one axis is reversed.

    A pair that is the only one of its kind is compared with the other pairs of its limb, or of the
    robot if the limb has fewer than two: in some robots the axes of left and right are parallel, in
    others they are mirror images. Only axes of similar direction are compared, such as those across
    the robot, and wheels only with wheels. Asymmetric limits show the intended direction; such a
    pair is not reported. With symmetric limits the sign is a convention unless it drives a wheel.
    """
    found = get_sides(robot)
    if found.normal is None:
        return
    families: dict[tuple[str, str, bool], list[Pair]] = {}
    for pair in found.pairs:
        if pair.left_joint.has_axis and found.is_mirrored_at_equal_positions(pair) is not None:
            axis = found.get_axis(pair.left, pair.left_joint) or (0.0, 0.0, 0.0)
            across = abs(axis[found.normal]) > 0.5  # excludes steering joints
            kind = get_family(pair.left_joint.name), pair.left_joint.type, across
            families.setdefault(kind, []).append(pair)
    for pairs in families.values():
        alike = [pair for pair in pairs if found.is_mirrored_at_equal_positions(pair)]
        unlike = [pair for pair in pairs if not found.is_mirrored_at_equal_positions(pair)]
        if not alike or not unlike:
            continue
        for pair in min((alike, unlike), key=len):
            joint = _choose_unique(found, pair, pairs)
            pair = next(p for p in pairs if joint in (p.left_joint, p.right_joint))
            twin = pair.left_joint if joint is pair.right_joint else pair.right_joint
            other = next(other for other in pairs if (other in alike) != (pair in alike))
            names = f"'{other.left_joint.name}' and '{other.right_joint.name}'"
            yield Problem(
                joint,
                f"axis of joint '{joint.name}' is reversed relative to '{twin.name}', compared "
                f"with {names}; check the sign of one axis",
                at=joint.axis or joint,
                data={"twin": twin.name},
            )
    yield from _report_single_pairs(robot, found)
    yield from _report_reversed_copies(found)


def _report_reversed_copies(found: Sides) -> Iterator[Problem]:
    """Report joints of copied limbs whose axes are opposite, unlike two thirds of these axes."""
    copies = [(one, pair) for pair in found.pairs if (one := found.compare_copies(pair))]
    unlike = [pair for sign, pair in copies if sign < 0]
    if 3 * len(unlike) <= len(copies):
        for left, right in ((pair.left_joint, pair.right_joint) for pair in unlike):
            yield Problem(
                right,
                f"axis of joint '{right.name}' is reversed relative to '{left.name}', but the two "
                "limbs are copies; check the sign of one axis",
                at=right.axis or right,
                data={"twin": left.name},
            )


class _AxisPair(NamedTuple):
    """Unit axes of a pair of joints, in the frame of the root."""

    pair: Pair
    left: Vector
    right: Vector
    wheel: bool
    """Whether the joints are continuous and move no other joint."""

    @property
    def same(self) -> bool:
        """Whether the two axes have the same direction."""
        return _compute_dot(self.left, self.right) > 0


def _compute_dot(one: Vector, other: Vector) -> float:
    return sum(a * b for a, b in zip(one, other, strict=True))


def _report_single_pairs(robot: Robot, found: Sides) -> Iterator[Problem]:
    """Report pairs that are alone of their kind and differ from every comparable pair."""
    turns = [turn for pair in found.pairs if (turn := _make_axis_pair(robot, found, pair))]
    kinds = Counter(get_family(turn.pair.left_joint.name) for turn in turns)
    for turn in turns:
        pair = turn.pair
        if kinds[get_family(pair.left_joint.name)] > 1 or _has_asymmetric_limits(pair):
            continue
        votes = [
            (other, agrees)
            for other in turns
            if other is not turn
            and other.wheel == turn.wheel
            and (agrees := _has_same_relation(turn, other, found.normal or 0)) is not None
        ]
        limb = _find_limb(robot, found, pair)
        near = [vote for vote in votes if id(vote[0].pair) in limb]
        votes = near if len(near) > 1 else votes
        if len(votes) < 2 or any(agrees for _, agrees in votes):
            continue
        joint = _choose_reversed(turn, [other for other, _ in votes], found.normal or 0)
        twin = pair.left_joint if joint is pair.right_joint else pair.right_joint
        names = quote(other.pair.left_joint.name for other, _ in votes)
        yield Problem(
            joint,
            f"axis of joint '{joint.name}' is reversed relative to '{twin.name}', compared with "
            f"the pairs of {names}; check the sign of one axis",
            at=joint.axis or joint,
            pedantic=not turn.wheel,
            data={"twin": twin.name},
        )


def _make_axis_pair(robot: Robot, found: Sides, pair: Pair) -> _AxisPair | None:
    if found.is_mirrored_at_equal_positions(pair) is None or pair.left_joint.type not in (
        "revolute",
        "continuous",
    ):
        return None
    left = found.get_axis(pair.left, pair.left_joint)
    right = found.get_axis(pair.right, pair.right_joint)
    if left is None or right is None:
        return None
    below = robot.tree.list_descendants(pair.left.name)
    ends = all(j.is_fixed for n in (pair.left.name, *below) for j in robot.tree.get_child_joints(n))
    return _AxisPair(pair, left, right, pair.left_joint.type == "continuous" and ends)


def _has_same_relation(one: _AxisPair, other: _AxisPair, normal: int) -> bool | None:
    """Compare the relative direction of the axes of two pairs; None if not comparable.

    Axes across the robot are compared with each other, perpendicular ones with each other, and
    oblique ones with parallel ones.
    """
    kinds = [_is_across(turn, normal) for turn in (one, other)]
    if kinds[0] is not None:
        return one.same == other.same if kinds[0] == kinds[1] else None
    left, right = _compute_dot(one.left, other.left), _compute_dot(one.right, other.right)
    return left * right > 0 if min(abs(left), abs(right)) > 0.95 else None


def _is_across(turn: _AxisPair, normal: int) -> bool | None:
    """Tell whether axes are across the robot (True) or perpendicular (False); None if oblique."""
    if abs(_compute_dot(turn.left, turn.right)) < 0.95:
        return None
    part = abs(turn.left[normal])
    return None if 0.3 < part < 0.95 else part >= 0.95


def _has_asymmetric_limits(pair: Pair) -> bool:
    """Tell whether the limits of a pair are asymmetric, so that they show a direction."""
    ranges = [_get_range(joint) for joint in (pair.left_joint, pair.right_joint)]
    return any(one is not None and not _is_near(one, (-one[1], -one[0]), 0.03) for one in ranges)


def _find_limb(robot: Robot, found: Sides, pair: Pair) -> set[int]:
    """Find the pairs above and below a pair in its limb, up to the next branch."""
    by_link = {other.left.name: other for other in found.pairs if not other.left_joint.is_fixed}
    carrier: dict[str, str] = {}
    for link in by_link:
        above = next((one for one in robot.tree.list_ancestors(link) if one in by_link), None)
        if above is not None:
            carrier[link] = above
    counts = Counter(carrier.values())
    single = {link: above for link, above in carrier.items() if counts[above] == 1}
    limb: set[int] = set()
    for step in (single, {above: link for link, above in single.items()}):
        name: str | None = step.get(pair.left.name)
        while name is not None and id(by_link[name]) not in limb:  # they may be a circle
            limb.add(id(by_link[name]))
            name = step.get(name)
    return limb


def _choose_reversed(turn: _AxisPair, others: list[_AxisPair], normal: int) -> Joint:
    """Choose the joint whose axis differs from those of all other pairs; the right one if none."""
    pair = turn.pair
    across = _is_across(turn, normal)
    if across and all(_compute_dot(turn.right, other.right) > 0 for other in others):
        return pair.left_joint
    return pair.right_joint


def _choose_unique(found: Sides, pair: Pair, pairs: list[Pair]) -> Joint:
    """Choose the joint whose axis no other joint of the kind has; the right one if none."""
    joints = [
        (joint, axis)
        for other in pairs
        for link, joint in ((other.left, other.left_joint), (other.right, other.right_joint))
        if (axis := found.get_axis(link, joint)) is not None
    ]
    for one, axis in joints:
        agree = [
            joint
            for joint, other in joints
            if sum(a * b for a, b in zip(axis, other, strict=True)) > 0
        ]
        if agree == [one]:
            return one
    return pair.right_joint


def _get_range(joint: Joint) -> tuple[float, float] | None:
    limit = joint.limit
    if not joint.is_limited or limit is None or limit.lower is None or limit.upper is None:
        return None
    if not math.isfinite(limit.upper - limit.lower):  # a slide of an MJCF without a range
        return None
    return (limit.lower, limit.upper) if limit.lower < limit.upper else None


def _is_near(one: tuple[float, float], other: tuple[float, float], tolerance: float) -> bool:
    return all(abs(a - b) <= tolerance for a, b in zip(one, other, strict=True))
