"""What happens in a simulator's first steps: damping that is too stiff, a robot in the ground."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...geometry.penetration import Convex
from ...model.elements import Robot
from ...model.kinematics import MOVABLE, link_poses
from ...model.pose import rotate, transpose
from ..collision.pieces import pieces
from ..inertia.joint_inertia import joint_inertia
from ..rule import INFO, Problem, rule


@rule(
    INFO,
    default=False,
    effects={
        "pybullet": "the joint moves against the force, and not as damped",
        "mujoco": "integrates damping implicitly: the joint is slow",
    },
)
def stiff_joint_damping(robot: Robot, *, step: float = 0.001) -> Iterator[Problem]:
    """A joint's damping is too strong for the inertia it brakes.

    A damper takes d·Δt/I of the speed in each step. Where that is more than twice the speed, an
    explicit integrator overshoots, and more so each step. I is the inertia about the axis of all
    that the joint carries, and of all that carries it, in series; ``step`` [s] is Δt. PyBullet
    begins to oscillate at just this inertia, within 1 %; MuJoCo integrates damping implicitly.
    """
    poses = link_poses(robot)
    for joint in robot.joints:
        damping = joint.dynamics.damping if joint.dynamics is not None else None
        if joint.type not in MOVABLE or not damping or joint.child not in poses:
            continue
        inertia = joint_inertia(robot, joint, poses)
        if inertia > 0 and damping * step > 2 * inertia and joint.dynamics is not None:
            unit = "kg" if joint.type == "prismatic" else "kg·m²"
            yield Problem(
                joint,
                f"damping {damping:g} of joint '{joint.name}' brakes {inertia:.3g} {unit}; at "
                f"steps of {step * 1000:g} ms more than {2 * inertia / step:.3g} is unstable",
                at=joint.dynamics,
                data={"damping": damping, "highest": 2 * inertia / step, "inertia": inertia},
            )


@rule(
    INFO,
    default=False,
    effects={
        "gz, gazebo-classic, mujoco": (
            "place the root as written: what is below it starts below the ground"
        ),
    },
)
def below_ground_at_spawn(robot: Robot, *, deep: float = 0.01) -> Iterator[Problem]:
    """The robot reaches below the frame of its root.

    Who spawns it at a height of zero puts it into the ground, and it is thrown out. The message
    says at which height it stands. Robots whose root is ``world`` are not spawned, and left out.
    """
    root = robot.tree.root
    if root is None or root.name == "world":
        return
    lowest, whose = math.inf, None
    for parts in pieces(robot).bodies.values():
        for link, piece in parts:
            low = piece.pose.translation[2] - _down(piece)
            if low < lowest:
                lowest, whose = low, link
    if whose is not None and lowest < -deep:
        yield Problem(
            whose,
            f"link '{whose.name}' reaches {-lowest:.3g} m below '{root.name}'; spawn the robot at "
            f"z = {-lowest:.3g}",
            data={"depth": -lowest},
            at=whose.collisions[0],
        )


def _down(piece: Convex) -> float:
    """How far a piece reaches down from its middle [m]."""
    return piece.reach(*rotate(transpose(piece.pose.rotation), (0.0, 0.0, -1.0)))
