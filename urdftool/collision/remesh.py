"""A closed surface around any mesh: the boundary of the solid that its exterior encloses.

Meshes of robots are open, have many bodies, or intersect themselves, but cuts require a solid.
Space is divided into cells; a corner of a cell is solid if it is near the mesh or unreachable from
outside. The boundary is extracted by marching tetrahedra, which leave no hole and no edge with more
than two faces (Doi and Koide 1991), and is then projected back toward the mesh.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Faces, Points
from ..inertia.winding import compute_winding_numbers, sort_into_boxes
from .convex import compute_planes, measure_plane_distance
from .distance import Surface, compute_areas, spread
from .vec3 import compute_bounds

CELLS = 96
"""Cells along the longest side of the bounding box; gaps narrower than two cells are closed.
Chosen, no source."""

# chosen, no source, where a line gives none
_WALL = 0.9  # cells: more than half a cell's diagonal, so that the layer has no gaps
_LEFT = 0.2  # cells of the layer that remain, so that a sheet keeps two sides
_MARKS = 9  # samples per cell face of surface area
_MOST_MARKS = 400_000  # samples of a surface: 10 MB of coordinates
_RIM = 3  # cells around the bounding box
_PART_CELLS = 24  # cells along the longest side of an intersected part
_FAR = 9.0  # cells: stands for any distance that is not near
_NEAR = 0.7  # cells: approximate smallest distance of such a corner

Numbers = npt.NDArray[np.int64]


class Layer:
    """Offset field: distance of grid corners from a thin layer around triangles.

    Attributes:
        low: First grid corner [m].
        side: Edge of a cell [m].
        surface: The triangles.
        field: Distance of each corner from the layer, in cells; negative in what it encloses.
    """

    def __init__(self, corners: Points, workers: int = 1) -> None:
        """Compute the field around triangles [m], shape (m, 3, 3), with ``workers`` threads."""
        lowest, highest = compute_bounds(corners.reshape(-1, 3))
        extent = highest - lowest
        self.side = float(extent.max()) / CELLS
        count = int(min(_MOST_MARKS, _MARKS * compute_areas(corners).sum() / self.side**2 + 20_000))
        shape = np.ceil(extent / self.side).astype(np.int64) + 2 * _RIM + 1
        self.low = lowest - _RIM * self.side
        self.surface = Surface(corners, spread(corners, count), workers=workers)
        self.field = _compute_field(self.surface, self.low, self.side, shape)


def compute_remesh(layer: Layer) -> tuple[Points, Faces]:
    """Compute the boundary of the solid that triangles and a thin layer around them enclose.

    Returns:
        Vertices [m] and triangles, wound outward; every edge has two triangles.
    """
    vertices, faces = _extract_boundary(layer.field)
    vertices = layer.low + vertices * layer.side
    # project back onto the mesh, except for a part of the layer
    surface = layer.surface
    ends = surface.corners.reshape(-1, 3)
    ends = np.concatenate([surface.samples.points, np.unique(ends, axis=0)])
    from scipy.spatial import cKDTree

    _, nearest = cKDTree(ends).query(vertices, workers=surface.workers)
    feet = ends[nearest]
    return feet + (vertices - feet) * (_LEFT / _WALL), faces


class Outside:
    """Distance of points outside a mesh, interpolated from a grid."""

    def __init__(self, layer: Layer) -> None:
        """Compute the grid from an offset field."""
        from scipy import ndimage

        self.low, self.side = layer.low, layer.side
        far = layer.field == _FAR
        away = ndimage.distance_transform_edt(far) + _NEAR
        self.values = np.maximum(np.where(far, away, layer.field + _WALL), 0.0) * self.side

    def measure_distance(self, points: Points) -> Points:
        """Return the distance [m] of points from the mesh; 0 for enclosed points."""
        from scipy import ndimage

        at = (points.T - self.low[:, None]) / self.side
        return np.asarray(ndimage.map_coordinates(self.values, at, order=1, mode="nearest"))


def intersect(solid: Points, vertices: Points, faces: Faces) -> tuple[Points, Faces] | None:
    """Compute the boundary of the intersection of a solid and a convex shape; None if empty.

    Args:
        solid: Triangles [m] of a closed surface, shape (m, 3, 3), wound outward.
        vertices: Points [m] of the convex shape.
        faces: Its triangles, wound outward.
    """
    extent = np.ptp(vertices, axis=0)
    side = float(extent.max()) / _PART_CELLS
    low = vertices.min(axis=0) - _RIM * side
    shape = np.ceil(extent / side).astype(np.int64) + 2 * _RIM + 1
    nodes = np.argwhere(np.ones(tuple(shape), dtype=bool)) * side + low
    field = measure_plane_distance(nodes, compute_planes(vertices, faces))
    near = np.flatnonzero(field < side)
    off = Surface(solid, spread(solid, 20_000)).measure_distance(nodes[near])
    inside = compute_winding_numbers(nodes[near], sort_into_boxes(solid)) > 0.5
    field[near] = np.maximum(field[near], np.where(inside, -off, off))
    field = np.where(np.abs(field) < 1e-6 * side, 1e-6 * side, field)
    if not (field < 0).any():
        return None
    points, triangles = _extract_boundary(field.reshape(tuple(shape)))
    return low + points * side, triangles


def _compute_field(surface: Surface, low: Points, side: float, shape: Numbers) -> Points:
    """Compute the distance of grid corners from the layer, in cells; negative in the solid."""
    from scipy import ndimage

    marked = np.zeros(tuple(shape), dtype=bool)
    for some in (surface.samples.points, surface.corners.reshape(-1, 3)):
        at = np.rint((some - low) / side).astype(np.int64)
        marked[at[:, 0], at[:, 1], at[:, 2]] = True
    near = widen(marked, 1)
    field = np.full(marked.shape, _FAR)
    field[near] = surface.measure_distance(np.argwhere(near) * side + low) / side - _WALL
    labels, _ = ndimage.label(field > 0)
    inner = (field > 0) & (labels != labels[0, 0, 0])
    field[inner] = -1.0
    return np.where(np.abs(field) < 1e-6, 1e-6, field)


def _extract_boundary(field: Points) -> tuple[Points, Faces]:
    """Extract the zero level of a field by marching tetrahedra, in cells."""
    solid = field < 0
    some = np.zeros(tuple(np.array(field.shape) - 1), dtype=np.int64)
    for x, y, z in np.ndindex(2, 2, 2):
        some += solid[x:, y:, z:][: some.shape[0], : some.shape[1], : some.shape[2]]
    cubes = np.argwhere((some > 0) & (some < 8))
    keys: list[Numbers] = []
    for order in permutations(range(3)):
        ends = [np.zeros(3, dtype=np.int64)]
        for axis in order:
            ends.append(ends[-1] + np.eye(3, dtype=np.int64)[axis])
        keys += _list_triangles(np.stack([cubes + end for end in ends], axis=1), solid)
    edges = np.concatenate(keys)
    # key of an edge: index of its first corner and offset of its second
    strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
    begin, end = edges[..., 0, :], edges[..., 1, :]
    number = (begin @ strides) * 8 + (end - begin) @ np.array([4, 2, 1])
    _, first, inverse = np.unique(number.reshape(-1), return_index=True, return_inverse=True)
    a, b = begin.reshape(-1, 3)[first], end.reshape(-1, 3)[first]
    at_a, at_b = field[tuple(a.T)], field[tuple(b.T)]
    share = np.clip(at_a / (at_a - at_b), 0.02, 0.98)
    return a + share[:, None] * (b - a), inverse.reshape(-1, 3).astype(np.int64)


def _list_triangles(tetrahedra: Numbers, solid: npt.NDArray[np.bool_]) -> list[Numbers]:
    """Return the edges that each triangle cuts, as three pairs of ends, shape (m, 3, 2, 3)."""
    inside = solid[tetrahedra[..., 0], tetrahedra[..., 1], tetrahedra[..., 2]]
    code = inside @ np.array([1, 2, 4, 8])
    triangles = []
    for case in range(1, 15):
        some = tetrahedra[code == case]
        if not len(some):
            continue
        within = [k for k in range(4) if case >> k & 1]
        without = [k for k in range(4) if k not in within]
        if len(within) == 2:
            (a, b), (c, d) = within, without
            ring = [(a, c), (a, d), (b, d), (b, c)]
            parts = [[ring[0], ring[1], ring[2]], [ring[0], ring[2], ring[3]]]
        else:
            parts = [[(i, o) for i in within for o in without]]
        for part in parts:
            pairs = [sorted(pair) for pair in part]
            cut = np.stack([some[:, pair] for pair in pairs], axis=1)
            middle = cut.mean(axis=2)
            normal = np.cross(middle[:, 1] - middle[:, 0], middle[:, 2] - middle[:, 0])
            out = some[:, without].mean(axis=1) - some[:, within].mean(axis=1)
            inwards = np.einsum("ij,ij->i", normal, out) < 0
            cut[inwards] = cut[inwards][:, ::-1]
            triangles.append(cut)
    return triangles


def widen(cells: npt.NDArray[np.bool_], by: int) -> npt.NDArray[np.bool_]:
    """Add all cells within ``by`` cells of one along each axis."""
    made: npt.NDArray[np.bool_] = cells.copy()
    for axis in range(3):
        before = made.copy()
        for step in range(1, by + 1):
            _spread_along(axis, before, made, step)
    return made


def _spread_along(
    axis: int, cells: npt.NDArray[np.bool_], made: npt.NDArray[np.bool_], step: int
) -> None:
    source, target = np.moveaxis(cells, axis, 0), np.moveaxis(made, axis, 0)
    target[step:] |= source[:-step]
    target[:-step] |= source[step:]
