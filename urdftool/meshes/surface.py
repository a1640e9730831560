"""Whether the surface of a mesh is closed, looks outwards and has no slivers: without scipy.

:mod:`urdftool.meshes.solid` says more of a mesh, for those who compute with it.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..errors import MeshError
from .load import load_mesh
from .mesh import Faces, Points
from .outline import extremes
from .solid import WELD_TOLERANCE, Edges, collapsed, edges_of, merge_vertices

LARGEST = 32_000_000
"""Bytes of a file whose surface is looked at."""


class Surface(NamedTuple):
    """What can be said of the surface of a mesh.

    Attributes:
        faces: Triangles.
        open_edges: Edges with an odd number of triangles; 0 for a closed surface.
        flat: Triangles without an area.
        consistent: Whether neighbours are wound the same way round.
        volume: Signed volume in the file's unit cubed; of no meaning for an open surface.
    """

    faces: int
    open_edges: int
    flat: int
    consistent: bool
    volume: float

    @property
    def inside_out(self) -> bool:
        """Whether a closed surface looks inwards."""
        return not self.open_edges and self.consistent and self.volume < 0


def surface(path: str | Path) -> Surface | None:
    """The surface of a mesh file; None where it cannot be read or is larger than LARGEST."""
    try:
        if Path(path).stat().st_size > LARGEST:
            return None
        mesh = load_mesh(path)
    except (MeshError, OSError):
        return None
    points, faces, edges = _welded(mesh.vertices, mesh.faces)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    extent = float(np.ptp(mesh.vertices, axis=0).max())
    sliver = np.linalg.norm(normals, axis=1) <= 1e-12 * extent**2
    centred = corners - points.mean(axis=0)
    volume = np.einsum("ij,ij->", centred[:, 0], np.cross(centred[:, 1], centred[:, 2])) / 6
    return Surface(len(faces), edges.open_count, int(sliver.sum()), edges.cycle, float(volume))


def _welded(vertices: Points, faces: Faces) -> tuple[Points, Faces, Edges]:
    """The mesh with equal points merged; nearly equal ones too where that closes it."""
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
    from scipy.spatial import ConvexHull, QhullError

    try:
        return float(ConvexHull(extremes(load_mesh(path).vertices)).volume)
    except (MeshError, OSError, QhullError, ValueError):
        return None
