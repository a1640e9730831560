"""Largest distance of points to a surface, exact also where it is small.

``collision/distance.py`` measures to the triangles of the nearest samples, which is exact enough
for collision geometry of some percent, and not for visual geometry of some tenths of a percent.
"""

from __future__ import annotations

import numpy as np

from ..collision.distance import to_triangles
from ..geometry.mesh import Array, Faces, Points

_BATCH = 2048
"""Number of points that are compared in one step. Chosen, no source."""

_NEAREST = 2
"""Triangles of each size that give the first bound. Chosen, no source."""

_PAIRS = 200_000  # points with triangles that are measured at a time
_MOST_PAIRS = 2_000_000  # for one surface, about 1 s of processor time
_NEGLIGIBLE = 1e-5  # distance relative to the size that is not measured exactly


class ExactSurface:
    """Triangles, grouped by size, with a search structure for each group.

    Of triangles that are long and near each other, such as those of a polygon of 30,000 corners,
    each point has thousands to measure; after many the bound counts as the distance, which is
    larger.
    """

    def __init__(self, corners: Points) -> None:
        """Build the search structures of triangles [m], shape (m, 3, 3)."""
        from scipy.spatial import cKDTree

        self._corners = corners
        self._negligible = _NEGLIGIBLE * float(np.ptp(corners.reshape(-1, 3), axis=0).max())
        middles = (corners.min(axis=1) + corners.max(axis=1)) / 2
        radii = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
        octaves = np.ceil(np.log2(np.maximum(radii, 1e-12)) / 2).astype(np.int64)
        self._pairs = 0
        self._groups = []
        for octave in np.unique(octaves):
            rows = np.flatnonzero(octaves == octave)
            self._groups.append((float(radii[rows].max()), rows, cKDTree(middles[rows])))

    def find_largest_distance(self, points: Points, limit: float = np.inf) -> float:
        """Return the largest distance of points [m].

        Args:
            points: Points [m], shape (n, 3).
            limit: Distance [m] beyond which the result need not be the largest one.
        """
        bounds = self._bound(points)
        order = np.argsort(-bounds, kind="stable")
        largest = float(bounds.max(initial=0.0))
        if largest <= self._negligible:
            return largest
        largest = 0.0
        for first in range(0, len(order), _BATCH):
            batch = order[first : first + _BATCH]
            if bounds[batch[0]] <= max(largest, self._negligible) or largest > limit:
                break
            for part in self._split(points, bounds, batch):
                largest = max(largest, float(self._measure(points[part], bounds[part]).max()))
        return largest

    def _split(self, points: Points, bounds: Array, rows: Faces) -> list[Faces]:
        """Split points so that each part has few triangles near it."""
        pairs = sum(
            tree.query_ball_point(points[rows], bounds[rows] + radius, return_length=True)
            for radius, _, tree in self._groups
        )
        number = np.cumsum(pairs) // _PAIRS
        return np.split(rows, np.flatnonzero(np.diff(number)) + 1)

    def _bound(self, points: Points) -> Array:
        """Return upper bounds of the distances: those to triangles whose middles are nearest."""
        best: Array = np.full(len(points), np.inf)
        for _, rows, tree in self._groups:
            index = tree.query(points, k=min(_NEAREST, len(rows)))[1].reshape(len(points), -1)
            for column in index.T:
                exact = to_triangles(points, self._corners[rows[column]])
                np.minimum(best, exact, out=best)
        return best

    def _measure(self, points: Points, bounds: Array) -> Array:
        """Return the distance of each point [m], given an upper bound."""
        best: Array = bounds.copy()
        for radius, rows, tree in self._groups:
            if self._pairs > _MOST_PAIRS:
                break
            found = tree.query_ball_point(points, best + radius, return_sorted=False)
            counts = np.array([len(one) for one in found])
            if not counts.any():
                continue
            self._pairs += int(counts.sum())
            near: Faces = rows[np.concatenate([one for one in found if one]).astype(np.int64)]
            owners = np.repeat(np.arange(len(points)), counts)
            exact = to_triangles(points[owners], self._corners[near])
            np.minimum.at(best, owners, exact)
        return best
