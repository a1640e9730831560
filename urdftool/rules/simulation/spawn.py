"""Check the first steps of a simulation: damping that is too stiff, a robot in the ground."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...geometry.penetration import Convex
from ...model.elements import Robot
from ...model.kinematics import MOVABLE, get_zero_poses
from ...model.pose import rotate, transpose
from ..collision.convex_bodies import get_convex_bodies
from ..inertia.joint_inertia import compute_highest_damping, compute_joint_inertia
from ..rule import INFO, Problem, rule


@rule(
    INFO,
    default=False,
    effects={
        "pybullet": "moves the joint against the force, and not as damped",
        "mujoco": "integrates damping implicitly: the joint is slow",
    },
)
def stiff_joint_damping(robot: Robot, *, timestep: float = 0.001) -> Iterator[Problem]:
    """A joint's damping is too large for its inertia and the time step.

    A damper removes d·Δt/I of the speed in each step. If that is more than twice the speed, an
    explicit integrator overshoots, and more so with each step. I is the inertia about the joint
    axis of everything below the joint, in series with that of everything above it; ``timestep``
    [s] is Δt. PyBullet begins to oscillate at this inertia, within 1 %; MuJoCo integrates damping
    implicitly.
    """
    poses = get_zero_poses(robot)
    for joint in robot.joints:
        damping = joint.get_resistance("damping")
        if joint.type not in MOVABLE or not damping or joint.child not in poses:
            continue
        inertia = compute_joint_inertia(robot, joint, poses)
        highest = compute_highest_damping(inertia, timestep)
        if inertia > 0 and damping > highest and joint.dynamics is not None:
            unit = "kg" if joint.type == "prismatic" else "kg·m²"
            yield Problem(
                joint,
                f"damping {damping:g} of joint '{joint.name}' is too large for its {inertia:.3g} "
                f"{unit}: at {timestep * 1000:g} ms steps it must be below "
                f"{highest:.3g}",
                at=joint.dynamics,
                data={"damping": damping, "highest": highest, "inertia": inertia},
            )


@rule(
    INFO,
    default=False,
    effects={
        "gz, gazebo-classic, mujoco": (
            "place the root as written: parts below it start below the ground"
        ),
    },
)
def below_ground_at_spawn(robot: Robot, *, deep: float = 0.01) -> Iterator[Problem]:
    """The robot extends below its root frame.

    A robot that is spawned at z = 0 then starts inside of the ground, and the contact pushes it
    out. The message gives the height at which it stands. Robots with a root named ``world`` are
    skipped, because they are not spawned.
    """
    root = robot.tree.root
    if root is None or root.name == "world":
        return
    lowest, whose = math.inf, None
    for parts in get_convex_bodies(robot).bodies.values():
        for link, piece in parts:
            low = piece.pose.translation[2] - _compute_extent_down(piece)
            if low < lowest:
                lowest, whose = low, link
    if whose is not None and lowest < -deep:
        yield Problem(
            whose,
            f"link '{whose.name}' extends {-lowest:.3g} m below root '{root.name}'; spawn the "
            f"robot at z = {-lowest:.3g}",
            data={"depth": -lowest},
            at=whose.collisions[0],
        )


def _compute_extent_down(piece: Convex) -> float:
    """Compute how far a piece extends below its center [m]."""
    return piece.reach(*rotate(transpose(piece.pose.rotation), (0.0, 0.0, -1.0)))
