"""Decimate triangle meshes by quadric error; a closed surface stays closed.

Vertices are merged into neighbors and never moved, in order of the quadric error of Garland and
Heckbert (Surface Simplification Using Quadric Error Metrics, SIGGRAPH 1997). Merging vertices keeps
the boundary of a surface algebraically, so that a closed mesh remains closed, manifold or not.
Libraries with wheels for every platform were measured on meshes of machined parts:
fast-simplification and pyfqmr stop at up to 13 times the requested triangles, with several times
the error, and libigl refuses meshes that are not manifold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Faces, Points
from ..geometry.topology import find_used_vertices

BORDER_WEIGHT = 10.0
"""Weight of the planes that keep open borders in place, relative to those of the faces. Chosen, no
source."""

LARGEST_TURN = 0.25
"""Cosine of the angle by which a merge may turn a face; a larger turn folds the surface. Chosen,
no source."""

CHEAPEST = 0.2
"""Share of the vertices, cheapest first, that one pass considers: lower is nearer to one by one.
Chosen, no source."""

LARGE_MESH, LARGE_SHARE = 50_000, 0.5
"""Triangles above which a pass considers a larger share, as most merges are far from the end.
Chosen, no source."""

ATTEMPTS = 3
"""Neighbors of a vertex that one pass tries, cheapest first. Chosen, no source."""

_Array = npt.NDArray[Any]
_Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Decimated:
    """A decimated mesh.

    Attributes:
        vertices: Points [m], a subset of those of the mesh.
        faces: Triangles, indices into ``vertices``.
        wedges: Wedge of each corner of the triangles; None if the mesh has no wedges.
        rows: Triangle of the mesh that each triangle was, in its order.
    """

    vertices: Points
    faces: Faces
    wedges: Faces | None
    rows: Faces


def decimate(vertices: Points, faces: Faces, target: int) -> tuple[Points, Faces]:
    """Reduce a mesh to a number of triangles, or to as few as its shape allows.

    Args:
        vertices: Points [m], each once, shape (n, 3).
        faces: Triangles, indices into ``vertices``, shape (m, 3).
        target: Largest number of triangles of the result.

    Returns:
        A subset of the vertices, and the triangles on them.
    """
    if len(faces) <= target:
        return vertices, faces
    done = decimate_wedges(vertices, faces, None, target)
    return done.vertices, done.faces


def decimate_wedges(vertices: Points, faces: Faces, wedges: Faces | None, target: int) -> Decimated:
    """Reduce a mesh to a number of triangles, and keep the edges at which its wedges differ.

    A wedge is a range of corners at one vertex with the same attributes. The edges between wedges
    are creases, seams and borders of materials: they keep their shape as open borders do, and both
    sides are merged together. The vertices where three or more of them meet, or one ends, remain.

    Args:
        vertices: Points [m], each once, shape (n, 3).
        faces: Triangles, indices into ``vertices``, shape (m, 3).
        wedges: Wedge of each corner, shape (m, 3), a number that no other vertex has; None for
            none.
        target: Largest number of triangles of the result.
    """
    rows = np.arange(len(faces))
    if len(faces) <= target:
        return Decimated(vertices, faces, wedges, rows)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    original = find_used_vertices(faces, len(vertices))
    number = np.zeros(len(vertices), dtype=np.int32)
    number[original] = np.arange(len(original))
    points = (vertices[original] - (low + high) / 2) / max(float((high - low).max()), 1e-300)
    tie_breaks = np.random.default_rng(0).permutation(len(points))
    mesh = _Mesh(points, number[faces], wedges)
    quadrics = _sum_initial_quadrics(mesh)
    try_all = False
    while len(mesh.faces) > target:
        share = 1.0 if try_all else LARGE_SHARE if len(mesh.faces) > LARGE_MESH else CHEAPEST
        moved, onto = _select_merges(mesh, quadrics, tie_breaks, share, len(mesh.faces) - target)
        if wedges is not None:
            wedges, moved, onto = _merge_wedges(mesh, wedges, moved, onto)
        if not len(moved):
            if try_all:
                break
            try_all = True
            continue
        try_all = False
        np.add.at(quadrics, onto, quadrics[moved])
        number = np.arange(len(points), dtype=np.int32)
        number[moved] = onto
        a, b, c = number[mesh.faces].T
        remaining = (a != b) & (b != c) & (c != a)
        kept = number[mesh.faces][remaining]
        if not len(kept):
            break
        rows = rows[remaining]
        wedges = None if wedges is None else wedges[remaining]
        used = np.zeros(len(points), bool)
        used[kept] = True
        number = (np.cumsum(used) - 1).astype(np.int32)
        points, quadrics = points[used], quadrics[used]
        original, tie_breaks = original[used], tie_breaks[used]
        mesh = _Mesh(points, number[kept], wedges)
    return Decimated(vertices[original], mesh.faces.astype(np.int64), wedges, rows)


class _Mesh:
    """Triangles with the neighbors and faces of each vertex, as compressed rows.

    Attributes:
        points: Points, shape (n, 3).
        faces: Triangles, shape (m, 3).
        starts: First entry in ``ends`` of each vertex, shape (n + 1,).
        ends: Neighbors, vertex by vertex.
        is_open: Whether an odd number of faces share the edge to each neighbor, or it is between
            wedges.
        is_locked: Vertices that are not merged.
    """

    def __init__(self, points: Points, faces: _Array, wedges: _Array | None = None) -> None:
        from scipy.sparse import coo_matrix, csr_matrix

        self.points, self.faces = points, faces
        count, ones = len(points), np.ones(faces.size, np.int16)
        tail, head = faces.reshape(-1), faces[:, [1, 2, 0]].reshape(-1)
        walked = coo_matrix((ones, (tail, head)), shape=(count, count)).tocsr()
        edges = (walked + walked.T).tocsr()
        edges.sort_indices()
        self.starts, self.ends = edges.indptr, edges.indices
        self.is_open = edges.data % 2 == 1
        self.tails = np.repeat(np.arange(count, dtype=np.int32), np.diff(self.starts))
        rows = np.repeat(np.arange(len(faces), dtype=np.int32), 3)
        incident = coo_matrix((ones, (tail, rows)), shape=(count, len(faces))).tocsr()
        self._face_starts, self._faces_of = incident.indptr, incident.indices
        self.is_locked = np.zeros(count, bool)
        if wedges is not None:
            low, high = np.minimum(self.tails, self.ends), np.maximum(self.tails, self.ends)
            keys = low.astype(np.int64) * count + high
            self.is_open |= np.isin(keys, _find_seams(faces, wedges, count))
            self.is_locked = self._find_junctions(wedges)
        flags = (self.is_open.astype(np.int8), self.ends, self.starts)
        self.borders = csr_matrix(flags, shape=(count, count))

    def _find_junctions(self, wedges: _Array) -> npt.NDArray[np.bool_]:
        """Find the vertices where borders meet or end, or with a wedge that has no border."""
        borders = np.bincount(self.tails[self.is_open], minlength=len(self.points))
        _, first = np.unique(wedges.reshape(-1), return_index=True)
        fans = np.bincount(self.faces.reshape(-1)[first], minlength=len(self.points))
        simple = ((borders == 0) & (fans == 1)) | ((borders == 2) & (fans <= 2))
        return np.asarray(~simple)

    def list_faces_of(self, vertices: _Array) -> tuple[_Array, _Array]:
        """List the faces around vertices: the row in ``vertices`` and the face of each."""
        rows, at = _list_entries(self._face_starts, vertices)
        return rows, self._faces_of[at]

    def find_faces_around(self, vertices: _Array, onto: _Array) -> tuple[_Array, _Array, _Array]:
        """Find the faces around vertices.

        Returns:
            The row in ``vertices`` of each face, its corners, and whether ``onto`` is one of them.
        """
        rows, faces = self.list_faces_of(vertices)
        corners = self.faces[faces]
        return rows, corners, (corners == onto[rows][:, None]).any(axis=1)


def _find_seams(faces: _Array, wedges: _Array, count: int) -> _Array:
    """Find the edges at which wedges differ; return ``lower vertex * count + upper vertex``."""
    tail, head = faces.reshape(-1).astype(np.int64), faces[:, [1, 2, 0]].reshape(-1)
    at_tail, at_head = wedges.reshape(-1), wedges[:, [1, 2, 0]].reshape(-1)
    forward = tail < head
    keys = np.where(forward, tail * count + head, head * count + tail)
    order = np.argsort(keys, kind="stable")
    edges, starts = np.unique(keys[order], return_index=True)
    differs = np.zeros(len(edges), bool)
    for ends in (np.where(forward, at_tail, at_head), np.where(forward, at_head, at_tail)):
        ends = ends[order]
        differs |= np.minimum.reduceat(ends, starts) != np.maximum.reduceat(ends, starts)
    return np.asarray(edges[differs])


def _merge_wedges(
    mesh: _Mesh, wedges: _Array, moved: _Array, onto: _Array
) -> tuple[_Array, _Array, _Array]:
    """Give the corners of merged vertices the wedges of the vertices they are merged into.

    The faces with both vertices define which wedges correspond. A merge is dropped if a wedge has
    no such face.

    Returns:
        The wedges, and the merges that remain.
    """
    if not len(moved):
        return wedges, moved, onto
    rows, faces = mesh.list_faces_of(moved)
    corners, around = mesh.faces[faces], wedges[faces]
    own = around[corners == moved[rows][:, None]]
    target = corners == onto[rows][:, None]
    shared = target.any(axis=1)
    known = np.zeros(int(wedges.max()) + 1, bool)
    known[own[shared]] = True
    dropped = np.bincount(rows, ~known[own], len(moved)) > 0
    shared &= ~dropped[rows]
    number = np.arange(len(known))
    number[own[shared]] = around[shared][target[shared]]
    return number[wedges], moved[~dropped], onto[~dropped]


def _list_entries(starts: _Array, rows: _Array) -> tuple[_Array, _Array]:
    """List the entries of compressed rows: the index into ``rows`` and the position of each."""
    counts = starts[rows + 1] - starts[rows]
    owner = np.repeat(np.arange(len(rows)), counts)
    first = np.cumsum(counts) - counts
    return owner, np.arange(len(owner)) - first[owner] + starts[rows][owner]


def _compute_plane_quadrics(normals: _Floats, points: Points, weights: _Floats) -> _Floats:
    """Compute weighted quadrics of planes: xx yy zz xy yz zx xd yd zd dd, and the weight."""
    d = -np.einsum("ij,ij->i", normals, points)
    x, y, z = normals.T
    terms = (x * x, y * y, z * z, x * y, y * z, z * x, x * d, y * d, z * d, d * d, np.ones_like(d))
    return np.stack(terms, axis=1) * weights[:, None]


def _sum_initial_quadrics(mesh: _Mesh) -> _Floats:
    """Sum the quadrics of the faces at each vertex, and of walls along open borders."""
    points, faces = mesh.points, mesh.faces
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(areas, 1e-300)[:, None]
    total = np.zeros((len(points), 11))

    def add(at: _Array, quadrics: _Floats) -> None:
        for term in range(11):
            total[:, term] += np.bincount(at, quadrics[:, term], len(points))

    planes = _compute_plane_quadrics(normals, a, areas)
    for corner in range(3):
        add(faces[:, corner], planes)
    if mesh.is_open.any():
        tail, head = faces.reshape(-1), faces[:, [1, 2, 0]].reshape(-1)
        is_open = np.asarray(mesh.borders[tail, head]).reshape(-1) == 1
        tail, head, face = tail[is_open], head[is_open], np.flatnonzero(is_open) // 3
        along = points[head] - points[tail]
        lengths = np.linalg.norm(along, axis=1)
        walls = np.cross(along / np.maximum(lengths, 1e-300)[:, None], normals[face])
        planes = _compute_plane_quadrics(walls, points[tail], BORDER_WEIGHT * lengths**2)
        add(tail, planes)
        add(head, planes)
    return total


def _evaluate_costs(quadrics: _Floats, points: Points) -> _Floats:
    """Evaluate quadrics at points, divided by the root of their weights.

    Division by the full weight would give the mean squared distance, in which a small feature next
    to a large plane disappears. Without division, small triangles would be removed first, however
    far they protrude.
    """
    x, y, z = points.T
    xx, yy, zz, xy, yz, zx, xd, yd, zd, dd, weights = quadrics.T
    squares = xx * x * x + yy * y * y + zz * z * z
    products = xy * x * y + yz * y * z + zx * z * x + xd * x + yd * y + zd * z
    cost: _Floats = np.abs(squares + 2 * products + dd) / np.sqrt(np.maximum(weights, 1e-300))
    return cost


def _select_merges(
    mesh: _Mesh, quadrics: _Floats, tie_breaks: _Array, share: float, excess: int
) -> tuple[_Array, _Array]:
    """Choose vertices that can be merged into a neighbor at the same time, the cheapest first.

    Args:
        mesh: The triangles.
        quadrics: Of each vertex, shape (n, 11).
        tie_breaks: A permutation of the vertices, for those of equal cost.
        share: The share of the vertices to consider; 1 also tries every neighbor.
        excess: How many triangles too many there are.

    Returns:
        The vertices, no two of which are neighbors, and the neighbor each is merged into.
    """
    count, ends = len(mesh.points), mesh.ends
    costs = _evaluate_costs(quadrics[mesh.tails], mesh.points[ends])
    on_border = np.zeros(count, bool)
    on_border[mesh.tails[mesh.is_open]] = True
    costs[on_border[mesh.tails] & ~mesh.is_open] = np.inf  # borders keep their shape
    costs[mesh.is_locked[mesh.tails]] = np.inf
    least = np.minimum.reduceat(costs, mesh.starts[:-1])
    possible = np.isfinite(least)
    if not possible.any():
        return np.empty(0, np.int64), np.empty(0, np.int64)
    limit = float(np.quantile(least[possible], share)) if share < 1 else np.inf
    chosen = np.full(count, -1, np.int64)
    waiting = np.flatnonzero(possible & (least <= limit))
    for _ in range(ATTEMPTS if share < 1 else 50):
        edges, below = _find_cheapest_edges(mesh, costs, waiting, limit)
        waiting, edges = waiting[below], edges[below]
        if not len(waiting):
            break
        folds = _find_folding(mesh, waiting, ends[edges])
        chosen[waiting[~folds]] = edges[~folds]
        costs[edges[folds]] = np.inf
        waiting = waiting[folds]
        if not len(waiting):
            break
    movable = np.flatnonzero(chosen >= 0)
    rank = np.full(count, count, np.int64)
    order = np.lexsort((tie_breaks[movable], costs[chosen[movable]]))
    rank[movable[order]] = np.arange(len(movable))
    moved = _select_independent(mesh, rank)
    onto = ends[chosen[moved]]
    rows, _, shared = mesh.find_faces_around(moved, onto)
    removed = np.cumsum(np.bincount(rows, shared, len(moved)))
    enough = int(np.searchsorted(removed, excess)) + 1
    return moved[:enough], onto[:enough]


def _find_cheapest_edges(
    mesh: _Mesh, costs: _Floats, vertices: _Array, limit: float
) -> tuple[_Array, _Array]:
    """Find the cheapest edge of each vertex, and whether it costs at most the limit."""
    rows, at = _list_entries(mesh.starts, vertices)
    here = costs[at]
    counts = mesh.starts[vertices + 1] - mesh.starts[vertices]
    least = np.minimum.reduceat(here, np.cumsum(counts) - counts)
    hits = np.flatnonzero(here == least[rows])[::-1]
    edges = np.empty(len(vertices), np.int64)
    edges[rows[hits]] = at[hits]
    return edges, np.isfinite(least) & (least <= limit)


def _select_independent(mesh: _Mesh, rank: _Array) -> _Array:
    """Choose vertices of which no two are neighbors, by rank; ``len(rank)`` is not free."""
    count = len(rank)
    taken = np.zeros(count, bool)
    free = rank < count
    for _ in range(2):
        ranks = np.where(free, rank, count)
        beaten = np.zeros(count, bool)
        beaten[mesh.tails[ranks[mesh.tails] > ranks[mesh.ends]]] = True
        wins = free & ~beaten
        taken |= wins
        near = np.zeros(count, bool)
        near[mesh.ends[wins[mesh.tails]]] = True
        free &= ~wins & ~near
    found = np.flatnonzero(taken)
    return found[np.argsort(rank[found])]


def _find_folding(mesh: _Mesh, moved: _Array, onto: _Array) -> npt.NDArray[np.bool_]:
    """Find the merges that would fold the surface or leave a face without an area."""
    rows, corners, shared = mesh.find_faces_around(moved, onto)
    rows, corners = rows[~shared], corners[~shared]
    after = np.where(corners == moved[rows][:, None], onto[rows][:, None], corners)
    before, turned = (_compute_normals(mesh.points[faces]) for faces in (corners, after))
    cosine = np.einsum("ij,ij->i", before, turned)
    size = np.linalg.norm(before, axis=1) * np.linalg.norm(turned, axis=1)
    return np.bincount(rows, cosine <= LARGEST_TURN * size, len(moved)) > 0


def _compute_normals(triangles: Points) -> _Floats:
    normals: _Floats = np.cross(
        triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    )
    return normals
