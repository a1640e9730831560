"""Preparation of a mesh: merged points, valid faces, consistent winding."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..diagnostic import Diagnostic, make_remark
from ..errors import MeshError
from ..geometry.load import FARTHEST, load_mesh
from ..geometry.mesh import Faces, Points
from ..geometry.topology import (
    find_collapsed,
    find_edges,
    find_neighbors,
    find_used_vertices,
    label_components,
    weld,
)
from ..inertia.repair import drop_duplicates, orient
from ..model.pose import Pose
from ..source.description import GltfUp

SLIVER = 1e-14
"""Area of a face, relative to the square of the mesh's size, below which it is degenerate. Chosen,
no source."""

FLAT = 1 - 1e-6
"""Cosine of the angle between neighbors that belong to one flat side. Chosen, no source."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """A mesh prepared for simplification.

    Attributes:
        vertices: Points [m], each once.
        faces: Triangles on distinct points; wound outward if the mesh is closed.
        triangles: Number of triangles in the file.
        points: Number of distinct vertices in the file.
        closed: Whether the surface bounds a solid.
        size: Diagonal [m] of the bounding box, to which errors are relative.
        notes: Defects and repairs.
        meshes: Number of meshes that are merged in it.
    """

    vertices: Points
    faces: Faces
    triangles: int
    points: int
    closed: bool
    size: float
    notes: tuple[Diagnostic, ...]
    meshes: int = 1

    @property
    def corners(self) -> Points:
        """Return the triangles [m], shape (m, 3, 3)."""
        return self.vertices[self.faces]

    @property
    def volume(self) -> float:
        """Return the enclosed volume of a closed surface [m³]."""
        a, b, c = (self.corners[:, k] - self.vertices.mean(axis=0) for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def read_surface(
    path: str | Path, scale: Sequence[float] = (1.0, 1.0, 1.0), gltf_up: GltfUp = "y"
) -> Prepared:
    """Read a mesh file and prepare it.

    Raises:
        MeshError: It cannot be read, or has no face with an area.
    """
    mesh = load_mesh(path, scale, gltf_up=gltf_up)
    prepared = prepare(
        mesh.vertices,
        mesh.faces,
        notes=[make_remark(note.code, note.message) for note in mesh.notes],
    )
    if prepared is None:
        raise MeshError("all faces of the mesh are degenerate; none has an area", path=path)
    return prepared


def merge_surfaces(first: Prepared, others: Sequence[tuple[Prepared, Pose]]) -> Prepared:
    """Merge meshes of a link in the frame of the first one; the others have poses in that frame.

    Raises:
        MeshError: The meshes are too far apart.
    """
    vertices, faces, total = [first.vertices], [first.faces], len(first.vertices)
    for surface, pose in others:
        turn, shift = np.array(pose.rotation), np.array(pose.translation)
        vertices.append(surface.vertices @ turn.T + shift)
        faces.append(surface.faces + total)
        total += len(surface.vertices)
    every = [first, *(surface for surface, _ in others)]
    points = np.concatenate(vertices)
    extent = np.ptp(points, axis=0)
    if not float(extent.max()) < FARTHEST:
        raise MeshError(f"the meshes are {extent.max():.3g} m wide, which is not measured")
    return Prepared(
        points,
        np.concatenate(faces),
        sum(one.triangles for one in every),
        sum(one.points for one in every),
        all(one.closed for one in every),
        float(np.linalg.norm(extent)),
        tuple(note for one in every for note in one.notes),
        len(every),
    )


def prepare(vertices: Points, faces: Faces, *, notes: Sequence[Diagnostic] = ()) -> Prepared | None:
    """Merge points, drop collapsed or duplicate faces, and make the winding consistent.

    Args:
        vertices: Points [m], shape (n, 3).
        faces: Triangles, shape (m, 3).
        notes: Notes to which those of the preparation are added.

    Returns:
        None if no face has an area.

    Raises:
        MeshError: The points are too far apart.
    """
    remarks = list(notes)
    triangles = len(faces)
    extent = float(np.ptp(vertices, axis=0).max(initial=0.0)) if len(vertices) else 0.0
    if not extent < FARTHEST:
        raise MeshError(f"the mesh is {extent:.3g} m wide, which is not measured")
    points, merged, _ = weld(vertices, faces)
    count = len(points)
    sound = ~find_collapsed(merged)
    corners = points[merged]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    if not (sound & (areas > SLIVER * extent**2)).any():
        return None
    # faces on a line may close a surface, so only collapsed ones are dropped
    dropped = int(np.count_nonzero(~sound))
    kept = drop_duplicates(merged[sound])
    twice = int(np.count_nonzero(sound)) - len(kept)
    if not len(kept):
        kept, twice = merged[sound], 0
    kept, turned = orient(points, kept)
    edges = find_edges(kept)
    closed = edges.cycle
    if dropped:
        message = f"{dropped} degenerate faces were dropped."
        remarks.append(make_remark("degenerate-faces", message, count=dropped))
    if twice:
        message = f"{twice} faces written twice were dropped."
        remarks.append(make_remark("repeated-faces", message, count=twice))
    if turned:
        message = f"{turned} faces were reversed to agree with their neighbors."
        remarks.append(make_remark("turned-faces", message, count=turned))
    used = find_used_vertices(kept, len(points))
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    points, kept = points[used], number[kept].astype(np.int64)
    prepared = Prepared(
        points, kept, triangles, count, closed, float(np.linalg.norm(np.ptp(points, axis=0))), ()
    )
    if closed and prepared.volume < 0:
        kept = np.ascontiguousarray(kept[:, ::-1])
        remarks.append(make_remark("inside-out", "The mesh is inside out; it was turned."))
    if not closed:
        message = f"The mesh is open ({edges.open_count} edges have an odd number of faces)."
        remarks.append(make_remark("open-mesh", message, edges=edges.open_count))
    return Prepared(points, kept, triangles, count, closed, prepared.size, tuple(remarks))


def label_flat_sides(surface: Prepared) -> npt.NDArray[np.int64]:
    """Number the flat sides from 0, and return the number of each face."""
    corners = surface.corners
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = normals / np.where(lengths > 0, lengths, 1.0)
    first, second = find_neighbors(find_edges(surface.faces))
    same = np.abs(np.einsum("ij,ij->i", unit[first], unit[second])) > FLAT
    return label_components(len(surface.faces), first[same], second[same])
