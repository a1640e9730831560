"""Rules on the symmetry of joints on the left and right side of a robot."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from ...model.elements import Joint, Link, Robot, Vector
from ..rule import INFO, Problem, rule
from ..sides import Pair, Sides, family_of, sides
from ..words import quoted


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco": "place the joint as written",
    },
    group="robot",
)
def joint_not_mirrored(robot: Robot) -> Iterator[Problem]:
    """A joint is not at the mirror image of the corresponding joint on the other side.

    Left and right are recognized by link names; ambiguous names are not compared. Reported are
    joints that move, of robots where most pairs are symmetric. Only the first displaced joint of a
    limb is reported. Limbs whose joints have the same ``<origin>`` on both sides are copies, and
    not reported.
    """
    for pair, gap in sides(robot).off:
        right = pair.right_joint
        if right.is_fixed:
            continue
        if right.parent != pair.left_joint.parent and _has_the_same_origin(pair):
            continue
        yield Problem(
            right,
            f"joint '{right.name}' is {gap * 1000:.3g} mm from the mirror image of "
            f"'{pair.left_joint.name}'; correct the origin of one of them",
            at=right.origin or right,
            data={"twin": pair.left_joint.name, "distance": gap},
        )


def _has_the_same_origin(pair: Pair) -> bool:
    one, other = pair.left_joint.origin, pair.right_joint.origin
    if one is None or other is None:
        return one is other
    return (one.xyz, one.rpy) == (other.xyz, other.rpy)


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "keep the two ranges as written"
        ),
    },
)
def limits_not_mirrored(
    robot: Robot, *, tolerance: float = 0.03, together: float = 3
) -> Iterator[Problem]:
    """A joint and the corresponding joint on the other side have ranges that are not symmetric.

    Left and right are recognized by link names. If both axes are mirrored, the limits must be
    equal; if one axis is reversed, the limits must be negated and swapped. Usually one axis or one
    pair of limits has the wrong sign. Gripper joints with equal limits are copies, and not
    reported, neither are displaced joints and joints that move no mass or geometry. ``tolerance``
    [rad or m] is the difference that is ignored. More than ``together`` such joints are one
    finding.
    """
    found = sides(robot)
    if found.normal is None:
        return
    unlike = list(_unlike(robot, found, tolerance))
    also = ""
    if len(unlike) > together:
        names = ", ".join(f"'{pair.right_joint.name}'" for pair, _, _ in unlike[1:])
        also = f"; the same applies to {names}"
    for pair, message, wanted in unlike[:1] if also else unlike:
        joint = pair.right_joint
        data = {"twin": pair.left_joint.name, "mirrored": list(wanted)}
        yield Problem(joint, message + also, at=joint.limit, data=data)


_GRIPPER = re.compile(r"gripper|finger|thumb|knuckle", re.IGNORECASE)


def _carries_nothing(robot: Robot, link: Link) -> bool:
    """Tell whether a link and its descendants have neither mass nor geometry."""
    names = (link.name, *robot.tree.descendants(link.name))
    return all(
        one.mass == 0 and not one.visuals and not one.collisions
        for one in (robot.link[name] for name in names if name in robot.link)
    )


def _unlike(
    robot: Robot, found: Sides, tolerance: float
) -> Iterator[tuple[Pair, str, tuple[float, float]]]:
    """Find pairs of joints with ranges that are not symmetric.

    Yields:
        The pair, the message about the right joint, and the range that mirrors the left joint [rad
        or m].
    """
    for pair in found.pairs:
        if found.is_displaced(pair):
            continue
        if any(_carries_nothing(robot, link) for link in (pair.left, pair.right)):
            continue
        alike = found.turns_alike(pair)
        left, right = _range(pair.left_joint), _range(pair.right_joint)
        if alike is None or left is None or right is None:
            continue
        opposite = (-left[1], -left[0])
        wanted, other = (left, opposite) if alike else (opposite, left)
        if _near(right, wanted, tolerance):
            continue
        if _near(right, left, tolerance) and _GRIPPER.search(pair.right_joint.name):
            continue
        name, twin = pair.right_joint.name, pair.left_joint.name
        low, high = wanted
        if _near(right, other, tolerance):
            what = "its axis or its limits have the wrong sign"
        else:
            what = f"the mirrored range is {low:g} to {high:g}"
        message = (
            f"range {right[0]:g} to {right[1]:g} of joint '{name}' is not the mirror image of the "
            f"range of '{twin}': {what}"
        )
        yield pair, message, wanted


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": (
            "keep the axis: the same command turns one of them in the opposite direction"
        ),
    },
)
def axis_against_others(robot: Robot) -> Iterator[Problem]:
    """The axis of a joint is reversed compared with similar joints.

    Legs or wheels have joints of the same kind, recognized by their names. If three of four axes
    have one direction, or a pair of sides differs from the other pairs, one axis is reversed.

    A pair that is the only one of its kind is compared with the other pairs of its limb, or of the
    robot if the limb has fewer than two: in some robots the axes of left and right are parallel, in
    others they are mirror images. Only axes of similar direction are compared, such as those across
    the robot, and wheels only with wheels. Asymmetric limits show the intended direction; such a
    pair is not reported.
    """
    found = sides(robot)
    if found.normal is None:
        return
    families: dict[tuple[str, str, bool], list[Pair]] = {}
    for pair in found.pairs:
        if pair.left_joint.has_axis and found.turns_alike(pair) is not None:
            axis = found.axis(pair.left, pair.left_joint) or (0.0, 0.0, 0.0)
            across = abs(axis[found.normal]) > 0.5  # excludes steering joints
            kind = family_of(pair.left_joint.name), pair.left_joint.type, across
            families.setdefault(kind, []).append(pair)
    for pairs in families.values():
        alike = [pair for pair in pairs if found.turns_alike(pair)]
        unlike = [pair for pair in pairs if not found.turns_alike(pair)]
        if not alike or not unlike:
            continue
        for pair in min((alike, unlike), key=len):
            joint = _odd(found, pair, pairs)
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
    yield from _lone(robot, found)


class _Turn(NamedTuple):
    """Unit axes of a pair of joints, in the frame of the root."""

    pair: Pair
    left: Vector
    right: Vector
    wheel: bool
    """Whether the joints are continuous and move no other joint."""

    @property
    def same(self) -> bool:
        """Whether the two axes have the same direction."""
        return _dot(self.left, self.right) > 0


def _dot(one: Vector, other: Vector) -> float:
    return sum(a * b for a, b in zip(one, other, strict=True))


def _lone(robot: Robot, found: Sides) -> Iterator[Problem]:
    """Report pairs that are alone of their kind and differ from every comparable pair."""
    turns = [turn for pair in found.pairs if (turn := _turn(robot, found, pair))]
    kinds = Counter(family_of(turn.pair.left_joint.name) for turn in turns)
    for turn in turns:
        pair = turn.pair
        if kinds[family_of(pair.left_joint.name)] > 1 or _limits_tell(pair):
            continue
        votes = [
            (other, agrees)
            for other in turns
            if other is not turn
            and other.wheel == turn.wheel
            and (agrees := _agree(turn, other, found.normal or 0)) is not None
        ]
        limb = _limb(robot, found, pair)
        near = [vote for vote in votes if id(vote[0].pair) in limb]
        votes = near if len(near) > 1 else votes
        if len(votes) < 2 or any(agrees for _, agrees in votes):
            continue
        joint = _odd_of(turn, [other for other, _ in votes], found.normal or 0)
        twin = pair.left_joint if joint is pair.right_joint else pair.right_joint
        names = quoted(other.pair.left_joint.name for other, _ in votes)
        yield Problem(
            joint,
            f"axis of joint '{joint.name}' is reversed relative to '{twin.name}', compared with "
            f"the pairs of {names}; check the sign of one axis",
            at=joint.axis or joint,
            data={"twin": twin.name},
        )


def _turn(robot: Robot, found: Sides, pair: Pair) -> _Turn | None:
    if found.turns_alike(pair) is None or pair.left_joint.type not in ("revolute", "continuous"):
        return None
    left = found.axis(pair.left, pair.left_joint)
    right = found.axis(pair.right, pair.right_joint)
    if left is None or right is None:
        return None
    below = robot.tree.descendants(pair.left.name)
    ends = all(j.is_fixed for n in (pair.left.name, *below) for j in robot.tree.child_joints(n))
    return _Turn(pair, left, right, pair.left_joint.type == "continuous" and ends)


def _agree(one: _Turn, other: _Turn, normal: int) -> bool | None:
    """Compare the relative direction of the axes of two pairs; None if not comparable.

    Axes across the robot are compared with each other, perpendicular ones with each other, and
    oblique ones with parallel ones.
    """
    kinds = [_straight(turn, normal) for turn in (one, other)]
    if kinds[0] is not None:
        return one.same == other.same if kinds[0] == kinds[1] else None
    left, right = _dot(one.left, other.left), _dot(one.right, other.right)
    return left * right > 0 if min(abs(left), abs(right)) > 0.95 else None


def _straight(turn: _Turn, normal: int) -> bool | None:
    """Tell whether axes are across the robot (True) or perpendicular (False); None if oblique."""
    if abs(_dot(turn.left, turn.right)) < 0.95:
        return None
    part = abs(turn.left[normal])
    return None if 0.3 < part < 0.95 else part >= 0.95


def _limits_tell(pair: Pair) -> bool:
    """Tell whether the limits of a pair are asymmetric, so that they show a direction."""
    ranges = [_range(joint) for joint in (pair.left_joint, pair.right_joint)]
    return any(one is not None and not _near(one, (-one[1], -one[0]), 0.03) for one in ranges)


def _limb(robot: Robot, found: Sides, pair: Pair) -> set[int]:
    """Find the pairs above and below a pair in its limb, up to the next branch."""
    by_link = {other.left.name: other for other in found.pairs if not other.left_joint.is_fixed}
    carrier: dict[str, str] = {}
    for link in by_link:
        above = next((one for one in robot.tree.ancestors(link) if one in by_link), None)
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


def _odd_of(turn: _Turn, others: list[_Turn], normal: int) -> Joint:
    """Choose the joint whose axis differs from those of all other pairs; the right one if none."""
    pair = turn.pair
    across = _straight(turn, normal)
    if across and all(_dot(turn.right, other.right) > 0 for other in others):
        return pair.left_joint
    return pair.right_joint


def _odd(found: Sides, pair: Pair, pairs: list[Pair]) -> Joint:
    """Choose the joint whose axis no other joint of the kind has; the right one if none."""
    joints = [
        (joint, axis)
        for other in pairs
        for link, joint in ((other.left, other.left_joint), (other.right, other.right_joint))
        if (axis := found.axis(link, joint)) is not None
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


def _range(joint: Joint) -> tuple[float, float] | None:
    limit = joint.limit
    if not joint.is_limited or limit is None or limit.lower is None or limit.upper is None:
        return None
    return (limit.lower, limit.upper) if limit.lower < limit.upper else None


def _near(one: tuple[float, float], other: tuple[float, float], tolerance: float) -> bool:
    return all(abs(a - b) <= tolerance for a, b in zip(one, other, strict=True))
