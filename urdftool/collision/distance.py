"""Distances between surfaces, from evenly spread points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Points
from .vec3 import compute_lengths, compute_normals

# chosen, no source, where a line gives none
_GOLDEN = 1.324717957244746  # real root of x³ = x + 1
_NEIGHBOURS = 6  # nearest samples, whose triangles are tested
_FEW = 24  # up to this number all triangles are tested
_COARSE = 1000  # triangles below which more neighbors are tested
_REFINED = 6000  # points of which the distance is measured exactly for the largest one
_COVERED = 2.0  # spacings from every point of the covered part to its nearest sample
_KEPT = 100_000  # largest sample whose positions are cached
_BOUNDED = 2000  # points up to which each one is queried
_CELLS = (16, 64)  # grid cells along the longest side, by which others are selected
_AT_ONCE = 8192  # point-triangle pairs per block, to fit the processor's cache


@dataclass(frozen=True, eq=False)
class Samples:
    """Points on a surface, with the index of the triangle of each."""

    points: Points
    owners: npt.NDArray[np.int64]

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self.points)

    def select(self, mask: npt.NDArray[np.bool_]) -> Samples:
        """Return the points selected by a mask."""
        return Samples(self.points[mask], self.owners[mask])


def add_corners(samples: Samples, corners: Points) -> Samples:
    """Add the corners of triangles [m], shape (m, 3, 3), to samples."""
    owners = np.repeat(np.arange(len(corners)), 3)
    return Samples(
        np.concatenate([samples.points, corners.reshape(-1, 3)]),
        np.concatenate([samples.owners, owners]),
    )


def compute_areas(corners: Points) -> Points:
    """Compute the area [m²] of each triangle."""
    return compute_lengths(compute_normals(corners)) / 2


def spread(corners: Points, count: int) -> Samples:
    """Sample points of a surface evenly by area, deterministically.

    Points are at equal steps of accumulated area; the position within a triangle is Roberts'
    additive recurrence in two dimensions, folded into the triangle.

    Args:
        corners: Triangles [m], shape (m, 3, 3).
        count: Number of points.
    """
    ends = np.cumsum(compute_areas(corners))
    if not len(ends) or ends[-1] <= 0:
        return Samples(corners[:, 0].copy(), np.arange(len(corners)))
    shares, u, v = _compute_places(count) if count <= _KEPT else _compute_places.__wrapped__(count)
    owners = np.minimum(np.searchsorted(ends, shares * ends[-1]), len(ends) - 1)
    points = np.empty((count, 3))
    triangles = corners.reshape(-1, 9).take(owners, axis=0)
    for axis in range(3):
        a, b, c = triangles[:, axis], triangles[:, axis + 3], triangles[:, axis + 6]
        points[:, axis] = a + u * (b - a) + v * (c - a)
    return Samples(points, owners)


@lru_cache(maxsize=32)
def _compute_places(count: int) -> tuple[Points, Points, Points]:
    """Return each point's share of the accumulated area and its coordinates in a triangle."""
    numbers = np.arange(1, count + 1, dtype=np.float64)
    u, v = 0.5 + numbers / _GOLDEN, 0.5 + numbers / _GOLDEN**2
    u -= np.floor(u)
    v -= np.floor(v)
    over = u + v > 1
    shares = (np.arange(count) + 0.5) / count
    return shares, np.where(over, 1 - u, u), np.where(over, 1 - v, v)


