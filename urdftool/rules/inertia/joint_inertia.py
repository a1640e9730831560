"""The inertia that a joint moves: what decides whether a step of a simulator is too long for it."""

from __future__ import annotations

from ...mechanics.tensor import rotate_tensor
from ...model.elements import Joint, Robot, Vector
from ...model.pose import Pose, cross, norm, pose_of, rotate


def joint_inertia(robot: Robot, joint: Joint, poses: dict[str, Pose]) -> float:
    """Compute the inertia that a torque of a joint accelerates, all other joints being locked.

    That of everything the joint carries about its axis, and of everything that carries it, in
    series: ``a b / (a + b)``.

    Args:
        robot: The robot.
        joint: A revolute, continuous or prismatic joint.
        poses: The poses of the links in the frame of the root.

    Returns:
        The inertia [kg·m²]; of a prismatic joint the mass [kg]; 0 where nothing that is carried
        has one.
    """
    carried = {joint.child, *robot.tree.descendants(joint.child)}
    one = _about(robot, joint, poses, carried & set(poses))
    other = _about(robot, joint, poses, set(poses) - carried)
    if one <= 0:
        return 0.0
    return one * other / (one + other) if other > 0 else one


def _about(robot: Robot, joint: Joint, poses: dict[str, Pose], links: set[str]) -> float:
    """Compute the inertia of links about the axis of a joint, or their mass if it slides."""
    masses = [(robot.link[name], poses[name]) for name in links if robot.link[name].mass > 0]
    if joint.type == "prismatic":
        return sum(link.mass for link, _ in masses)
    frame = poses[joint.child]
    axis = rotate(frame.rotation, joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    length = norm(axis)
    if not length:
        return 0.0
    x, y, z = (part / length for part in axis)
    total = 0.0
    for link, pose in masses:
        inertial = link.inertial
        if inertial is None or inertial.inertia is None:
            continue
        at = pose @ pose_of(inertial.origin)
        a, b, c, d, e, f = rotate_tensor(inertial.inertia.six, at.rotation)
        arm = _minus(at.translation, frame.translation)
        total += link.mass * norm(cross(arm, (x, y, z))) ** 2
        total += x * x * a + y * y * d + z * z * f + 2 * (x * y * b + x * z * c + y * z * e)
    return total


def _minus(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]
