"""Pairs of links that one joint connects.

MoveIt's Setup Assistant lets a link without geometry connect all its neighbors with each other, so
two arms on a bare torso are adjacent to it. Here a bare link only extends the joint between an
ancestor and a descendant.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..model.elements import Joint, Robot
from ..model.kinematics import get_zero_poses
from ..model.part import Vector
from ..model.pose import add, compute_cross, compute_dot, compute_norm, make_pose, rotate

MEETING = 1e-3
"""Largest distance of two axes that meet [m]; chosen, no source."""


def find_adjacent_pairs(robot: Robot, shaped: Iterable[str]) -> set[frozenset[str]]:
    """Find the pairs of links that one joint connects.

    It may be a chain of joints through links without geometry, if at most one of them moves, or if
    all are revolute and each two of their axes meet, as in a universal joint. A joint that closes
    a loop counts, too.
    """
    names = set(shaped)
    pairs = {
        frozenset((joint.parent, joint.child))
        for joint in robot.joints
        if joint.parent in names and joint.child in names
    }
    pairs |= {
        frozenset((closure.parent, closure.child))
        for closure in robot.closures
        if closure.parent in names and closure.child in names
    }
    return pairs | set(_find_through_bare(robot, names))


def _find_through_bare(robot: Robot, shaped: set[str]) -> Iterator[frozenset[str]]:
    for name in shaped:
        joints = _list_joints_above(robot, name, shaped)
        if len(joints) > 1 and joints[-1].parent in shaped and _is_one_joint(robot, joints):
            yield frozenset((name, joints[-1].parent))


def _list_joints_above(robot: Robot, name: str, shaped: set[str]) -> list[Joint]:
    """List the joints from a link up to its nearest ancestor with geometry, or to the root."""
    joints: list[Joint] = []
    seen = {name}
    while (joint := robot.tree.get_parent_joint(name)) is not None:
        joints.append(joint)
        name = joint.parent
        if name in shaped or name in seen:
            break
        seen.add(name)
    return joints


def _is_one_joint(robot: Robot, joints: list[Joint]) -> bool:
    """Tell whether joints in a row move as one joint does."""
    moving = [joint for joint in joints if not joint.is_fixed]
    if len(moving) <= 1:
        return True
    if any(joint.type not in ("revolute", "continuous") for joint in moving):
        return False
    axes = [axis for joint in moving if (axis := _locate_axis(robot, joint)) is not None]
    return len(axes) == len(moving) and all(
        _measure_axis_distance(*one, *other) <= MEETING
        for index, one in enumerate(axes)
        for other in axes[:index]
    )


def _locate_axis(robot: Robot, joint: Joint) -> tuple[Vector, Vector] | None:
    """Return a point [m] and the unit direction of a joint's axis in the frame of the root."""
    poses = get_zero_poses(robot)
    x, y, z = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = compute_norm((x, y, z))
    if joint.parent not in poses or not length:
        return None
    pose = poses[joint.parent] @ make_pose(joint.origin)
    return pose.translation, rotate(pose.rotation, (x / length, y / length, z / length))


def _measure_axis_distance(point: Vector, axis: Vector, other: Vector, other_axis: Vector) -> float:
    """Return the distance of two lines [m], each a point and a unit direction."""
    between = add(other, (-point[0], -point[1], -point[2]))
    normal = compute_cross(axis, other_axis)
    length = compute_norm(normal)
    if length < 1e-9:
        return compute_norm(compute_cross(between, axis))
    return abs(compute_dot(between, normal)) / length
