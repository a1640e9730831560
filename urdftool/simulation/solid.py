"""Convex parts and their unions, and how much room two of them share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..model.pose import Pose
from .recording import Array
from .shapes import hull

STEPS = 13
"""Points along each edge of the box around a union, by which its volume is measured."""

_AT_ONCE = 32  # faces that points are tried by, before those outside are left out


@dataclass(frozen=True, eq=False)
class Solid:
    """A convex part, as the points x with ``normals @ x <= offsets``."""

    normals: Array
    offsets: Array
    corners: Array

    def holds(self, points: Array) -> Array:
        """Which points are in it, shape (n,)."""
        low, high = self.corners.min(axis=0) - 1e-9, self.corners.max(axis=0) + 1e-9
        left = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        for first in range(0, len(self.offsets), _AT_ONCE):
            some = slice(first, first + _AT_ONCE)
            beyond = points[left] @ self.normals[some].T > self.offsets[some] + 1e-9
            left = left[~beyond.any(axis=1)]
        inside = np.zeros(len(points), dtype=bool)
        inside[left] = True
        return inside

    def moved(self, pose: Pose) -> Solid:
        """The same in the frame in which ``pose`` is that of its present one."""
        turn, at = np.array(pose.rotation), np.array(pose.translation)
        normals = self.normals @ turn.T
        return Solid(normals, self.offsets + normals @ at, self.corners @ turn.T + at)


class Solids:
    """The union of some convex parts in one frame."""

    def __init__(self, solids: Iterable[Solid]) -> None:
        """Take the parts."""
        self.solids = list(solids)

    def __bool__(self) -> bool:
        """Whether there is any."""
        return bool(self.solids)

    def __or__(self, other: Solids) -> Solids:
        """Both."""
        return Solids([*self.solids, *other.solids])

    @property
    def volume(self) -> float:
        """Of the union [m³]."""
        points, each = self._points
        return len(points) * each

    def shared(self, other: Solids) -> float:
        """The volume that two unions share [m³], by the points of the smaller one."""
        some, more = sorted((self, other), key=lambda union: union.volume)
        points, each = some._points
        return float(more.holds(points).sum()) * each

    def holds(self, points: Array) -> Array:
        """Which points are in one of its parts, shape (n,)."""
        inside = np.zeros(len(points), dtype=bool)
        for solid in self.solids:
            inside |= solid.holds(points)
        return inside

    @cached_property
    def _points(self) -> tuple[Array, float]:
        """Points spread evenly in it, and the volume that each stands for [m³]."""
        if not self.solids:
            return np.zeros((0, 3)), 0.0
        corners = np.concatenate([solid.corners for solid in self.solids])
        low, high = corners.min(axis=0), corners.max(axis=0)
        steps = (np.arange(STEPS) + 0.5) / STEPS
        grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
        points = low + grid * (high - low)
        return points[self.holds(points)], float(np.prod((high - low) / STEPS))


def hulls(clouds: Iterable[Array]) -> list[Solid]:
    """The convex hulls of clouds of points, without those that are flat, which have no volume."""
    from scipy.spatial import ConvexHull, QhullError

    solids = []
    for points in clouds:
        try:
            found = ConvexHull(hull(points)[0])
        except (QhullError, ValueError):
            continue
        normals, offsets = found.equations[:, :3], -found.equations[:, 3]
        solids.append(Solid(normals, offsets, found.points[found.vertices]))
    return solids
