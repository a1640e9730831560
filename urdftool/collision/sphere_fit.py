"""Fitting of a given number of spheres to a mesh, for motion planners.

The excess of a sphere is its radius minus the depth of its center below the surface. A point is in
the sphere that reaches it with the least excess; each center moves to where the points of its
sphere take the least. The two steps alternate, as in Lloyd's algorithm, so the largest excess never
grows; then the sphere that is needed least is tried in the middle of the worst one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Points
from .measure import ReferenceSurface
from .piece import Piece, make_primitive
from .spheres import measure_gap

Counts = npt.NDArray[np.intp]

# chosen, no source, where a line gives none
_POINTS = 3000  # samples by which centers are placed
_ROUNDS = 40  # of the two steps, at most
_MOVES = 3  # spheres moved to the worst place, relative to their number
_STEPS = 4  # halvings of the distance over which a better center is searched for
_GAIN = 1e-3  # relative improvement below which the steps end

_DIRECTIONS = np.array([[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)])


def fit_spheres(target: ReferenceSurface, count: int, *, cover: bool) -> list[Piece]:
    """Fit a number of spheres with the least error; return the spheres, the largest first.

    Args:
        target: The mesh.
        count: Number of spheres; fewer if that is enough.
        cover: Whether no point of the exterior may be outside of the spheres. Otherwise they
            protrude by half of what this takes, and leave out up to the other half.
    """
    dense, exterior = target.nearest.samples.points, target.exterior
    points: Points = dense[:: max(1, len(dense) // _POINTS)]
    fit = _Fit(points, lambda at: exterior.interpolate(exterior.depth, at))
    centers = fit.compute_centers(_spread_centers(points, count))
    gap = measure_gap(target)
    depths = _compute_depths(target, centers, gap)
    radii = _compute_radii(dense, centers, depths, gap)
    used = radii > 0
    centers, radii, depths = centers[used], radii[used], depths[used]
    if not cover:
        most = float((radii - depths).max())
        radii = np.maximum(np.minimum(radii, depths + most / 2), radii - most / 2)
    order = sorted(range(len(radii)), key=lambda i: (-radii[i], *centers[i].tolist()))
    return [make_primitive("sphere", (float(radii[i]),), np.eye(3), centers[i]) for i in order]


def _spread_centers(points: Points, count: int) -> Points:
    """Return the middle of points, and points that are far from those before, up to a count."""
    centers: Points = points.mean(axis=0)[None]
    while len(centers) < count:
        off = np.linalg.norm(points[:, None] - centers, axis=2).min(axis=1)
        centers = np.concatenate([centers, points[[int(np.argmax(off))]]])
    return centers


def _compute_depths(target: ReferenceSurface, centers: Points, gap: float) -> Points:
    """Compute the depths [m] of points below the exterior surface; negative outside of it."""
    off, _ = target.nearest.tree.query(centers, workers=target.cores)
    inside = target.exterior.interpolate(target.exterior.depth, centers) > 0
    # the nearest sample is farther than the surface, by the gap between samples at most
    depths: Points = np.where(inside, np.sqrt(np.maximum(off**2 - gap**2, 0)), -off)
    return depths


def _compute_radii(dense: Points, centers: Points, depths: Points, gap: float) -> Points:
    """Compute radii [m] with which spheres cover every dense sample; zero where none is needed."""
    best, owner = np.full(len(dense), np.inf), np.zeros(len(dense), dtype=np.intp)
    far = np.zeros(len(dense))
    for index, center in enumerate(centers):
        off = np.linalg.norm(dense - center, axis=1)
        nearer = off - depths[index] < best
        best[nearer], owner[nearer], far[nearer] = (off - depths[index])[nearer], index, off[nearer]
    radii: Points = np.zeros(len(centers))
    np.maximum.at(radii, owner, far + gap)
    return radii


class _Fit:
    """Samples of a mesh, and the depth of any point below its surface."""

    def __init__(self, points: Points, compute_depth: Callable[[Points], Points]) -> None:
        self.points = points
        self.compute_depth = compute_depth

    def compute_centers(self, centers: Points) -> Points:
        """Move centers until the largest excess no longer falls."""
        centers, excess = self._settle(centers)
        for _ in range(_MOVES * len(centers)):
            moved = self._move_to_worst(centers)
            if moved is None:
                break
            tried, least = self._settle(moved)
            if least > excess * (1 - _GAIN):
                break
            centers, excess = tried, least
        return centers

    def _settle(self, centers: Points) -> tuple[Points, float]:
        """Repeat both steps; return the centers and their largest excess [m]."""
        owner, excess = self._assign(centers)
        step = float(np.ptp(self.points, axis=0).max()) / 4
        for _ in range(_ROUNDS):
            tried = self._move_centers(centers, owner, step)
            owner, least = self._assign(tried)
            centers = tried
            if least > excess * (1 - _GAIN):
                step /= 2
                if step < 1e-3 * np.ptp(self.points, axis=0).max():
                    return centers, min(least, excess)
            excess = min(least, excess)
        return centers, excess

    def _assign(self, centers: Points) -> tuple[Counts, float]:
        """Return the sphere of each point, and the largest excess [m]."""
        off = self._measure(centers, self.points) - self.compute_depth(centers)[:, None]
        return np.argmin(off, axis=0), float(off.min(axis=0).max())

    def _move_centers(self, centers: Points, owner: Counts, step: float) -> Points:
        """Move each center to where its points take the least excess, by shrinking steps."""
        moved: Points = centers.copy()
        for index in range(len(centers)):
            own = self.points[owner == index]
            if not len(own):
                continue
            size = step
            for _ in range(_STEPS):
                tried = moved[index] + size * _DIRECTIONS
                excess = self._measure(tried, own).max(axis=1) - self.compute_depth(tried)
                best = int(np.argmin(excess))
                if excess[best] < excess[len(tried) // 2]:
                    moved[index] = tried[best]
                else:
                    size /= 2
        return moved

    def _move_to_worst(self, centers: Points) -> Points | None:
        """Return the centers with the one that is needed least at the worst covered point."""
        if len(centers) < 2:
            return None
        off = self._measure(centers, self.points) - self.compute_depth(centers)[:, None]
        worst = self.points[int(np.argmax(off.min(axis=0)))]
        cost = [float(np.delete(off, n, axis=0).min(axis=0).max()) for n in range(len(centers))]
        moved: Points = centers.copy()
        moved[int(np.argmin(cost))] = worst
        return moved

    @staticmethod
    def _measure(centers: Points, points: Points) -> Points:
        """Return the distances [m] of centers and points, shape (centers, points)."""
        squares = (centers**2).sum(axis=1)[:, None] + (points**2).sum(axis=1)
        return np.asarray(np.sqrt(np.maximum(squares - 2 * centers @ points.T, 0)))
