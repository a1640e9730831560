"""Comparison of collision and visual geometry: kinds, bounding boxes, surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ...compare.check import Check
from ...geometry.mesh import Faces
from ...mechanics.reference import Array, Mechanics, get_origin_matrix
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Mesh,
    Robot,
    Sphere,
    UnknownShape,
    Visual,
)
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .declared_losses import CUT, SHAPES, TORN
from .verify_meshes import SourceMeshes

SIMPLE, MESH = 1e-9, 1e-6
SINGLE = 2.0**-23
"""Rounding error of MuJoCo's mesh vertices, relative to the size."""

SURFACE = 0.05
"""Relative tolerance of surface areas: there are two triangulations
of a polygon that is not planar or not convex.
"""

Bounds = tuple[Array, Array]


def check_collision(
    robot: Robot,
    meshes: SourceMeshes,
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    declared: DeclaredLosses,
) -> Check:
    """Compare each collision's box in the root's frame, at zero and at one other configuration."""
    check = Check("collision", "number, kind, box and surface of every shape", MESH)
    for positions in configurations[:2]:
        frames = mechanics.compute_frames(positions)
        compiled.set_pose(positions)
        for link in robot.links:
            geoms = list(link_geoms(compiled, link, 3))
            known = declared.has_for((*SHAPES, *CUT), *get_loss_names(link)) or declared.has_any(
                *TORN
            )
            if len(geoms) != len(link.collisions):
                text = f"link '{link.name}': {len(geoms)} collisions of {len(link.collisions)}"
                check.compare(math.inf, text, known=known)
                continue
            for shape, geom in zip(link.collisions, geoms, strict=True):
                expected = _compute_bounds(meshes, shape, frames.get(link.name, np.eye(4)))
                if expected is None:
                    continue
                simple = not isinstance(shape.geometry, Mesh)
                factor = (
                    MESH / SIMPLE if simple else _get_rounded(expected)
                )  # for the row's tolerance
                difference = _compute_apart(expected, _compute_geom_bounds(compiled, geom)) * factor
                check.compare(difference, f"a collision of link '{link.name}'", known=known)
                apart = _compute_surface_apart(meshes, [shape], compiled, [geom], frames[link.name])
                check.compare(apart, f"surface of a collision of link '{link.name}'", known=known)
                kind, found = _get_kind(shape), _format_kind(compiled, geom)
                if kind != found:
                    text = f"a collision of link '{link.name}' is a {found}, not a {kind}"
                    check.compare(math.inf, text, known=known)
    return check


def check_visual(
    robot: Robot,
    meshes: SourceMeshes,
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    declared: DeclaredLosses,
) -> Check:
    """Compare the bounding box and surface of all visuals of a link."""
    check = Check("visual", "box and surface of the visuals of every link", MESH)
    frames = mechanics.compute_frames(configurations[0])
    compiled.set_pose(configurations[0])
    for link in robot.links:
        known = declared.has_for(SHAPES, *get_loss_names(link)) or declared.has_any(*TORN)
        geoms = list(link_geoms(compiled, link, 2))
        frame = frames.get(link.name, np.eye(4))
        boxes = [
            box for v in link.visuals if (box := _compute_bounds(meshes, v, frame)) is not None
        ]
        if bool(boxes) != bool(geoms):
            text = f"link '{link.name}': {len(geoms)} visuals of {len(boxes)}"
            check.compare(math.inf, text, known=known)
        elif boxes:
            found = _make_union([_compute_geom_bounds(compiled, geom) for geom in geoms])
            difference = _compute_apart(_make_union(boxes), found) * _get_rounded(
                _make_union(boxes)
            )
            check.compare(difference, f"visuals of link '{link.name}'", known=known)
            apart = _compute_surface_apart(meshes, link.visuals, compiled, geoms, frame)
            check.compare(apart, f"surface of the visuals of link '{link.name}'", known=known)
    return check


def link_geoms(compiled: Compiled, link: Link, group: int) -> Iterator[int]:
    """Yield the geoms of a link in a group, in file order."""
    body = compiled.get_body(link.name)
    for geom in compiled.get_geoms(body):
        if compiled.model.geom_group[geom] == group:
            yield geom


def has_size(meshes: SourceMeshes, shape: Visual | Collision) -> bool:
    """Tell whether a shape has a size, and a mesh that can be read."""
    return _compute_bounds(meshes, shape, np.eye(4)) is not None


def _compute_apart(one: Bounds, other: Bounds) -> float:
    return float(max(abs(one[0] - other[0]).max(), abs(one[1] - other[1]).max()))


def _get_rounded(box: Bounds) -> float:
    """Return the weight of a difference for meshes too large for single precision; else 1."""
    return min(1.0, MESH / (SINGLE * float(np.max(box[1] - box[0])) or MESH))


def _make_union(boxes: list[Bounds]) -> Bounds:
    return np.min([box[0] for box in boxes], axis=0), np.max([box[1] for box in boxes], axis=0)


