"""Topology of triangles: edges, closedness, winding, bodies.

A mesh is *closed* if every edge has an even number of faces (no rim), and *consistently wound* if
faces traverse each edge equally often in both directions. Both together make it the boundary of a
solid (algebraically, a cycle), which is exactly what the volume integrals require. An edge shared
by four faces, where two bodies touch, is valid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..diagnostic import Diagnostic, make_warning
from .mesh import Faces, Points

WELD_TOLERANCE = 1e-6
"""Distance, relative to the mesh's extent, below which points may be rounded copies of one point.
Chosen, no source."""

LARGE_EXTENT = 10.0
"""Extent of a link's mesh [m] above which its unit is probably the millimeter. Chosen, no source.
"""

SMALL_EXTENT = 0.001
"""Extent of a link's mesh [m] below which it was probably scaled twice. Chosen, no source."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges of a mesh with their adjacent faces."""

    pairs: Faces
    """The two vertices of each edge, smaller index first, shape (e, 2)."""
    forward: npt.NDArray[np.int64]
    """Number of faces that traverse the edge from its smaller to its larger vertex."""
    backward: npt.NDArray[np.int64]
    """Number of faces that traverse it in the other direction."""
    order: npt.NDArray[np.int64]
    """All half-edges (three per face: row // 3 is the face), sorted by edge."""
    starts: npt.NDArray[np.int64]
    """First row of each edge in ``order``."""

    @property
    def closed(self) -> bool:
        """Tell whether every edge has an even number of faces."""
        return self.open_count == 0

    @property
    def open_count(self) -> int:
        """Return the number of edges with an odd number of faces."""
        return int(np.count_nonzero((self.forward + self.backward) % 2))

    @property
    def cycle(self) -> bool:
        """Tell whether faces traverse every edge equally often in both directions."""
        return bool(np.array_equal(self.forward, self.backward))


def explain_unit_suspicion(extent: float) -> Diagnostic | None:
    """Explain why the extent [m] of one link's mesh suggests a wrong unit; None if it does not.

    Of 4,325 meshes in public robots, all but ten have an extent below 2.03 m. Those ten are above
    99 m: millimeters read as meters. Meshes below 1 mm are in meters but were scaled by 0.001.
    """
    if extent > LARGE_EXTENT:
        return make_warning(
            "mesh-in-millimeters",
            f"The mesh is {extent:.4g} m long, so its unit is probably the millimeter; "
            'scale="0.001 0.001 0.001" would make it a link\'s size.',
            extent=extent,
        )
    if 0 < extent < SMALL_EXTENT:
        return make_warning(
            "mesh-scaled-twice",
            f"The mesh is {extent:.4g} m long, so it was probably scaled to meters twice; without "
            "its scale it would be a link's size.",
            extent=extent,
        )
    return None


def weld(vertices: Points, faces: Faces) -> tuple[Points, Faces, Edges]:
    """Merge equal points of a mesh, and find the edges of the faces that do not collapse.

    Equal points are merged. If the surface is then not closed and consistently wound, points within
    ``WELD_TOLERANCE`` of its extent are merged if that reduces the number of open edges.

    Returns:
        Points, faces on them, and edges.
    """
    points, merged = merge_vertices(vertices, faces)
    edges = find_edges(merged[~find_collapsed(merged)])
    if edges.cycle or not len(faces):
        return points, merged, edges
    tolerance = WELD_TOLERANCE * float(np.ptp(points, axis=0).max())
    nearer, welded = merge_vertices(points, merged, tolerance=tolerance)
    closer = find_edges(welded[~find_collapsed(welded)])
    if closer.open_count < edges.open_count:
        return nearer, welded, closer
    return points, merged, edges


def weld_on_grids(vertices: Points, faces: Faces) -> tuple[Points, Faces, Edges]:
    """Merge equal points of a mesh, and nearly equal ones if that closes it.

    Unlike :func:`weld` this needs no scipy: nearly equal points are those in one cell of a grid.

    Returns:
        Points, faces on them, and edges.
    """
    best: tuple[Points, Faces, Edges] | None = None
    grid = WELD_TOLERANCE * float(np.ptp(vertices, axis=0).max())
    for shift in (None, 0.0, 0.5):
        # copies of one point may straddle a cell border, but not of both shifted grids
        rounded = vertices if shift is None else np.floor(vertices / (grid or 1.0) + shift)
        _, merged = merge_vertices(rounded, faces)
        points = np.empty((int(merged.max()) + 1, 3))
        points[merged.reshape(-1)] = vertices[faces.reshape(-1)]
        edges = find_edges(merged[~find_collapsed(merged)])
        if best is None or edges.open_count < best[2].open_count:
            best = points, merged, edges
        if edges.closed:
            break
    assert best is not None
    return best


