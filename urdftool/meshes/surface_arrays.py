"""What :mod:`urdftool.meshes.surface` says, for large meshes: by numpy, without scipy."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import MeshError
from .extremes import extreme_points
from .hull import convex_hull
from .load import load_mesh
from .mesh import Faces, Points
from .solid import Edges, collapsed, edges_of, merge_vertices
from .surface import WELD_TOLERANCE, Surface


def surface_by_arrays(path: Path) -> Surface | None:
    """The surface of a mesh file; None where it cannot be read."""
    try:
        mesh = load_mesh(path)
    except (MeshError, OSError):
        return None
    points, faces, edges = welded(mesh.vertices, mesh.faces)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    extent = float(np.ptp(mesh.vertices, axis=0).max())
    sliver = np.linalg.norm(normals, axis=1) <= 1e-12 * extent**2
    centred = corners - points.mean(axis=0)
    volume = np.einsum("ij,ij->", centred[:, 0], np.cross(centred[:, 1], centred[:, 2])) / 6
    return Surface(len(faces), edges.open_count, int(sliver.sum()), edges.cycle, float(volume))


def welded(vertices: Points, faces: Faces) -> tuple[Points, Faces, Edges]:
    """Merge equal points of a mesh; nearly equal ones too where that closes it."""
    best: tuple[Points, Faces, Edges] | None = None
    grid = WELD_TOLERANCE * float(np.ptp(vertices, axis=0).max())
    for shift in (None, 0.0, 0.5):
        # two points of one place may lie on two sides of a cell's border, but not of both grids'
        rounded = vertices if shift is None else np.floor(vertices / (grid or 1.0) + shift)
        _, merged = merge_vertices(rounded, faces)
        points = np.empty((int(merged.max()) + 1, 3))
        points[merged.reshape(-1)] = vertices[faces.reshape(-1)]
        edges = edges_of(merged[~collapsed(merged)])
        if best is None or edges.open_count < best[2].open_count:
            best = points, merged, edges
        if edges.closed:
            break
    assert best is not None
    return best


def hull_volume(path: str | Path) -> float | None:
    """The volume of the convex hull of a mesh file, in its unit cubed; None for a flat one."""
    try:
        hull = convex_hull(extreme_points(load_mesh(path).vertices))
    except (MeshError, OSError, ValueError):
        return None
    return None if hull is None else float(hull.volume())
