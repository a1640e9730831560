"""Correction of glTF meshes for Gazebo, which keeps the axes of the file (Y up).

A reader that converts axes maps a point ``p`` of the file to ``R S T p``, with the conversion
``T``, the scale ``S`` and the pose ``R``. Gazebo does not convert the axes; the equivalent is
``(R T) S' p``, where ``S' = Tᵀ S T`` has the scales of Y and Z exchanged.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from ...model.elements import Collision, Link, Mesh, Origin, Visual
from ...model.gltf_axes import is_gltf
from ...model.pose import Pose, make_pose, rpy_from_rotation
from .translation import Translation

S = TypeVar("S", Visual, Collision)

TURN = Pose(((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)))


def undo_axis_conversion(t: Translation, link: Link, shape: S) -> S:
    """Return a shape for a reader that keeps the axes of a glTF file; others unchanged."""
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
    pose = make_pose(shape.origin) @ TURN
    x, y, z = mesh.scale
    return replace(
        shape,
        origin=Origin(shape.provenance, pose.translation, rpy_from_rotation(pose.rotation)),
        geometry=replace(mesh, scale=(x, z, y)),
    )
