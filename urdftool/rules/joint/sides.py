"""The left and the right of a robot: where their joints are, and how they move."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Joint, Robot
from ..rule import INFO, Problem, rule
from ..sides import Pair, Sides, family_of, sides


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco": "place the joint as written: the robot is crooked",
    },
)
def joint_not_mirrored(robot: Robot) -> Iterator[Problem]:
    """A joint is not where the mirror image of its twin is.

    Left and right are told by the names of the links. It is said of robots of which most such pairs
    mirror each other, of joints that move, and of the first from which a limb is off, not of those
    below.
    """
    for pair, gap in sides(robot).off:
        right = pair.right_joint
        yield Problem(
            right,
            f"joint '{right.name}' is {gap * 1000:.3g} mm from where '{pair.left_joint.name}' has "
            "its mirror image; one of the two is misplaced",
            at=right.origin or right,
        )


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
    """A joint and its twin of the other side do not move alike.

    Left and right are told by the names of the links. Where both axes turn mirrored, the limits are
    the same; where one turns the other way, they are swapped with the other sign. An axis that was
    flipped alone, or limits that were, break that. ``tolerance`` [rad or m] is the difference that
    is let pass. More than ``together`` such joints are one finding.
    """
    found = sides(robot)
    if found.normal is None:
        return
    problems = list(_unlike(found, tolerance))
    if len(problems) > together:
        names = ", ".join(f"'{problem.name}'" for problem in problems[1:])
        problems[0].message += f"; the same is true of {names}"
        del problems[1:]
    yield from problems


def _unlike(found: Sides, tolerance: float) -> Iterator[Problem]:
    for pair in found.pairs:
        alike = found.turns_alike(pair)
        left, right = _range(pair.left_joint), _range(pair.right_joint)
        if alike is None or left is None or right is None:
            continue
        opposite = (-left[1], -left[0])
        wanted, other = (left, opposite) if alike else (opposite, left)
        if _near(right, wanted, tolerance):
            continue
        name, twin = pair.right_joint.name, pair.left_joint.name
        low, high = wanted
        if _near(right, other, tolerance):
            what = "its axis or its limits have the wrong sign"
        else:
            what = f"the mirror image of '{twin}' goes from {low:g} to {high:g}"
        yield Problem(
            pair.right_joint,
            f"joint '{name}' goes from {right[0]:g} to {right[1]:g} and is not the mirror image of "
            f"'{twin}': {what}",
            at=pair.right_joint.limit,
        )


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": (
            "keep the axis: the same command turns one of them the other way"
        ),
    },
)
def axis_against_others(robot: Robot) -> Iterator[Problem]:
    """A joint's axis points the other way than those of its likes.

    Four legs, or wheels, have joints of one kind, told by their names. Where three of four axes
    point one way, or one of two sides is turned and the other is not, one was flipped.
    """
    found = sides(robot)
    if found.normal is None:
        return
    families: dict[str, list[Pair]] = {}
    for pair in found.pairs:
        if pair.left_joint.has_axis and found.turns_alike(pair) is not None:
            families.setdefault(family_of(pair.left_joint.name), []).append(pair)
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
                f"axis of joint '{joint.name}' is to that of '{twin.name}' not as those of {names} "
                "are to each other; one of them is flipped",
                at=joint.axis or joint,
            )


def _odd(found: Sides, pair: Pair, pairs: list[Pair]) -> Joint:
    """The one joint whose axis, as it stands, no other of its kind has; else the right one."""
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