def merge_vertices(
    vertices: Points, faces: Faces, *, tolerance: float = 0.0
) -> tuple[Points, Faces]:
    """Merge points so that each occurs once; points that no face uses are dropped.

    Args:
        vertices: Points [m], shape (n, 3).
        faces: Indices into ``vertices``.
        tolerance: Distance [m] within which points are merged; 0 for exact equality.
    """
    if tolerance > 0:
        from scipy.spatial import cKDTree

        pairs = cKDTree(vertices).query_pairs(tolerance, output_type="ndarray")
        inverse = label_components(len(vertices), pairs[:, 0], pairs[:, 1])
        first = np.unique(inverse, return_index=True)[1]
    else:
        # adding zero maps -0.0 to 0.0, so that equal points have equal bits
        bits = np.ascontiguousarray(vertices + 0.0).view(np.uint64)
        _, first, inverse = np.unique(_hash_rows(bits), return_index=True, return_inverse=True)
        if not np.array_equal(bits[first[inverse]], bits):
            _, first, inverse = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    merged = inverse.reshape(-1)[faces]
    seen = np.zeros(len(first), dtype=bool)
    seen[merged.reshape(-1)] = True
    renumbered = np.cumsum(seen) - 1
    return vertices[first[seen]], renumbered[merged].astype(np.int64)


def find_used_vertices(faces: Faces, count: int) -> npt.NDArray[np.int64]:
    """Return the indices of the vertices that faces use, ascending."""
    used = np.zeros(count, dtype=bool)
    used[faces.reshape(-1)] = True
    return np.flatnonzero(used)


def find_collapsed(faces: Faces) -> npt.NDArray[np.bool_]:
    """Find the faces that use one vertex twice."""
    return np.asarray(
        (faces[:, 0] == faces[:, 1]) | (faces[:, 1] == faces[:, 2]) | (faces[:, 2] == faces[:, 0])
    )


def find_edges(faces: Faces) -> Edges:
    """Find the edges of faces on merged vertices, none of them collapsed."""
    begin = faces.reshape(-1)
    end = faces[:, [1, 2, 0]].reshape(-1)
    count = int(begin.max(initial=-1)) + 1
    key = np.minimum(begin, end) * count + np.maximum(begin, end)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    starts = np.flatnonzero(np.r_[True, ordered[1:] != ordered[:-1]]) if len(key) else order
    sizes = np.diff(np.r_[starts, len(key)])
    along = (begin < end)[order].astype(np.int64)
    forward = np.add.reduceat(along, starts) if len(key) else along
    keys = ordered[starts]
    pairs = np.stack([keys // max(count, 1), keys % max(count, 1)], axis=1)
    return Edges(pairs, forward, sizes - forward, order, starts)


def find_neighbors(edges: Edges) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return pairs of faces that share an edge; an edge of more than two faces gives a chain."""
    face = edges.order // 3
    same = np.ones(len(face), dtype=bool)
    same[edges.starts] = False
    later = np.flatnonzero(same)
    return face[later - 1], face[later]


def label_bodies(count: int, edges: Edges) -> npt.NDArray[np.int64]:
    """Number the connected bodies from 0, and return the number of each of ``count`` faces."""
    return label_components(count, *find_neighbors(edges))


def label_components(
    count: int, first: npt.NDArray[np.int64], second: npt.NDArray[np.int64]
) -> npt.NDArray[np.int64]:
    """Number the connected components of items; ``first[i]`` is linked to ``second[i]``."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    links = coo_matrix((np.ones(len(first), dtype=np.int8), (first, second)), shape=(count, count))
    labels = connected_components(links, directed=False)[1]
    return np.asarray(labels, dtype=np.int64)


def _hash_rows(bits: npt.NDArray[np.uint64]) -> npt.NDArray[np.uint64]:
    """Hash each row of three; equal rows have equal hashes, and collisions are rare."""
    mixed = np.zeros(len(bits), dtype=np.uint64)
    for axis, factor in enumerate((0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)):
        part = bits[:, axis] * np.uint64(factor)
        mixed ^= part ^ (part >> np.uint64(29 + axis))
        mixed *= np.uint64(0xBF58476D1CE4E5B9)
        mixed ^= mixed >> np.uint64(32)
    return mixed
