"""What happens in a simulator's first steps: damping that is too stiff, a robot in the ground."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.convex import Convex
from ...model.elements import Joint, Robot, Vector
from ...model.kinematics import MOVABLE, link_poses
from ...model.pose import Pose, cross, norm, pose_of, rotate, transpose
from ...model.tensor3 import turned
from ..collision.pieces import pieces
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
    that the joint carries, and of all that carries it, in series; ``step`` [s] is Δt.
    """
    poses = link_poses(robot)
    for joint in robot.joints:
        damping = joint.dynamics.damping if joint.dynamics is not None else None
        if joint.type not in MOVABLE or not damping or joint.child not in poses:
            continue
        carried = {joint.child, *robot.tree.descendants(joint.child)}
        one = _about(robot, joint, poses, carried)
        other = _about(robot, joint, poses, set(poses) - carried)
        if one <= 0:
            continue
        inertia = one * other / (one + other) if other > 0 else one
        if damping * step > 2 * inertia and joint.dynamics is not None:
            unit = "kg" if joint.type == "prismatic" else "kg·m²"
            yield Problem(
                joint,
                f"damping {damping:g} of joint '{joint.name}' brakes {inertia:.3g} {unit}; at "
                f"steps of {step * 1000:g} ms more than {2 * inertia / step:.3g} is unstable",
                at=joint.dynamics,
            )


def _about(robot: Robot, joint: Joint, poses: dict[str, Pose], links: set[str]) -> float:
    """The inertia of links about the axis of a joint [kg·m²], or their mass for one that slides."""
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
        tensor = inertial.inertia
        a, b, c, d, e, f = turned(
            (tensor.ixx, tensor.ixy, tensor.ixz, tensor.iyy, tensor.iyz, tensor.izz), at.rotation
        )
        arm = _minus(at.translation, frame.translation)
        total += link.mass * norm(cross(arm, (x, y, z))) ** 2
        total += x * x * a + y * y * d + z * z * f + 2 * (x * y * b + x * z * c + y * z * e)
    return total


def _minus(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


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
            at=whose.collisions[0],
        )


def _down(piece: Convex) -> float:
    """How far a piece reaches down from its middle [m]."""
    return piece.reach(*rotate(transpose(piece.pose.rotation), (0.0, 0.0, -1.0)))