class Surface:
    """Triangles with a search structure for distance queries."""

    def __init__(
        self, corners: Points, samples: Samples, *, workers: int = 1, step: float | None = None
    ) -> None:
        """Build a tree of points on the triangles.

        Args:
            corners: Triangles [m], shape (m, 3, 3).
            samples: Points on them, on average closer to each other than any relevant distance.
            workers: Number of threads for queries.
            step: If the samples cover only a part of the triangles, their mean spacing [m] there;
                parts of triangles that are farther from all samples are not considered.
        """
        from scipy.spatial import cKDTree

        self.corners = corners
        self.step = step
        self.samples = samples
        self.workers = workers
        self.tree = cKDTree(samples.points)

    def measure_distance(self, points: Points) -> Points:
        """Compute the distance of points to the nearest triangle [m].

        It is exact for the triangles of the samples nearest to a point, and never too small.
        """
        if not len(points):
            return np.zeros(0)
        if len(self.corners) <= _FEW and self.step is None:
            return np.asarray(
                np.min([to_triangles(points, one[None]) for one in self.corners], axis=0)
            )
        most = _NEIGHBOURS * (2 if len(self.corners) < _COARSE else 1)
        near = min(most, len(self.samples))
        found, index = self.tree.query(points, k=near, workers=self.workers)
        if near == 1:
            found, index = found[:, None], index[:, None]
        index = np.minimum(index, len(self.samples) - 1)  # out of range: none is finite
        owners = self.samples.owners[index]
        result = np.empty(len(points))
        step = max(1, _AT_ONCE // near)
        for begin in range(0, len(points), step):
            some = slice(begin, begin + step)
            pairs = np.repeat(points[some], near, axis=0)
            exact = to_triangles(pairs, self.corners[owners[some].reshape(-1)])
            result[some] = exact.reshape(-1, near).min(axis=1)
        if self.step is not None:
            gap = _COVERED * self.step
            result = np.maximum(result, np.sqrt(np.maximum(found[:, 0] ** 2 - gap**2, 0)))
        return np.asarray(np.minimum(result, found[:, 0]))


def find_farthest(surface: Surface, points: Points, count: int = 1) -> tuple[float, Points, Points]:
    """Find the points that are farthest from a surface.

    The distance to the nearest sample is an upper bound, so only few points are measured exactly.

    Returns:
        The largest distance [m]; about ``count`` points with large distances, and those.
    """
    if not len(points):
        return 0.0, points, np.zeros(0)
    some, limit = _select_candidates(surface, points, count)
    best, found, distances = _measure_farthest(surface, points[some], count)
    if len(some) < len(points) and limit > best:  # a point that was left out may be farther
        some, _ = _select_candidates(surface, points, count, best)
        best, found, distances = _measure_farthest(surface, points[some], count)
    return best, found, distances


def _measure_farthest(surface: Surface, points: Points, count: int) -> tuple[float, Points, Points]:
    bounds, _ = surface.tree.query(points, eps=0.02, workers=surface.workers)
    order = np.argsort(-bounds, kind="stable")
    best = 0.0
    chosen: list[Points] = []
    begin, step = 0, max(count, 32)
    last = min(len(order), _REFINED)  # of the others, the samples' spacing decides
    while begin < last and (not begin or bounds[order[begin]] > best):
        chosen.append(surface.measure_distance(points[order[begin : begin + step]]))
        best = max(best, float(chosen[-1].max()))
        begin, step = begin + step, 4 * step
    found = np.concatenate(chosen)
    first = np.argsort(-found, kind="stable")[:count]
    return best, points[order[first]], found[first]


def _select_candidates(
    surface: Surface, points: Points, count: int, limit: float = 0.0
) -> tuple[npt.NDArray[np.int64], float]:
    """Select the points that may be among those farthest from all samples.

    One point of each grid cell bounds the distance of the others. Queries are slow where all
    samples are about equally far, as in the middle of a bowl.

    Args:
        surface: The surface.
        points: Points [m].
        count: Number of farthest points.
        limit: Distance [m] below which points are not wanted; 0 for that of the ``count`` farthest.

    Returns:
        Their indices, and a distance [m] that all other points do not exceed.
    """
    some = np.arange(len(points))
    fixed = limit > 0
    for cells in _CELLS:
        if len(some) <= _BOUNDED:
            break
        first, owner = _group(points[some], cells)
        away, _ = surface.tree.query(points[some[first]], eps=0.02, workers=surface.workers)
        bounds = away[owner] + np.linalg.norm(points[some] - points[some[first]][owner], axis=1)
        if not fixed and count <= len(away):
            ranked = np.partition(away, len(away) - count)
            limit = max(limit, float(ranked[len(away) - count]) / 1.02)  # as eps permits
        some = some[bounds >= limit]
    return some, limit


def _group(points: Points, cells: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Group points by the cells of a grid; return the first of each group, and their groups."""
    low = points.min(axis=0)
    width = float(np.ptp(points, axis=0).max()) / cells or 1.0
    places = ((points - low) / width).astype(np.int64) @ (cells + 1) ** np.arange(3)
    _, first, owner = np.unique(places, return_index=True, return_inverse=True)
    return first, owner


def to_triangles(points: Points, corners: Points) -> Points:
    """Compute the distance [m] of point i to triangle i.

    The nearest point is within the triangle or on one of its three edges (Ericson, "Real-Time
    Collision Detection", 5.1.5).

    Args:
        points: Points [m], shape (n, 3).
        corners: Triangles [m], shape (n, 3, 3).
    """
    point = _make_columns(points)
    a, b, c = (_make_columns(corners[:, corner]) for corner in range(3))
    to_b, to_c, to_point = b - a, c - a, point - a
    normal = _compute_cross(to_b, to_c)
    square = _compute_dot(normal, normal)
    safe = np.where(square > 0, square, 1.0)
    # barycentric coordinates of the projection onto the plane
    v = _compute_dot(_compute_cross(to_point, to_c), normal) / safe
    w = _compute_dot(_compute_cross(to_b, to_point), normal) / safe
    inside = (v >= 0) & (w >= 0) & (v + w <= 1) & (square > 0)
    height = np.abs(_compute_dot(to_point, normal)) / np.sqrt(safe)
    edges = np.minimum(
        np.minimum(_to_segments(to_point, to_b), _to_segments(point - b, c - b)),
        _to_segments(point - c, a - c),
    )
    return np.where(inside, height, np.sqrt(edges))


def _to_segments(to_point: Points, along: Points) -> Points:
    """Compute squared distances [m²] of points, relative to segment starts, to segments."""
    square = _compute_dot(along, along)
    share = _compute_dot(to_point, along) / np.where(square > 0, square, 1.0)
    foot = to_point - np.clip(share, 0, 1) * along
    return _compute_dot(foot, foot)


def _make_columns(rows: Points) -> Points:
    return np.ascontiguousarray(rows.T)


def _compute_cross(one: Points, other: Points) -> Points:
    (ax, ay, az), (bx, by, bz) = one, other
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _compute_dot(one: Points, other: Points) -> Points:
    x, y, z = one * other
    return np.asarray((x + z) + y)
