"""Poses in SDF notation: ``x y z roll pitch yaw`` [m, rad], with the same angles as URDF."""

from __future__ import annotations

from ...model.elements import Origin
from ...model.numbers import format_pose_text
from ...model.pose import Pose, rotation_from_quaternion, rpy_from_rotation
from .xml import Node, add


def set_origin(
    node: Node, origin: Origin | None, relative_to: str = "", exact: bool = True
) -> None:
    """Set the pose of an element to an ``<origin>``, with its numbers unchanged.

    Args:
        node: The element.
        origin: The origin; None is the identity.
        relative_to: Frame of the pose; empty for the element's default.
        exact: Whether quaternions can be written (from SDF 1.9 on).
    """
    if origin is None or (origin.quaternion is None and not any((*origin.xyz, *origin.rpy))):
        if relative_to:
            add(node, "pose", "0 0 0 0 0 0", relative_to=relative_to)
        return
    frame = {"relative_to": relative_to} if relative_to else {}
    if origin.quaternion is not None and exact:
        text = format_pose_text((*origin.xyz, *origin.quaternion))
        add(node, "pose", text, rotation_format="quat_xyzw", **frame)
        return
    rpy = origin.rpy
    if origin.quaternion is not None:
        x, y, z, w = origin.quaternion
        rpy = rpy_from_rotation(rotation_from_quaternion((w, x, y, z)))
    add(node, "pose", format_pose_text((*origin.xyz, *rpy)), **frame)


def set_pose(node: Node, pose: Pose, relative_to: str = "") -> None:
    """Set the pose of an element; without ``relative_to`` the identity is not written."""
    numbers = (*pose.translation, *rpy_from_rotation(pose.rotation))
    if any(numbers) or relative_to:
        frame = {"relative_to": relative_to} if relative_to else {}
        add(node, "pose", format_pose_text(numbers), **frame)
