"""Rigid body kinematics and dynamics of a mechanism."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .mechanism import Array, Hinge, Mechanism, invert_pose, make_pose

GRAVITY = np.array([0.0, 0.0, -9.81])


def compute_poses(
    robot: Mechanism, q: Mapping[str, float], order: Sequence[Hinge]
) -> dict[str, Array]:
    """Compute the pose of each body in the model's frame.

    Args:
        robot: The robot; its free bodies have the poses of their frames.
        q: Joint positions by name [rad or m]; 0 by default.
        order: The joints, parents before children.
    """
    placed = {"world": np.eye(4)}
    hung = {joint.child for joint in order}
    for name in robot.bodies:
        if name not in hung:
            placed[name] = (
                robot.frames[f"//{name}"][1] if f"//{name}" in robot.frames else np.eye(4)
            )
    for joint in order:
        motion = _compute_motion(joint, q.get(joint.name, 0.0))
        placed[joint.child] = (
            placed[joint.parent] @ joint.before @ motion @ invert_pose(joint.after)
        )
    return placed


def _compute_motion(joint: Hinge, position: float) -> Array:
    if joint.kind == "prismatic":
        return make_pose(np.eye(3), joint.axis * position)
    if joint.kind == "revolute":
        x, y, z = joint.axis
        skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        turn = np.eye(3) + np.sin(position) * skew + (1 - np.cos(position)) * skew @ skew
        return make_pose(turn, np.zeros(3))
    return np.eye(4)


def compute_mass_matrix(
    robot: Mechanism, placed: Mapping[str, Array], order: Sequence[Hinge], names: Sequence[str]
) -> tuple[Array, Array]:
    """Compute the mass matrix of some joints with a fixed base, and the gravity forces [N·m or N].

    Args:
        robot: The robot.
        placed: Poses of its bodies.
        order: Its joints, parents before children.
        names: Selected joints, in the order of rows and columns.
    """
    index = {name: place for place, name in enumerate(names)}
    above: dict[str, list[tuple[int, Array, Array, bool]]] = {}
    inertia, weight = np.zeros((len(names), len(names))), np.zeros(len(names))
    for joint in order:
        chain = above.get(joint.parent, [])
        if joint.name in index:
            frame = placed[joint.parent] @ joint.before
            entry = (
                index[joint.name],
                frame[:3, :3] @ joint.axis,
                frame[:3, 3],
                joint.kind == "revolute",
            )
            chain = [*chain, entry]
        above[joint.child] = chain
        body = robot.bodies[joint.child]
        if not chain or (body.mass == 0.0 and not body.inertia.any()):
            continue
        pose = placed[joint.child]
        center = pose[:3, :3] @ body.center + pose[:3, 3]
        turns = np.array([axis if turning else np.zeros(3) for _, axis, _, turning in chain]).T
        moves = np.array(
            [np.cross(axis, center - at) if turning else axis for _, axis, at, turning in chain]
        ).T
        spun = pose[:3, :3] @ body.inertia @ pose[:3, :3].T
        block = body.mass * moves.T @ moves + turns.T @ spun @ turns
        rows = [place for place, *_ in chain]
        inertia[np.ix_(rows, rows)] += block
        weight[rows] -= body.mass * moves.T @ GRAVITY
    return inertia, weight


def compute_centroidal(robot: Mechanism, placed: Mapping[str, Array]) -> tuple[float, Array, Array]:
    """Compute total mass, center of mass, and inertia about it, in the model's frame."""
    total = float(sum(body.mass for body in robot.bodies.values()))
    if total == 0.0:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    centers = {
        name: placed[name][:3, :3] @ body.center + placed[name][:3, 3]
        for name, body in robot.bodies.items()
    }
    center = np.zeros(3)
    for name, body in robot.bodies.items():
        center += body.mass / total * centers[name]
    tensor = np.zeros((3, 3))
    for name, body in robot.bodies.items():
        turn, arm = placed[name][:3, :3], centers[name] - center
        tensor += turn @ body.inertia @ turn.T
        tensor += body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return total, center, tensor