def _compute_bounds(meshes: SourceMeshes, shape: Visual | Collision, frame: Array) -> Bounds | None:
    """Compute the box of a shape of the description; None if it has no size or cannot be read."""
    pose = frame @ get_origin_matrix(shape.origin)
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        points = meshes.read(geometry.filename, geometry.scale)
        if points is None:
            return None
        is_used = np.zeros(len(points.vertices), dtype=bool)
        is_used[points.faces] = True
        used = points.vertices[is_used]
        placed = used @ pose[:3, :3].T + pose[:3, 3]
        return placed.min(axis=0), placed.max(axis=0)
    half = _compute_half(geometry, pose[:3, :3]) if geometry is not None else None
    return None if half is None else (pose[:3, 3] - half, pose[:3, 3] + half)


def _compute_surface_apart(
    meshes: SourceMeshes,
    shapes: Sequence[Visual | Collision],
    compiled: Compiled,
    geoms: Sequence[int],
    frame: Array,
) -> float:
    """Compute the difference of area and area centroid of all meshes, for the row's tolerance.

    This distinguishes meshes with the same bounding box, independent of the triangulation.
    """
    expected, found = np.zeros(4), np.zeros(4)
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            mesh = meshes.read(shape.geometry.filename, shape.geometry.scale)
            if mesh is None:
                return 0.0
            pose = frame @ get_origin_matrix(shape.origin)
            expected += _compute_area_moments(
                mesh.vertices @ pose[:3, :3].T + pose[:3, 3], mesh.faces
            )
    model = compiled.model
    for geom in geoms:
        if _format_kind(compiled, geom) == "mesh":
            number, pose = model.geom_dataid[geom], compiled.get_geom_frame(geom)
            first, count = model.mesh_vertadr[number], model.mesh_vertnum[number]
            points = model.mesh_vert[first : first + count].astype(float)
            begin, many = model.mesh_faceadr[number], model.mesh_facenum[number]
            faces = model.mesh_face[begin : begin + many]
            found += _compute_area_moments(points @ pose[:3, :3].T + pose[:3, 3], faces)
    if expected[0] == found[0] == 0:
        return 0.0
    size = math.sqrt(max(expected[0], found[0]))
    area = float(abs(expected[0] - found[0])) / size**2
    centers = [moments[1:] / (moments[0] or 1.0) for moments in (expected, found)]
    return max(area, float(abs(centers[0] - centers[1]).max()) / size) * MESH / SURFACE


def _compute_area_moments(points: Array, faces: Faces) -> Array:
    """Compute the area [m²] of triangles, and its first moment [m³]."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    middles = (a + b + c) / 3
    return np.concatenate([[areas.sum()], areas @ middles])


def _get_kind(shape: Visual | Collision) -> str:
    """Return MuJoCo's name for the kind of a shape; a capsule without length is a sphere."""
    geometry = shape.geometry
    if isinstance(geometry, Capsule) and geometry.length == 0:
        return "sphere"
    return type(geometry).__name__.lower()


def _format_kind(compiled: Compiled, geom: int) -> str:
    kind = compiled.mujoco.mjtGeom(compiled.model.geom_type[geom])
    return str(kind.name).removeprefix("mjGEOM_").lower()


def _compute_half(geometry: Geometry, turn: Array) -> Array | None:
    """Compute half the edges of the box around a rotated primitive; None without a size."""
    if isinstance(geometry, Box):
        return abs(turn) @ np.array(geometry.size) / 2 if min(geometry.size) > 0 else None
    if isinstance(geometry, UnknownShape):
        return None
    if isinstance(geometry, Sphere):
        return np.full(3, geometry.radius) if geometry.radius > 0 else None
    if isinstance(geometry, Ellipsoid):
        half: Array = np.sqrt((turn**2) @ np.square(geometry.radii))
        return half if min(geometry.radii) > 0 else None
    if isinstance(geometry, Cylinder | Capsule):
        return _round_half(
            isinstance(geometry, Capsule), geometry.radius, geometry.length / 2, turn
        )
    return None


def _round_half(capsule: bool, radius: float, half: float, turn: Array) -> Array | None:
    if radius <= 0 or half < 0 or (half == 0 and not capsule):
        return None
    across = np.ones(3) if capsule else np.hypot(turn[:, 0], turn[:, 1])
    reach: Array = abs(turn[:, 2]) * half + radius * across
    return reach


def _compute_geom_bounds(compiled: Compiled, geom: int) -> Bounds:
    """Compute the box of a geom in the root's frame."""
    model, frame = compiled.model, compiled.get_geom_frame(geom)
    kind = _format_kind(compiled, geom)
    size, turn, middle = model.geom_size[geom], frame[:3, :3], frame[:3, 3]
    if kind == "mesh":
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        points = model.mesh_vert[first : first + count].astype(float) @ turn.T + middle
        return points.min(axis=0), points.max(axis=0)
    if kind == "box":
        half = abs(turn) @ size
    elif kind == "sphere":
        half = np.full(3, size[0])
    elif kind in ("cylinder", "capsule"):
        rounded = _round_half(kind == "capsule", float(size[0]), float(size[1]), turn)
        half = np.zeros(3) if rounded is None else rounded
    else:
        half = np.sqrt(((turn * size) ** 2).sum(axis=1))
    return middle - half, middle + half


def get_loss_names(link: Link) -> set[str]:
    """Return the names by which losses refer to a link: its own, its materials', its meshes'."""
    names = {link.name}
    names |= {visual.material.name for visual in link.visuals if visual.material is not None}
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            names.add(shape.geometry.filename.rpartition("/")[2])
    return names
