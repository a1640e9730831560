"""Numbers of poses, and frames of one robot in another."""

from __future__ import annotations

import math

import numpy as np

from ..mechanics.reference import Array
from ..model.part import Origin
from ..model.pose import Pose, get_origin_at


def make_matrix(pose: Pose) -> Array:
    """Return a pose as a matrix, 4 × 4."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose.rotation, pose.translation
    return matrix


def make_origin(matrix: Array) -> Origin:
    """Return the ``Origin`` of a pose, 4 × 4."""
    (a, b, c), (d, e, f), (g, h, i) = matrix[:3, :3].tolist()
    x, y, z = matrix[:3, 3].tolist()
    return get_origin_at(Pose(((a, b, c), (d, e, f), (g, h, i)), (x, y, z)))


def invert(pose: Array) -> Array:
    """Return the inverse of a pose, 4 × 4."""
    inverse = np.eye(4)
    inverse[:3, :3] = pose[:3, :3].T
    inverse[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return inverse


def measure_rotation(rotation: Array) -> float:
    """Return the angle of a rotation [rad], precise for small ones."""
    skew = np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    return math.atan2(float(np.linalg.norm(skew)), float(np.trace(rotation)) - 1.0)


def measure_pose(pose: Array) -> tuple[float, float]:
    """Return the distance [m] and the angle [rad] of a pose from the identity."""
    return float(np.linalg.norm(pose[:3, 3])), measure_rotation(pose[:3, :3])


def measure_largest(pose: Array) -> float:
    """Return the larger of distance [m] and angle [rad] of a pose from the identity."""
    return max(measure_pose(pose))


def describe_motion(pose: Array) -> str:
    """Format distance and angle of a pose."""
    distance, angle = measure_pose(pose)
    parts = []
    if distance > 1e-9:
        parts.append(f"{distance * 1000:.4g} mm apart")
    if angle > 1e-9:
        parts.append(f"turned by {math.degrees(angle):.4g}°")
    return ", ".join(parts)


def describe_pose(pose: Array) -> str:
    """Format a pose as xyz [m] and rpy [rad]."""
    rotation = pose[:3, :3]
    yaw = math.atan2(rotation[1, 0], rotation[0, 0])
    s, c = math.sin(yaw), math.cos(yaw)
    pitch = math.atan2(-rotation[2, 0], c * rotation[0, 0] + s * rotation[1, 0])
    roll = math.atan2(
        s * rotation[0, 2] - c * rotation[1, 2], c * rotation[1, 1] - s * rotation[0, 1]
    )
    xyz = format_vector(pose[:3, 3])
    return f"xyz {xyz} rpy {format_vector(np.array([roll, pitch, yaw]))}"


def format_vector(vector: Array) -> str:
    """Format numbers with six digits, zero without sign."""
    return " ".join(f"{value + 0.0 if abs(value) > 1e-15 else 0.0:.6g}" for value in vector)
