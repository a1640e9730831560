"""Poses as SDF writes them: ``x y z roll pitch yaw``, with URDF's angles."""

from __future__ import annotations

import math

from ...model.elements import Origin, Vector
from ...model.pose import Pose, Rotation, rotation_of_quaternion
from ..numbers import numbers_text
from .xml import Node, add


def angles_of(rotation: Rotation) -> Vector:
    """Roll, pitch and yaw of a rotation [rad], exact also where the pitch is a right angle.

    The roll is taken after the yaw is undone, so that what rounding does to one undoes what it does
    to the other.
    """
    (r00, r01, r02), (r10, r11, r12), (r20, _, _) = rotation
    yaw = math.atan2(r10, r00)
    s, c = math.sin(yaw), math.cos(yaw)
    pitch = math.atan2(-r20, c * r00 + s * r10)
    return math.atan2(s * r02 - c * r12, c * r11 - s * r01), pitch, yaw


def set_origin(
    node: Node, origin: Origin | None, relative_to: str = "", exact: bool = True
) -> None:
    """Give an element the pose of an ``<origin>``, number by number.

    Args:
        node: The element.
        origin: The origin; None is the identity.
        relative_to: The frame it is in; the element's own parent if empty.
        exact: Whether quaternions can be written (from SDF 1.9 on).
    """
    if origin is None or (origin.quaternion is None and not any((*origin.xyz, *origin.rpy))):
        if relative_to:
            add(node, "pose", "0 0 0 0 0 0", relative_to=relative_to)
        return
    frame = {"relative_to": relative_to} if relative_to else {}
    if origin.quaternion is not None and exact:
        text = numbers_text((*origin.xyz, *origin.quaternion))
        add(node, "pose", text, rotation_format="quat_xyzw", **frame)
        return
    rpy = origin.rpy
    if origin.quaternion is not None:
        x, y, z, w = origin.quaternion
        rpy = angles_of(rotation_of_quaternion((w, x, y, z)))
    add(node, "pose", numbers_text((*origin.xyz, *rpy)), **frame)


def set_pose(node: Node, pose: Pose, relative_to: str = "") -> None:
    """Give an element a pose that was computed; the identity in its parent is not written."""
    numbers = (*pose.translation, *angles_of(pose.rotation))
    if any(numbers) or relative_to:
        frame = {"relative_to": relative_to} if relative_to else {}
        add(node, "pose", numbers_text(numbers), **frame)
