"""Compute the inertia that a joint moves, which limits the time step of a simulator."""

from __future__ import annotations

from ...mechanics.spatial_inertia import link_inertia
from ...model.elements import Joint, Robot
from ...model.pose import Pose, rotate


def compute_joint_inertia(robot: Robot, joint: Joint, poses: dict[str, Pose]) -> float:
    """Compute the inertia that a torque of a joint accelerates, all other joints being locked.

    The result is the inertia of everything below the joint, about its axis, in series with that
    of everything above it: ``a b / (a + b)``.

    Returns:
        The inertia [kg·m²]; for a prismatic joint the mass [kg]; 0 if nothing below the joint
        has one.
    """
    carried = {joint.child, *robot.tree.list_descendants(joint.child)}
    one = _compute_about_axis(robot, joint, poses, carried & set(poses))
    other = _compute_about_axis(robot, joint, poses, set(poses) - carried)
    if one <= 0:
        return 0.0
    return one * other / (one + other) if other > 0 else one


def compute_highest_damping(inertia: float, timestep: float) -> float:
    """Compute the damping [N·m·s/rad or N·s/m] above which an explicit integrator oscillates.

    A damper removes d·Δt/I of the speed in each step, which overshoots if that is more than twice
    the speed: 2·I/Δt.
    """
    return 2 * inertia / timestep


def _compute_about_axis(
    robot: Robot, joint: Joint, poses: dict[str, Pose], links: set[str]
) -> float:
    """Compute the inertia of links about the axis of a joint, or their mass if it slides."""
    masses = [(robot.link[name], poses[name]) for name in links if robot.link[name].mass > 0]
    if joint.type == "prismatic":
        return sum(link.mass for link, _ in masses)
    frame = poses[joint.child]
    axis = rotate(frame.rotation, joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    if not any(axis):
        return 0.0
    return sum(
        link_inertia(link).transform(pose).compute_moment_about(frame.translation, axis)
        for link, pose in masses
        if link.inertial is not None and link.inertial.inertia is not None
    )
