"""Rules on joint positions relative to the geometry of the joined links."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...model.bounds import Bounds
from ...model.elements import Joint, Robot, Vector
from ...model.kinematics import get_zero_poses
from ...model.pose import Pose, rotate
from ..mesh.link_extents import LinkExtents, get_extents
from ..rule import ANY_FORMAT, WARNING, Problem, rule
from ..words import quote

_TURNING = ("revolute", "continuous")

_TOUCHES = 1e-6
"""Distance [m] at which an axis touches a link."""

_GOLDEN = (math.sqrt(5) - 1) / 2


class _AxisDistances(NamedTuple):
    """Distances of the axis of a joint from the geometry of its two rigid bodies [m]."""

    joint: Joint
    place: Vector
    """The joint, in the frame of the root."""
    child: float
    child_size: float
    parent: float
    parent_size: float

    def is_off_child(self, part: float, least: float) -> bool:
        """Tell whether the axis misses the child by a part of its size, and by a distance [m]."""
        return self.child > max(part * self.child_size, least)

    def is_off(self, part: float, least: float) -> bool:
        """Tell whether the axis misses both bodies."""
        off_parent = self.parent > max(part * self.parent_size, least)
        return off_parent and self.is_off_child(part, least)


@rule(
    WARNING,
    effects={
        "mujoco, pybullet, pinocchio": "turn the child about that axis, away from its parent",
    },
    formats=ANY_FORMAT,
)
def axis_misses_links(
    robot: Robot,
    *,
    part: float = 0.1,
    least: float = 0.01,
    certain: float = 1.0,
    together: float = 1e-3,
) -> Iterator[Problem]:
    """The axis of a joint does not pass through the geometry of either of its links.

    A link rotates about the frame of its joint. CAD exporters may leave all frames at the origin of
    the assembly, or apply the position of meshes twice: the robot looks correct if all joints are
    at 0, and its links separate as soon as a joint moves. Export each link with its own frame, at
    its joint.

    It is reported in three cases: one axis misses both links by more than ``certain`` times their
    size; most axes of the robot, and at least two, miss both links by ``part`` of their size; or
    three or more joints are within ``together`` [m], and all their axes miss the child link. Links
    that are fixed to a link count as part of it, and bounding boxes are used as geometry. ``least``
    [m] is the smallest distance that is reported. One finding names all joints.
    """
    misses = list(_measure_joints(robot))
    off = [miss for miss in misses if miss.is_off(part, least)]
    if len(off) < 2 or 2 * len(off) < len(misses):
        off = [miss for miss in off if miss.is_off(certain, least)]
    in_one_place = _find_coincident_joints(misses, part, least, together)
    more = [miss for miss in in_one_place if miss not in off]
    found = off or more
    if not found:
        return
    first = found[0]
    joint = first.joint
    where = f"passes {first.child:.2g} m from link '{joint.child}'"
    if off:
        where += f" and {first.parent:.2g} m from '{joint.parent}'"
    others = [miss.joint.name for miss in (*off, *more) if miss is not first]
    also = f"; so do those of {quote(others, 6)} from theirs" if others else ""
    why = (
        f"the frames of {len(in_one_place)} links are in one place"
        if in_one_place
        else "the joint frame is misplaced"
    )
    yield Problem(
        joint,
        f"axis of joint '{joint.name}' {where}{also}; {why}",
        at=joint.origin or joint,
        data={"joints": [miss.joint.name for miss in found], "distance": first.child},
        hint="export each link with its own frame, at the joint that moves it",
    )


def _find_coincident_joints(
    misses: list[_AxisDistances], part: float, least: float, together: float
) -> list[_AxisDistances]:
    """Find three or more joints in one place whose axes all miss the link that they move."""
    off = [miss for miss in misses if miss.is_off_child(part, least)]
    for miss in off if len(off) >= 3 else ():
        group = [other for other in misses if math.dist(miss.place, other.place) <= together]
        if len(group) >= 3 and all(other.is_off_child(part, least) for other in group):
            return group
    return []


def _measure_joints(robot: Robot) -> Iterator[_AxisDistances]:
    """Measure the axes of revolute and continuous joints between bodies with known geometry."""
    turning = [joint for joint in robot.joints if joint.type in _TURNING]
    if not turning:
        return
    poses, body_of, reach = get_zero_poses(robot), robot.tree.bodies, get_extents(robot)
    inverse = {name: pose.invert() for name, pose in poses.items()}
    members: dict[str, list[str]] = {}
    for name, body in body_of.items():
        members.setdefault(body, []).append(name)
    for joint in turning:
        axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
        length = math.hypot(*axis)
        if joint.child not in poses or joint.parent not in poses or not length:
            continue
        pose = poses[joint.child]
        x, y, z = rotate(pose.rotation, axis)
        line = pose.translation, (x / length, y / length, z / length)
        gaps = []
        for link in (joint.child, joint.parent):
            body = body_of.get(link, link)
            names = [link, *(name for name in members.get(body, ()) if name != link)]
            gap = _measure_bodies(robot, reach, inverse, names, *line)
            if gap is None:
                break
            gaps.append(gap)
        if len(gaps) == 2:
            yield _AxisDistances(joint, pose.translation, *gaps[0], *gaps[1])


def _measure_bodies(
    robot: Robot,
    reach: LinkExtents,
    inverse: dict[str, Pose],
    names: list[str],
    place: Vector,
    way: Vector,
) -> tuple[float, float] | None:
    """Measure the distance of a line from the geometry of rigidly connected links, and their size.

    Returns:
        The distance and the largest length of a link [m]; None if they have no geometry, or if its
        size is unknown.
    """
    best, size = math.inf, 0.0
    for name in names:
        link = robot.link[name]
        if not link.visuals and not link.collisions:
            continue
        box = reach.get_link_box(link)
        if box is None or name not in inverse:
            return None
        size = max(size, *box.size)
        if best > _TOUCHES:
            back = inverse[name]
            best = min(
                best,
                _measure_distance(back.transform(place), rotate(back.rotation, way), box, best),
            )
    return (best, size) if size else None


def _measure_distance(place: Vector, way: Vector, box: Bounds, enough: float) -> float:
    """Measure the distance of a line from a box [m], up to ``enough``.

    The distance is a convex function along the line, so a golden-section search finds the minimum.
    """
    middle = box.center
    at = sum((m - p) * w for m, p, w in zip(middle, place, way, strict=True))
    radius = math.dist(box.low, box.high) / 2
    nearest = math.dist(middle, tuple(p + at * w for p, w in zip(place, way, strict=True)))
    if nearest - radius >= enough:
        return enough

    def measure(t: float) -> float:
        return math.hypot(
            *(
                max(low - (p + t * w), 0.0, p + t * w - high)
                for p, w, low, high in zip(place, way, *box, strict=True)
            )
        )

    low, high = at - radius, at + radius
    best = measure(at)
    while best > _TOUCHES and high - low > 1e-4 * radius:
        one, other = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        first, second = measure(one), measure(other)
        best = min(best, first, second)
        low, high = (low, other) if first <= second else (one, high)
    return best
