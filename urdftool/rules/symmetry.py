"""Find the left and right side of a robot by link names, and the plane between them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from ..model.elements import Joint, Link, Robot, Vector
from ..model.kinematics import get_zero_poses
from ..model.pose import Pose, compute_dot, make_pose, rotate
from .joint.idle import is_coordinate

_PAIRS = (
    *(("left", "right"), ("l", "r")),
    *(("fl", "fr"), ("hl", "hr"), ("rl", "rr"), ("bl", "br"), ("ml", "mr")),
    *(("lf", "rf"), ("lh", "rh"), ("lb", "rb"), ("lr", "rr"), ("lm", "rm")),
)
_SHAPES = (str.lower, str.upper, str.capitalize)
_OTHER = {shape(left): shape(right) for left, right in reversed(_PAIRS) for shape in _SHAPES}
_BACK = {right: left for left, right in _OTHER.items()}
_WORDS = "|".join(sorted({*_OTHER, *_BACK}, key=len, reverse=True))
_WORD = re.compile(rf"(?<![a-zA-Z])(?:{_WORDS})(?![a-z])|(?<=[a-z])(?:Left|Right|L|R)(?![a-z])")
_LETTERS = frozenset("adegijknopqst")
"""Letters that name no side and no end, such as the front: they show a series."""
_SERIES = 3
"""Links whose names differ in such a letter, from which on l and r are letters, too. Chosen."""
_END = re.compile(r"(?i)front|rear|back|hind|middle|mid|[flrhbm]{1,2}(?![a-z])|left|right")


def find_twins(name: str, names: dict[str, Link] | dict[str, Joint]) -> list[str]:
    """List the names of the right counterparts of a left name, the most likely first.

    A name with two side words has several: front_leftL may be the mirror image of front_rightR.
    """
    matches = _find_words(name, names)
    found: list[str] = []
    if len(matches) > 1:  # front_leftL: both words are swapped, front_rightR
        all_turned = name
        for match in reversed(matches):
            all_turned = _swap_side(all_turned, match)
        if all_turned in names:
            if matches[0][0] not in _OTHER:
                return []
            found.append(all_turned)
    for match in matches:
        if match[0] in _OTHER:
            other = _swap_side(name, match)
            if other in names and other not in found:
                found.append(other)
    return found


def is_clear(name: str, names: dict[str, Link]) -> bool:
    """Tell whether a name has one side word, so that it can be paired in one way only.

    The first letter of a word in capitals, as in ``FL_LEG``, is none if there is no ``FL_REG``.
    """
    words = [
        match
        for match in _find_words(name, names)
        if not name[match.end() : match.end() + 1].isalpha() or _swap_side(name, match) in names
    ]
    return len(words) < 2


def _find_words(name: str, names: dict[str, Link] | dict[str, Joint]) -> list[re.Match[str]]:
    """Find the side words of a name, without letters of a series such as ``hand_a … hand_t``."""
    return [match for match in _WORD.finditer(name) if not _is_of_series(name, match, names)]


def _is_of_series(
    name: str, match: re.Match[str], names: dict[str, Link] | dict[str, Joint]
) -> bool:
    if len(match[0]) > 1:
        return False
    case = str.upper if match[0].isupper() else str.lower
    others = (name[: match.start()] + case(one) + name[match.end() :] for one in _LETTERS)
    return sum(other in names for other in others) >= _SERIES


def _swap_side(name: str, match: re.Match[str]) -> str:
    """Return a name with one of its side words swapped."""
    other = _OTHER.get(match[0]) or _BACK[match[0]]
    return name[: match.start()] + other + name[match.end() :]


class Pair(NamedTuple):
    """A left link and its right counterpart, with their parent joints."""

    left: Link
    right: Link
    left_joint: Joint
    right_joint: Joint


class Sides:
    """The pairs of a robot and their symmetry, with all joints at zero.

    Attributes:
        pairs: Those with the same parent, or with a pair as parents, on joints of one type.
        normal: Axis of the root frame from left to right: 0, 1 or 2; None if the robot is not
            symmetric.
        off: Pairs whose joints are not mirror images, with the distance [m].
    """

    def __init__(self, robot: Robot) -> None:
        """Find the pairs, and the plane that mirrors most of them."""
        self.pairs = list(_find_pairs(robot))
        self.poses: dict[str, Pose] = get_zero_poses(robot) if self.pairs else {}
        self.normal: int | None = None
        self.off: list[tuple[Pair, float]] = []
        moving = [pair for pair in self.pairs if _has_moving_links(robot, pair)]
        both = [(pair, *ends) for pair in moving if (ends := self._compute_offsets(pair))]
        steps = [step for step in both if not _is_in_one_place(*step)]
        long = [step for step in steps if max(map(math.hypot, *zip(*step[1:], strict=True))) > 0.01]
        best = 0
        for normal in (1, 0, 2):
            wrong = [
                (p, gap)
                for p, a, b in steps
                if (gap := _compute_gap(p, a, b, normal)) > _compute_tolerance(a)
            ]
            off = {id(pair.left) for pair, _ in wrong}
            right = sum(1 for pair, _, _ in long if id(pair.left) not in off)
            if right > best and right >= 0.6 * len(long):
                best, self.normal, self.off = right, normal, wrong
        if best < 2:
            self.normal = None
            self.off = [
                found for pair, a, b in long if (found := _find_nearly_symmetric(pair, a, b))
            ]
        self.off += _find_stacked(both, 1 if self.normal is None else self.normal)
        self._displaced = {id(pair.left) for pair, _ in self.off}
        self.off = [found for found in self.off if is_clear(found[0].left.name, robot.link)]

    def is_displaced(self, pair: Pair) -> bool:
        """Tell whether the joints of a pair are not mirror images."""
        return id(pair.left) in self._displaced

    def is_mirrored_in_root(self, pair: Pair) -> bool:
        """Tell whether the links of a pair are mirror images in the root frame.

        The joints above are then displaced by as much as those of the pair, such as along an axis.
        """
        normal = 1 if self.normal is None else self.normal
        one, other = self.poses.get(pair.left.name), self.poses.get(pair.right.name)
        if one is None or other is None:
            return False
        left, right = list(one.translation), list(other.translation)
        right[normal] = -right[normal]
        return math.dist(left, right) <= _compute_tolerance(one.translation)

    def is_mirrored_in_parent(self, pair: Pair) -> bool:
        """Tell whether joints of one parent are mirror images in a plane of the parent's frame.

        A gripper whose frame is turned about the axis of an arm is symmetric in its own frame.
        """
        left, right = pair.left_joint, pair.right_joint
        if left.parent != right.parent:
            return False
        one, other = make_pose(left.origin).translation, make_pose(right.origin).translation
        return any(
            abs(other[axis]) > (most := _compute_tolerance(one))
            and math.dist(one, [-x if at == axis else x for at, x in enumerate(other)]) <= most
            for axis in range(3)
        )

    def is_image_of_sibling(self, robot: Robot, pair: Pair) -> bool:
        """Tell whether the right joint is the mirror image of a sibling of the left one.

        The fingers of a gripper that is mounted on both arms are: its left finger is on the outer
        side of one arm, and on the inner side of the other.
        """
        left, right = pair.left_joint, pair.right_joint
        if left.parent == right.parent:
            return False
        normal = 1 if self.normal is None else self.normal
        return any(
            (steps := self._compute_offsets(Pair(link, pair.right, sibling, right))) is not None
            and _compute_gap(pair, *steps, normal) <= _compute_tolerance(steps[0])
            for sibling in robot.tree.get_child_joints(left.parent)
            if sibling is not left
            and sibling.type == left.type
            and (link := robot.link.get(sibling.child)) is not None
        )

    def is_taken_back(self, pair: Pair) -> bool:
        """Tell whether the next joints of a displaced pair are mirror images again."""
        return any(
            (steps := self._compute_offsets(pair, after)) is not None
            and _compute_gap(pair, *steps, 1 if self.normal is None else self.normal)
            <= _compute_tolerance(steps[0])
            for after in self.pairs
            if (after.left_joint.parent, after.right_joint.parent)
            == (pair.left.name, pair.right.name)
        )

    def _compute_offsets(
        self, pair: Pair, last: Pair | None = None
    ) -> tuple[Vector, Vector] | None:
        """Compute the vectors from the parents of a pair to its links, in the root frame [m].

        Args:
            pair: The pair.
            last: A pair below it, to whose links the vectors are computed instead.
        """
        until = pair if last is None else last
        ends = (until.left.name, until.right.name)
        begins = (pair.left_joint.parent, pair.right_joint.parent)
        if not all(name in self.poses for name in (*ends, *begins)):
            return None
        places = [self.poses[name].translation for name in (*begins, *ends)]
        (a, b, c), (d, e, f), (g, h, i), (j, k, m) = places
        return (g - a, h - b, i - c), (j - d, k - e, m - f)

    def is_mirrored_at_equal_positions(self, pair: Pair) -> bool | None:
        """Tell whether the two joints mirror each other at equal, not at opposite positions.

        None if one has no axis, if the axes are not mirror images, or if the limb is a copy.
        """
        if self.normal is None or self.compare_copies(pair) is not None:
            return None
        one, other = (
            self._compute_axis(link, joint)
            for link, joint in ((pair.left, pair.left_joint), (pair.right, pair.right_joint))
        )
        if one is None or other is None:
            return None
        product = sum(
            a * b * (-1 if i == self.normal else 1)
            for i, (a, b) in enumerate(zip(one, other, strict=True))
        )
        if abs(product) < 0.95:
            return None
        # a rotation axis is a pseudovector: mirrored and reversed
        return (product > 0) == (pair.left_joint.type == "prismatic")

    def compare_copies(self, pair: Pair) -> float | None:
        """Compare the axes of two joints that are copies below parents that are turned by 180°.

        Two equal arms that face each other are so: no plane mirrors them.

        Returns:
            1 for equal axes, -1 for opposite ones; None if they are no such copies.
        """
        left, right = pair.left_joint, pair.right_joint
        one, other = self.poses.get(left.parent), self.poses.get(right.parent)
        if left.parent == right.parent or one is None or other is None:
            return None
        # the trace of a rotation is 1 + 2 cos(angle)
        if sum(map(compute_dot, one.rotation, other.rotation)) > _TURNED:
            return None
        origins = zip(_get_origin(left), _get_origin(right), strict=True)
        if any(math.dist(a, b) > _COPIED for a, b in origins):
            return None
        axis, image = _get_axis(left), _get_axis(right)
        for sign in (1.0, -1.0):
            if math.dist(axis, [sign * value for value in image]) <= _COPIED:
                return sign
        return None

    def get_axis(self, link: Link, joint: Joint) -> Vector | None:
        """Get the axis of a joint in the root frame, of unit length."""
        return self._compute_axis(link, joint)

    def _compute_axis(self, link: Link, joint: Joint) -> Vector | None:
        if link.name not in self.poses:
            return None
        axis = _get_axis(joint)
        length = math.hypot(*axis)
        if not length:
            return None
        x, y, z = rotate(self.poses[link.name].rotation, axis)
        return x / length, y / length, z / length


_TURNED = -0.999
"""Trace of the rotation between two frames below which it is a turn of 180°. Chosen, no source."""
_COPIED = 1e-4
"""Largest difference of the origins and axes of copied joints [m, rad, 1]. Chosen, no source."""


def _get_axis(joint: Joint) -> Vector:
    return joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)


def _get_origin(joint: Joint) -> tuple[Vector, Vector]:
    none = (0.0, 0.0, 0.0)
    return (none, none) if joint.origin is None else (joint.origin.xyz, joint.origin.rpy)


def map_twin_links(robot: Robot) -> dict[str, str]:
    """Map each left link to its right counterpart, by their names.

    If a name has several, the one whose position mirrors that of the left link counts.
    """
    links = robot.link
    several = {name: others for name in links if (others := find_twins(name, links))}
    twins = {name: others[0] for name, others in several.items() if len(others) == 1}
    if len(twins) < len(several):
        poses = get_zero_poses(robot)
        for name, others in several.items():
            fitting = [one for one in others if _is_mirrored(robot, poses, name, one)]
            if len(others) > 1 and fitting:
                twins[name] = fitting[0]
    rights = set(twins.values())  # R_rf is that of L_rf; R_lf, a finger, is not its left one
    return {name: other for name, other in twins.items() if name not in rights}


def find_twin(robot: Robot, link: Link) -> Link | None:
    """Find the mirror image of a link of either side, by the names; None if there is none."""

    def compute() -> dict[str, str]:
        twins = map_twin_links(robot)
        return {**twins, **{other: name for name, other in twins.items()}}

    return robot.link.get(robot.memo.get("twins", compute).get(link.name, ""))


def _find_pairs(robot: Robot) -> Iterator[Pair]:
    links, twins = robot.link, map_twin_links(robot)
    for name, other in twins.items():
        left, right = robot.tree.get_parent_joint(name), robot.tree.get_parent_joint(other)
        if left is None or right is None or left.type != right.type:
            continue
        if is_coordinate(robot, left) and is_coordinate(robot, right):
            continue
        if left.parent == right.parent or twins.get(left.parent) == right.parent:
            yield Pair(links[name], links[other], left, right)


def _is_mirrored(robot: Robot, poses: dict[str, Pose], name: str, other: str) -> bool:
    """Tell whether the offsets of two links from their parents are mirror images."""
    steps: list[Vector] = []
    for link in (name, other):
        above = robot.tree.get_parent_joint(link)
        if above is None or link not in poses or above.parent not in poses:
            return False
        (a, b, c), (d, e, f) = poses[above.parent].translation, poses[link].translation
        steps.append((d - a, e - b, f - c))
    one, two = steps
    return any(
        all(
            abs(b + a if i == normal else b - a) <= _compute_tolerance(one)
            for i, (a, b) in enumerate(zip(one, two, strict=True))
        )
        for normal in (1, 0, 2)
    )


def _has_moving_links(robot: Robot, pair: Pair) -> bool:
    """Tell whether a pair moves or carries moving links; sensors and frames may be asymmetric."""
    if not pair.left_joint.is_fixed:
        return True
    below = (pair.left.name, *robot.tree.list_descendants(pair.left.name))
    return any(not joint.is_fixed for name in below for joint in robot.tree.get_child_joints(name))


def _compute_gap(pair: Pair, left: Vector, right: Vector, normal: int) -> float:
    """Compute the distance of the right offset from the mirror image of the left one [m]."""
    shared = pair.left_joint.parent == pair.right_joint.parent
    return math.hypot(
        *(
            # the plane between the two is unknown
            (0.0 if shared else b + a) if i == normal else b - a
            for i, (a, b) in enumerate(zip(left, right, strict=True))
        )
    )


def _is_in_one_place(pair: Pair, left: Vector, right: Vector) -> bool:
    """Tell whether both are offset to one side of their parent, at the same position."""
    shared = pair.left_joint.parent == pair.right_joint.parent
    turns = pair.left_joint.type in ("revolute", "continuous")
    return shared and turns and max(map(abs, left)) > 0.01 and math.dist(left, right) < 0.001


def _find_stacked(
    steps: list[tuple[Pair, Vector, Vector]], normal: int
) -> Iterator[tuple[Pair, float]]:
    """Find pairs at one position off the plane between left and right, with the distance [m]."""
    for pair, left, right in steps:
        if _is_in_one_place(pair, left, right) and abs(left[normal]) > 0.01:
            yield pair, 2 * abs(left[normal])


def _find_nearly_symmetric(pair: Pair, left: Vector, right: Vector) -> tuple[Pair, float] | None:
    """Find a single pair, as of wheels, that is nearly symmetric, with the distance [m]."""
    shared = pair.left_joint.parent == pair.right_joint.parent
    gap, length = _compute_gap(pair, left, right, 1), math.hypot(*left)
    opposite = left[1] * right[1] < 0 and abs(left[1] + right[1]) <= _compute_tolerance(left)
    return (
        (pair, gap)
        if shared and opposite and _compute_tolerance(left) < gap < 0.3 * length
        else None
    )


def _compute_tolerance(step: Vector) -> float:
    return max(0.005, 0.02 * math.hypot(*step))


def get_family(name: str) -> str:
    """Remove side and end words from a name: all four legs then have the same one."""
    return _END.sub("*", name)


def get_sides(robot: Robot) -> Sides:
    """Get the sides of a robot, shared by all rules."""
    return robot.memo.get("sides", lambda: Sides(robot))
