"""glTF in Gazebo, which keeps the axes of the file: what turns Y up to Z goes into the pose.

Of a point ``p`` of the file a reader that turns shows ``R S T p``, with ``T`` the turn, ``S`` the
scale and ``R`` the pose. Gazebo, which does not, shows the same as ``(R T) S' p``, where
``S' = Tᵀ S T`` has the factors of Y and Z exchanged.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from ...model.elements import Collision, Link, Mesh, Origin, Visual
from ...model.gltf_axes import is_gltf
from ...model.pose import Pose, pose_of, rpy_of_rotation
from .translation import Translation

S = TypeVar("S", Visual, Collision)

TURN = Pose(((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)))


def in_file_axes(t: Translation, link: Link, shape: S) -> S:
    """A shape as it is written for a reader that keeps the axes of a glTF file; others as is."""
    mesh = shape.geometry
    source = t.robot.source
    if not isinstance(mesh, Mesh) or not is_gltf(shape) or source is None or source.gltf_up != "y":
        return shape
    t.report_note(
        "gltf-axes",
        f"mesh '{mesh.filename}' of link '{link.name}' has Y up, and Gazebo keeps the axes of a "
        "glTF file; its pose turns it (not with --gltf-up z)",
        mesh,
        link,
    )
    pose = pose_of(shape.origin) @ TURN
    x, y, z = mesh.scale
    return replace(
        shape,
        origin=Origin(shape.element, pose.translation, rpy_of_rotation(pose.rotation)),
        geometry=replace(mesh, scale=(x, z, y)),
    )
