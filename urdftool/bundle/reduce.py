"""Reduction of visual meshes: fewer triangles, with creases, seams and materials kept."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..collision.decimate import Decimated, decimate_wedges
from ..collision.distance import spread
from ..drawing.normals import CREASE, compute_corner_normals
from ..geometry.mesh import Array, Faces, Mesh, Points
from ..geometry.topology import find_collapsed, label_components, weld_on_grids
from .limits import Limits
from .surface_distance import ExactSurface

SAMPLES = 5000
"""Points of each surface whose distance to the other is measured."""

STEPS = (0.5, 0.8)
"""Triangles of a result relative to those of the one before, if the error decides. Chosen, no
source.
"""

FEWEST = 12
"""Triangles below which the error decides nothing, as a box has 12."""


LARGEST_ERROR = 0.05
"""Largest error if none is set: some meshes do not resemble any reduction to few triangles. Chosen,
no source.
"""


@dataclass(frozen=True, eq=False)
class Reduced:
    """A mesh with fewer triangles.

    Attributes:
        mesh: The mesh.
        normals: Unit normal at each corner of each face, shape (m, 3, 3), as in the source.
        triangles: Number of triangles of the source.
        error: Distance between the two surfaces, as a fraction of the diagonal of the bounding box
            of the source.
    """

    mesh: Mesh
    normals: Array
    triangles: int
    error: float


def reduce_mesh(mesh: Mesh, limits: Limits) -> Reduced | None:
    """Reduce the triangles of a mesh; return None if no triangle can be removed within the limits.

    Vertices are merged and not moved. Sharp edges, open borders, borders of materials and seams of
    texture coordinates keep their shape. The error has precedence over the number of triangles.
    """
    count = limits.max_triangles
    if count is not None and len(mesh.faces) <= count:
        return None
    points, faces, _ = weld_on_grids(mesh.vertices, mesh.faces)
    rows = np.flatnonzero(~find_collapsed(faces))
    if len(rows) < FEWEST:
        return None
    source = _Source(mesh, rows, points, faces[rows])
    start = source.divide()
    gauge = _Gauge(points[faces[rows]])
    best, error = start, np.inf
    if count is not None:
        best = _decimate(start, count)
        error = gauge.measure(best)
    farthest = LARGEST_ERROR if limits.max_error is None else limits.max_error
    if error > farthest:
        best, error = _decimate_to_error(start, gauge, count or FEWEST, farthest)
    if len(best.faces) >= len(mesh.faces):
        return None
    return source.assemble(start, best, error)


def _decimate(state: Decimated, target: int) -> Decimated:
    """Decimate a mesh that was decimated before."""
    done = decimate_wedges(state.vertices, state.faces, state.wedges, target)
    return replace(done, rows=state.rows[done.rows])


def _decimate_to_error(
    state: Decimated, gauge: _Gauge, count: int, limit: float
) -> tuple[Decimated, float]:
    """Decimate a mesh until the error would exceed a limit; return it with its error."""
    best, error = state, 0.0
    for step in STEPS:
        while len(best.faces) > count:
            tried = _decimate(best, max(count, int(step * len(best.faces))))
            off = gauge.measure(tried, limit)
            if off > limit or len(tried.faces) == len(best.faces):
                break
            best, error = tried, off
    return best, error


class _Gauge:
    """Distance of reduced meshes to their source."""

    def __init__(self, corners: Points) -> None:
        self.size = float(np.linalg.norm(np.ptp(corners.reshape(-1, 3), axis=0))) or 1.0
        self._points = _sample(corners)
        self._surface = ExactSurface(corners)

    def measure(self, state: Decimated, limit: float = np.inf) -> float:
        """Return the larger one of the distances in both directions, relative to the size.

        Args:
            state: The reduced mesh.
            limit: Value beyond which the result need not be exact.
        """
        corners = state.vertices[state.faces]
        farthest = limit * self.size
        error = ExactSurface(corners).find_largest_distance(self._points, farthest)
        if error <= farthest:
            points = _sample(corners)
            error = max(error, self._surface.find_largest_distance(points, farthest))
        return error / self.size


def _sample(corners: Points) -> Points:
    """Return points of a surface: evenly spread, and corners and middles of triangles."""
    some = corners[:: max(1, 3 * len(corners) // SAMPLES)]
    return np.concatenate([spread(corners, SAMPLES).points, some.mean(axis=1), some[:, 0]])


class _Source:
    """A mesh on distinct points, with the attributes of its corners."""

    def __init__(self, mesh: Mesh, rows: Faces, points: Points, faces: Faces) -> None:
        """Store the mesh.

        Args:
            mesh: The mesh.
            rows: Its faces that ``faces`` are.
            points: Points [m], each once.
            faces: Triangles on them.
        """
        self._mesh, self._rows = mesh, rows
        self._points, self._faces = points, faces

    def divide(self) -> Decimated:
        """Return the mesh with a wedge for each corner; sharp edges and seams divide wedges."""
        faces, mesh = self._faces, self._mesh
        part = np.zeros(len(mesh.faces), np.int64)
        uv = np.zeros((len(mesh.faces), 3, 2))
        for number, one in enumerate(mesh.parts):
            part[one.first : one.first + one.count] = number
            if one.uv is not None:
                uv[one.first : one.first + one.count] = one.uv
        part, texels = part[self._rows], np.round(uv[self._rows], 6).reshape(-1, 2)
        half, twin = _pair_halves(faces)
        after, after_twin = (one - one % 3 + (one + 1) % 3 for one in (half, twin))
        joined = part[half // 3] == part[twin // 3]
        joined &= (texels[half] == texels[after_twin]).all(axis=1)
        joined &= (texels[after] == texels[twin]).all(axis=1)
        normals = _compute_normals(self._points[faces])
        joined &= np.einsum("ij,ij->i", normals[half // 3], normals[twin // 3]) > CREASE
        first = np.concatenate([half[joined], after[joined]])
        second = np.concatenate([after_twin[joined], twin[joined]])
        wedges = label_components(faces.size, first, second).reshape(-1, 3)
        return Decimated(self._points, faces, wedges, np.arange(len(faces)))

    def assemble(self, start: Decimated, best: Decimated, error: float) -> Reduced:
        """Return a mesh of the remaining faces, with the attributes of their wedges."""
        assert start.wedges is not None
        assert best.wedges is not None
        mesh, rows = self._mesh, self._rows
        corner = np.zeros(int(start.wedges.max()) + 1, np.int64)
        corner[start.wedges.reshape(-1)] = np.arange(start.wedges.size)
        taken = corner[best.wedges]  # the corner of the source that each corner is like
        sources = rows[best.rows]
        parts, first = [], 0
        for part in mesh.parts:
            inside = (sources >= part.first) & (sources < part.first + part.count)
            count = int(np.count_nonzero(inside))
            if count:
                at = taken[inside]
                uv = None if part.uv is None else part.uv[rows[at // 3] - part.first, at % 3]
                parts.append(replace(part, first=first, count=count, uv=uv))
                first += count
        normals = compute_corner_normals(self._points, self._faces).reshape(-1, 3)[taken]
        reduced = replace(mesh, vertices=best.vertices, faces=best.faces, parts=tuple(parts))
        return Reduced(reduced, normals, len(mesh.faces), error)


def _compute_normals(corners: Points) -> Array:
    """Compute the unit normals of triangles; those without area have a zero one."""
    a, b, c = corners.swapaxes(0, 1)
    normals: Array = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    return normals


def _pair_halves(faces: Faces) -> tuple[Faces, Faces]:
    """Return the half-edges of edges with two faces of opposite winding, in pairs.

    A half-edge has the number of the corner at which it begins.
    """
    tail, head = faces.reshape(-1), faces[:, [1, 2, 0]].reshape(-1)
    count = int(faces.max()) + 1
    keys = np.minimum(tail, head) * count + np.maximum(tail, head)
    order = np.argsort(keys, kind="stable")
    _, starts, sizes = np.unique(keys[order], return_index=True, return_counts=True)
    starts = starts[sizes == 2]
    half, twin = order[starts], order[starts + 1]
    opposite = tail[half] == head[twin]
    return half[opposite], twin[opposite]
