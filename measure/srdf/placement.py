"""Poses of all links at many joint positions, by the formulas of URDF, not by the proof."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from urdftool.geometry.mesh import Array
from urdftool.model.elements import Joint, Robot

Frames = dict[str, tuple[Array, Array]]
"""Rotations (n, 3, 3) and translations (n, 3) [m] of links in the frame of the root, by name."""


def list_ranges(robot: Robot) -> dict[str, tuple[float, float]]:
    """Return the range of each joint that moves and follows no other one [rad, m], by name."""
    found = {}
    for joint in robot.joints:
        if joint.type not in ("revolute", "continuous", "prismatic") or joint.mimic is not None:
            continue
        limit = joint.limit
        lower, upper = (limit.lower or 0.0, limit.upper or 0.0) if limit else (0.0, 0.0)
        if joint.type != "prismatic" and (
            joint.type == "continuous" or limit is None or lower > upper
        ):
            lower, upper = -math.pi, math.pi
        found[joint.name] = lower, upper
    return found


def draw_positions(
    ranges: Mapping[str, tuple[float, float]], count: int, random: np.random.Generator
) -> dict[str, Array]:
    """Draw random joint positions, each of shape (count,), by name."""
    return {name: random.uniform(*bounds, count) for name, bounds in ranges.items()}


def place_links(robot: Robot, positions: Mapping[str, Array], count: int) -> Frames:
    """Return the poses of all links at joint positions of shape (count,)."""
    frames: Frames = {}
    eye = np.broadcast_to(np.eye(3), (count, 3, 3))
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        if joint is None:
            frames[name] = eye, np.zeros((count, 3))
        elif joint.parent in frames:
            frames[name] = _move(robot, joint, frames[joint.parent], positions)
    return frames


def _move(
    robot: Robot, joint: Joint, above: tuple[Array, Array], positions: Mapping[str, Array]
) -> tuple[Array, Array]:
    rotation, translation = above
    origin = joint.origin
    if origin is not None:
        translation = translation + rotation @ np.array(origin.xyz, float)
        rotation = rotation @ _rotate_rpy(*origin.rpy)
    position = _get_position(robot, joint, positions)
    if position is None:
        return rotation, translation
    axis = np.array(joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    axis = axis / np.linalg.norm(axis)
    if joint.type == "prismatic":
        return rotation, translation + position[:, None] * (rotation @ axis)
    return rotation @ _rotate_about(axis, position), translation


def _get_position(robot: Robot, joint: Joint, positions: Mapping[str, Array]) -> Array | None:
    """Return the positions of a joint, with those of its leader; None for a fixed joint."""
    if joint.mimic is not None and joint.mimic.joint in robot.joint:
        leading = _get_position(robot, robot.joint[joint.mimic.joint], positions)
        if leading is not None:
            followed: Array = joint.mimic.multiplier * leading + joint.mimic.offset
            return followed
    return positions.get(joint.name)


def _rotate_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Return Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    turned: Array = about_z @ about_y @ about_x
    return turned


def _rotate_about(axis: Array, angle: Array) -> Array:
    """Return the rotations of unit quaternions about an axis, shape (n, 3, 3)."""
    w, v = np.cos(angle / 2), np.sin(angle / 2)[:, None] * axis
    x, y, z = v.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    rotations: Array = np.moveaxis(np.array(rows), 2, 0)
    return rotations
