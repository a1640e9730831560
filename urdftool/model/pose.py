"""Poses in plain Python, for commands that do not import numpy.

A rotation is a 3 × 3 matrix as a tuple of rows; a pose is ``(rotation, translation)`` [m] and maps
a point of the child frame to the parent frame, ``R p + t``. ``rpy`` [rad] is that of URDF: fixed
axes x, y, z in this order, so ``R = Rz(yaw) Ry(pitch) Rx(roll)``.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from .angles import restore_angle
from .elements import Origin, Vector

if TYPE_CHECKING:
    from .provenance import Provenance

Rotation = tuple[Vector, Vector, Vector]
Quaternion = tuple[float, float, float, float]

IDENTITY_ROTATION: Rotation = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Pose(NamedTuple):
    """Rotation and translation [m] of a child frame in its parent frame."""

    rotation: Rotation = IDENTITY_ROTATION
    translation: Vector = (0.0, 0.0, 0.0)

    def __matmul__(self, other: Pose) -> Pose:
        """Return the composition that applies ``other`` first."""
        return Pose(
            multiply_matrices(self.rotation, other.rotation), self.transform(other.translation)
        )

    def transform(self, point: Vector) -> Vector:
        """Return a point of the child frame [m] in the parent frame."""
        return add(rotate(self.rotation, point), self.translation)

    def invert(self) -> Pose:
        """Return the pose of the parent in the child frame."""
        turned = transpose(self.rotation)
        x, y, z = rotate(turned, self.translation)
        return Pose(turned, (-x, -y, -z))


IDENTITY = Pose()


def make_pose(origin: Origin | None) -> Pose:
    """Return the pose of an ``<origin>``; the identity for None."""
    if origin is None:
        return IDENTITY
    if origin.quaternion is not None:
        x, y, z, w = origin.quaternion
        return Pose(rotation_from_quaternion((w, x, y, z)), origin.xyz)
    return Pose(rotation_from_rpy(origin.rpy), origin.xyz)


def make_restored_pose(origin: Origin | None) -> Pose:
    """Return the pose of an ``<origin>`` whose rounded multiples of 15° are exact."""
    if origin is None or origin.quaternion is not None:
        return make_pose(origin)
    roll, pitch, yaw = map(restore_angle, origin.rpy)
    return Pose(rotation_from_rpy((roll, pitch, yaw)), origin.xyz)


def get_origin_at(pose: Pose, provenance: Provenance | None = None) -> Origin:
    """Return the ``Origin`` of a pose."""
    roll, pitch, yaw = rpy_from_rotation(pose.rotation)
    x, y, z = pose.translation  # a zero without its sign
    return Origin(provenance, (x + 0.0, y + 0.0, z + 0.0), (roll + 0.0, pitch + 0.0, yaw + 0.0))


def rotation_from_rpy(rpy: Vector) -> Rotation:
    """Return ``Rz(yaw) Ry(pitch) Rx(roll)``; ``UPRIGHT`` itself for zeros."""
    roll, pitch, yaw = rpy
    if roll == pitch == yaw == 0.0:
        return IDENTITY_ROTATION
    sr, cr = math.sin(roll), math.cos(roll)
    sp, cp = math.sin(pitch), math.cos(pitch)
    sy, cy = math.sin(yaw), math.cos(yaw)
    return (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )


def quaternion_from_rpy(rpy: Vector) -> Quaternion:
    """Return the unit quaternion ``(w, x, y, z)`` of URDF's rpy [rad]."""
    sr, cr = math.sin(rpy[0] / 2), math.cos(rpy[0] / 2)
    sp, cp = math.sin(rpy[1] / 2), math.cos(rpy[1] / 2)
    sy, cy = math.sin(rpy[2] / 2), math.cos(rpy[2] / 2)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def rotation_from_quaternion(quaternion: Quaternion) -> Rotation:
    """Return the rotation of a quaternion ``(w, x, y, z)``, normalized; the identity for zero."""
    norm = math.hypot(*quaternion)
    if norm == 0.0:
        return IDENTITY_ROTATION
    w, x, y, z = (part / norm for part in quaternion)
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def quaternion_from_rotation(r: Rotation) -> Quaternion:
    """Return the unit quaternion ``(w, x, y, z)`` of a rotation, by Shepperd's method."""
    trace = r[0][0] + r[1][1] + r[2][2]
    largest = max(range(4), key=lambda i: (trace, r[0][0], r[1][1], r[2][2])[i])
    if largest == 0:
        four = (1 + trace, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1])
    elif largest == 1:
        four = (r[2][1] - r[1][2], 1 + 2 * r[0][0] - trace, r[0][1] + r[1][0], r[0][2] + r[2][0])
    elif largest == 2:
        four = (r[0][2] - r[2][0], r[0][1] + r[1][0], 1 + 2 * r[1][1] - trace, r[1][2] + r[2][1])
    else:
        four = (r[1][0] - r[0][1], r[0][2] + r[2][0], r[1][2] + r[2][1], 1 + 2 * r[2][2] - trace)
    size = math.hypot(*four)
    return four[0] / size, four[1] / size, four[2] / size, four[3] / size


def rpy_from_rotation(rotation: Rotation) -> Vector:
    """Return URDF's rpy [rad] of a rotation, exact also at a pitch of ±90°.

    The roll is computed after undoing the yaw, so that their rounding errors cancel.
    """
    (r00, r01, r02), (r10, r11, r12), (r20, _, _) = rotation
    yaw = math.atan2(r10, r00)
    s, c = math.sin(yaw), math.cos(yaw)
    pitch = math.atan2(-r20, c * r00 + s * r10)
    return math.atan2(s * r02 - c * r12, c * r11 - s * r01), pitch, yaw


def multiply_matrices(a: Rotation, b: Rotation) -> Rotation:
    """Return ``a b``."""
    if a is IDENTITY_ROTATION:
        return b
    if b is IDENTITY_ROTATION:
        return a
    (b00, b01, b02), (b10, b11, b12), (b20, b21, b22) = b
    (a00, a01, a02), (a10, a11, a12), (a20, a21, a22) = a
    return (
        (
            a00 * b00 + a01 * b10 + a02 * b20,
            a00 * b01 + a01 * b11 + a02 * b21,
            a00 * b02 + a01 * b12 + a02 * b22,
        ),
        (
            a10 * b00 + a11 * b10 + a12 * b20,
            a10 * b01 + a11 * b11 + a12 * b21,
            a10 * b02 + a11 * b12 + a12 * b22,
        ),
        (
            a20 * b00 + a21 * b10 + a22 * b20,
            a20 * b01 + a21 * b11 + a22 * b21,
            a20 * b02 + a21 * b12 + a22 * b22,
        ),
    )


def transpose(a: Rotation) -> Rotation:
    """Return the transpose, the inverse of a rotation."""
    return a if a is IDENTITY_ROTATION else tuple(zip(*a, strict=True))  # type: ignore[return-value]


def rotate(rotation: Rotation, vector: Vector) -> Vector:
    """Return ``R v``."""
    if rotation is IDENTITY_ROTATION:
        return vector
    (a, b, c), (d, e, f), (g, h, i) = rotation
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def add(a: Vector, b: Vector) -> Vector:
    """Return ``a + b``."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def compute_dot(a: Vector, b: Vector) -> float:
    """Return ``a · b``."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def compute_norm(a: Vector) -> float:
    """Return ``|a|``."""
    return math.hypot(*a)


def compute_cross(a: Vector, b: Vector) -> Vector:
    """Return ``a × b``."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
