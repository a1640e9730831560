"""Robots as scenes of trimesh: one node for each link, with its meshes and primitives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import MeshError, UrdftoolError
from ..model.elements import Collision, Mesh, Robot, Visual
from ..model.kinematics import check_positions, compute_link_poses
from ..model.materials import resolve_material
from ..model.pose import Pose, make_pose
from ..model.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Plane,
    Sphere,
    UnknownShape,
)
from .image_file import open_image
from .load import load_mesh
from .mesh import Array, Part
from .mesh import Mesh as Triangles
from .tessellate import tessellate

if TYPE_CHECKING:
    import trimesh

    from ..workspace import Workspace

_GRAY = (0.7, 0.7, 0.7, 1.0)
"""Color of a surface without one. Chosen, no source."""


def make_scene(
    robot: Robot, positions: Mapping[str, float] | None = None, *, collision: bool = False
) -> trimesh.Scene:
    """Return a robot as a scene of trimesh, with a node named after each link.

    Args:
        robot: The robot.
        positions: Joint positions by name [rad, m]; mimic joints follow. 0 by default.
        collision: Whether the scene has the collision geometry in place of the visual one.

    Raises:
        ModelError: The robot lacks a joint of ``positions``, or a position is not a finite number.
        UrdftoolError: A mesh cannot be found or read.
    """
    import trimesh

    scene: Any = trimesh.Scene(base_frame="world")
    loaded: dict[tuple[str, tuple[float, ...]], Triangles] = {}
    check_positions(robot, positions or {})
    poses = compute_link_poses(robot, positions or {})
    for name, pose in poses.items():
        scene.graph.update(frame_from="world", frame_to=name, matrix=make_matrix(pose))
        link = robot.link[name]
        shapes: Sequence[Visual | Collision] = link.collisions if collision else link.visuals
        for number, shape in enumerate(shapes):
            own = shape.material if isinstance(shape, Visual) else None
            material = resolve_material(robot, own)
            rgba = None if material is None else material.color
            matrix = make_matrix(make_pose(shape.origin))
            for part, geometry in enumerate(_make_shapes(robot, shape.geometry, rgba, loaded)):
                title = f"{name}/{number}.{part}"
                scene.add_geometry(geometry, title, title, parent_node_name=name, transform=matrix)
    made: trimesh.Scene = scene
    return made


def make_matrix(pose: Pose) -> Array:
    """Return a pose as a homogeneous matrix, shape (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose.rotation, pose.translation
    return matrix


def _make_shapes(
    robot: Robot,
    shape: Geometry | None,
    rgba: tuple[float, ...] | None,
    loaded: dict[tuple[str, tuple[float, ...]], Triangles],
) -> list[Any]:
    """Return the meshes of trimesh of a shape: one for each material of a mesh file."""
    import trimesh

    if isinstance(shape, Mesh):
        if robot.source is None:
            raise UrdftoolError(f"mesh '{shape.filename}' is not found")
        key = (shape.filename, shape.scale)
        if key not in loaded:
            path = robot.source.resolve(shape.filename)
            loaded[key] = load_mesh(path, shape.scale, gltf_up=robot.source.gltf_up)
        mesh = loaded[key]
        workspace = robot.source.workspace
        return [_make_part(mesh, part, rgba, workspace) for part in mesh.parts]
    size = _get_size(shape)
    if size is None:
        return []
    vertices, faces = tessellate(*size, 48)
    made = trimesh.Trimesh(vertices, faces, process=False)
    _paint(made, rgba or _GRAY)
    return [made]


def _make_part(
    mesh: Triangles, part: Part, rgba: tuple[float, ...] | None, workspace: Workspace
) -> Any:
    """Return a part of a mesh file with its color or texture; ``rgba`` if the file has none."""
    import trimesh

    image = _read_image(part, workspace)
    faces = mesh.get_part_faces(part)
    if image is not None and part.uv is not None:
        made = trimesh.Trimesh(
            mesh.vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3), process=False
        )
        visuals: Any = trimesh.visual
        made.visual = visuals.TextureVisuals(uv=part.uv.reshape(-1, 2), image=image)
        return made
    used, inverse = np.unique(faces, return_inverse=True)
    made = trimesh.Trimesh(mesh.vertices[used], inverse.reshape(-1, 3), process=False)
    _paint(made, part.rgba or rgba or _GRAY)
    return made


def _read_image(part: Part, workspace: Workspace) -> Any:
    """Return the image of a part for Pillow; None without an image or without Pillow."""
    source = part.texture if part.image is None else part.image
    try:
        if isinstance(source, Path):
            source = workspace.read_bytes(source)
        return None if source is None else open_image(source)
    except (ImportError, MeshError, OSError):
        return None


def _paint(mesh: Any, rgba: tuple[float, ...]) -> None:
    mesh.visual.face_colors = np.round(np.clip(rgba, 0, 1) * np.array(255)).astype(np.uint8)


def _get_size(shape: Geometry | None) -> tuple[str, tuple[float, ...]] | None:
    """Return kind and size of a primitive for ``tessellate``; None for other shapes."""
    if isinstance(shape, Box):
        return "box", shape.size
    if isinstance(shape, Sphere):
        return "sphere", (shape.radius,)
    if isinstance(shape, Cylinder):
        return "cylinder", (shape.radius, shape.length)
    if isinstance(shape, Capsule):
        return "capsule", (shape.radius, shape.length)
    if isinstance(shape, Cone):
        return "cone", (shape.radius, shape.length)
    if isinstance(shape, Ellipsoid):
        return "ellipsoid", shape.radii
    assert shape is None or isinstance(shape, (Mesh, Plane, UnknownShape))
    return None
