"""Poses of elements: ``pos`` [m] and ``quat`` (w, x, y, z) in the parent's frame."""

from __future__ import annotations

import math

from lxml import etree

from ...model.elements import Origin, Vector
from ...model.numbers import format_numbers_text
from ...model.pose import (
    Pose,
    Quaternion,
    quaternion_from_rotation,
    quaternion_from_rpy,
    rotation_from_quaternion,
)

_SAME = 1e-15
"""Parts of a quaternion below this, relative to the largest, are rounding."""


def set_origin(element: etree._Element, origin: Origin | None) -> None:
    """Set the pose of an element to a URDF origin; MuJoCo's defaults are not written."""
    if origin is None:
        return
    if any(origin.xyz):
        element.set("pos", format_numbers_text(origin.xyz))
    quaternion = get_quaternion(origin)
    if quaternion is not None:
        element.set("quat", format_numbers_text(quaternion))


def set_pose(element: etree._Element, pose: Pose) -> None:
    """Set the pose of an element; MuJoCo's defaults are not written."""
    if any(pose.translation):
        element.set("pos", format_numbers_text(pose.translation))
    quaternion = simplify_quaternion(quaternion_from_rotation(pose.rotation))
    if quaternion is not None:
        element.set("quat", format_numbers_text(quaternion))


def read_position(text: str | None) -> Vector:
    """Read a vector, such as a position [m]; zero for None."""
    x, y, z = (float(part) for part in (text or "0 0 0").split())
    return x, y, z


def read_pose(element: etree._Element) -> Pose:
    """Read the pose of an element from ``pos`` and ``quat``."""
    w, a, b, c = (float(part) for part in (element.get("quat") or "1 0 0 0").split())
    size = (w * w + a * a + b * b + c * c) ** 0.5
    return Pose(
        rotation_from_quaternion((w / size, a / size, b / size, c / size)),
        read_position(element.get("pos")),
    )


def get_quaternion(origin: Origin) -> Quaternion | None:
    """Return the simplified quaternion of an origin; None for no rotation."""
    if origin.quaternion is not None:
        x, y, z, w = origin.quaternion
        return simplify_quaternion((w, x, y, z))
    if not any(origin.rpy):
        return None
    return simplify_quaternion(quaternion_from_rpy(origin.rpy))


def simplify_quaternion(quaternion: Quaternion) -> Quaternion | None:
    """Simplify a quaternion (w, x, y, z) for writing; return None for no rotation.

    MuJoCo normalizes quaternions, so a quarter turn may be ``1 1 0 0``. Components count as equal
    or zero only within the last bits of a double.
    """
    size = max(map(abs, quaternion))
    if size == 0:
        return None
    parts = [0.0 if abs(part) < _SAME * size else part for part in quaternion]
    if all(part == 0 or abs(abs(part) - size) < 4 * _SAME * size for part in parts):
        parts = [math.copysign(1.0, part) if part else 0.0 for part in parts]
    if parts[0] < 0 or (parts[0] == 0 and next(filter(None, parts)) < 0):
        parts = [-part for part in parts]
    w, x, y, z = parts
    return None if x == y == z == 0 else (w, x, y, z)
