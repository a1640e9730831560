"""Find the wheels of a differential drive, with their separation and radius."""

from __future__ import annotations

import re
from typing import NamedTuple

from ...model.bounds import Bounds
from ...model.elements import Joint, Robot, Vector
from ...model.kinematics import get_zero_poses
from ...model.pose import compute_norm
from ..mesh.link_extents import get_extents
from .contact import is_wheel
from .drive_wheels import find_drives, get_wheel

CASTER = re.compile(r"caster|castor|ball_wheel|ball_link$|ball_joint$", re.IGNORECASE)


class WheelPair(NamedTuple):
    """Two wheels on one axle, with all joints at 0.

    Attributes:
        left: The joint of the wheel on the side of the root's positive y axis.
        right: The joint of the other wheel.
        separation: The distance of the two joints [m].
        radius: The radius of the left wheel [m].
    """

    left: Joint
    right: Joint
    separation: float
    radius: float


def find_driven_joints(robot: Robot) -> list[Joint]:
    """Find the joints of wheels in the parameters of a drive, or of the only two wheels."""
    named = {
        wheel.joint.name: wheel.joint
        for drive in find_drives(robot)
        for pair in drive.pairs
        for wheel in pair
    }
    if named:
        return list(named.values())
    found = []
    for joint in robot.joints:
        link = robot.link.get(joint.child)
        if joint.type != "continuous" or link is None or not is_wheel(robot, link):
            continue
        above = [joint.name, joint.child, *robot.tree.list_ancestors(joint.child)]
        if not any(CASTER.search(name) for name in above):
            found.append(joint)
    return found if len(found) == 2 else []


def find_wheel_pair(robot: Robot) -> WheelPair | None:
    """Find the two wheels of a differential drive.

    None unless the robot has exactly two wheels in addition to casters, both turn about the
    positive y axis of the root, at the same x and z, and are round.
    """
    joints = find_driven_joints(robot)
    if len(joints) != 2:
        return None
    poses = get_zero_poses(robot)
    wheels = [wheel for joint in joints if (wheel := get_wheel(robot, poses, joint.name))]
    if len(wheels) != 2 or any(wheel.axis[1] < 0.999 for wheel in wheels):
        return None
    right, left = sorted(wheels, key=lambda wheel: wheel.pose.translation[1])
    (ahead, y, z), (other_ahead, other_y, other_z) = left.pose.translation, right.pose.translation
    separation = y - other_y
    if separation < 0.01 or max(abs(ahead - other_ahead), abs(z - other_z)) > 0.01 * separation:
        return None
    reach = get_extents(robot)
    link = robot.link[left.name]
    axis = left.joint.axis.xyz if left.joint.axis is not None else (1.0, 0.0, 0.0)
    box = reach.get_body_box(link, "collisions") or reach.get_body_box(link, "visuals")
    radius = compute_radius(box, axis) if box is not None else None
    return None if radius is None else WheelPair(left.joint, right.joint, separation, radius)


def compute_radius(box: Bounds, axis: Vector) -> float | None:
    """Compute the radius of a box about an axis [m].

    None if the box is not as wide as high, or the axis is not along one of its sides.
    """
    along = max(range(3), key=lambda i: abs(axis[i]))
    if abs(axis[along]) < 0.99 * compute_norm(axis):
        return None
    one, other = (size for i, size in enumerate(box.size) if i != along)
    return (one + other) / 4 if abs(one - other) <= 0.1 * max(one, other) else None
