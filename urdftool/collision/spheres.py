"""Cover of a mesh by few spheres.

A sphere around a point inside the closing reaches to the nearest exterior surface and farther by
the excess, so none protrudes by more than that. Spheres are chosen by greedy set cover, until every
dense sample of the exterior is inside one of them by more than the spacing of the samples.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.mesh import Points
from .distance import spread
from .measure import ReferenceSurface
from .piece import Piece, make_primitive

MOST = 400
"""Largest number of spheres if no limit is given. Chosen, no source."""

# chosen, no source, where a line gives none
_CANDIDATES = 4000  # centers that a cover is chosen from
_SAMPLES = 5000  # points that each candidate is tested with
_STEPS = 6  # of the bisection for the excess
_LARGEST = 0.5  # excess, relative to the size, that is always enough for some cover
_CHECKED = 60_000  # other points, by which the gaps of the dense samples are measured


def cover_with_spheres(
    target: ReferenceSurface, excess: float, most: int | None = None
) -> list[Piece]:
    """Cover the exterior of a mesh with spheres.

    ``excess`` is relative to the size, and larger if ``most`` spheres are not enough.

    Returns:
        The spheres, the largest first; few, but not provably the fewest.
    """
    search = _Cover(target)
    limit = most or MOST
    found = search.choose(excess * target.size, limit)
    low, high = excess, max(_LARGEST, 2 * excess)
    for _ in range(_STEPS if found is None else 0):
        middle = (low * high) ** 0.5
        tried = search.choose(middle * target.size, limit)
        if tried is None:
            low = middle
        else:
            high, found = middle, tried
    if found is None:  # one sphere around everything
        center = search.dense.mean(axis=0)
        radius = float(np.linalg.norm(search.dense - center, axis=1).max()) + search.gap
        found = [(center, radius)]
    found.sort(key=lambda sphere: (-sphere[1], *sphere[0].tolist()))
    return [make_primitive("sphere", (radius,), np.eye(3), center) for center, radius in found]


class _Cover:
    """Candidates and samples of one mesh."""

    def __init__(self, target: ReferenceSurface) -> None:
        self.dense = target.nearest.samples.points
        self.gap = measure_gap(target)
        self.some = self.dense[:: max(1, len(self.dense) // _SAMPLES)]
        exterior = target.exterior
        nodes = np.argwhere(exterior.depth > 0)
        nodes = nodes[:: max(1, len(nodes) // _CANDIDATES)]
        centers = np.concatenate([exterior.low + nodes * exterior.step, self.some[::10]])
        self.centers: Points = centers
        depth, _ = target.nearest.tree.query(centers, workers=target.cores)
        # the nearest sample is farther than the surface, by the gap between samples at most
        self.depth: Points = np.sqrt(np.maximum(depth**2 - self.gap**2, 0))

    def choose(self, excess: float, most: int) -> list[tuple[Points, float]] | None:
        """Choose spheres that protrude by at most an excess [m]; None if too many are needed."""
        radii = self.depth + excess
        if excess <= 2 * self.gap:
            return None
        points = self.some
        chosen: list[int] = []
        while True:
            if not self._extend(chosen, points, radii, most):
                return None
            left = self._find_uncovered(chosen, radii)
            if not len(left):
                return [(self.centers[index], float(radii[index])) for index in chosen]
            points = left[:: max(1, len(left) // _SAMPLES)]

    def _extend(self, chosen: list[int], points: Points, radii: Points, most: int) -> bool:
        """Choose more spheres until they cover the points; return whether they are few enough."""
        reach = np.maximum(radii - self.gap, 0)
        covers = _compute_squares(points, self.centers) <= reach**2
        counts = covers.sum(axis=0)
        is_open = np.ones(len(points), dtype=bool)
        while is_open.any():
            best = int(np.argmax(counts))
            if len(chosen) >= most or not counts[best]:
                return False
            chosen.append(best)
            newly = is_open & covers[:, best]
            counts -= covers[newly].sum(axis=0)
            is_open &= ~newly
        return True

    def _find_uncovered(self, chosen: Sequence[int], radii: Points) -> Points:
        left = self.dense
        for index in chosen:
            off = np.linalg.norm(left - self.centers[index], axis=1)
            left = left[off > radii[index] - self.gap]
        return left


def _compute_squares(points: Points, centers: Points) -> Points:
    """Compute the squares of distances [m²], shape (points, centers)."""
    middle = points.mean(axis=0)
    points, centers = points - middle, centers - middle
    squares = points @ (-2 * centers.T)
    squares += (centers**2).sum(axis=1)
    squares += (points**2).sum(axis=1)[:, None]
    return np.asarray(squares)


def measure_gap(target: ReferenceSurface) -> float:
    """Measure the largest distance [m] of exterior points from the dense samples."""
    points = spread(target.corners, _CHECKED).points
    points = points[target.exterior.is_touchable(points)]
    if not len(points):
        return 0.0
    return float(target.nearest.tree.query(points)[0].max())
