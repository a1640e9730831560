"""Exterior of a surface: what a ball that comes from outside can touch.

Motors in a housing, ribs in a shell and the inner side of a thin wall never make contact. The space
around a surface is divided by a grid; the nodes at which a ball has room, and which are connected
to the border of the grid, are the exterior. The region that no such ball covers is the *closing* of
the surface: a solid, even if the surface is open or consists of many bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Points
from .distance import compute_areas, spread
from .vec3 import compute_bounds

BALL = 0.015
"""Radius of the ball, relative to the diagonal of the surface that a collision replaces. Chosen,
no source."""

COARSE, FINE = 0.0075, 0.005
"""Edge of a grid cell, relative to the same diagonal. Chosen, no source."""

# chosen, no source, where a line gives none
_SAMPLES_PER_CELL = 9  # per cell face of surface area
_MOST_SAMPLES = 3_000_000  # samples of a surface: 72 MB of coordinates
_REACHED = 0.75  # cells by which the grid underestimates how far the ball gets
_UNCERTAIN = 1.0  # cells: bound of the error of the distance transform
_REFINED = 2.0  # cells from the closing's boundary within which its distance matters

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Exterior:
    """A grid around a surface, flooded from its border.

    Attributes:
        low: First node [m].
        step: Distance of adjacent nodes [m].
        distance: Distance [m] of each node from the surface; exact near the flood's border.
        free: Nodes that the center of the ball reaches.
        depth: Signed distance [m] of each node from the closing; positive inside it.
    """

    low: Points
    step: float
    distance: npt.NDArray[np.float32]
    free: Mask
    depth: npt.NDArray[np.float32]

    def interpolate(self, field: npt.NDArray[np.float32], points: Points) -> Points:
        """Interpolate a field of the grid at points [m]."""
        from scipy import ndimage

        where = (points.T - self.low[:, None]) / self.step
        return np.asarray(
            ndimage.map_coordinates(field, where, order=1, mode="nearest", output=np.float64)
        )

    def is_touchable(self, points: Points) -> Mask:
        """Tell whether the ball can touch each point of the surface."""
        return np.asarray(self.interpolate(self.depth, points) <= _REACHED * self.step)

    @cached_property
    def beyond(self) -> npt.NDArray[np.float32]:
        """Return the distance [m] of each node outside the closing from the surface; else 0."""
        outside = np.maximum(-self.depth, 0)
        return np.where(self.depth < 0, np.maximum(self.distance, outside), 0).astype(np.float32)

    @property
    def volume(self) -> float:
        """Return the volume of the closing [m³]; cells of its boundary count in part."""
        parts = np.clip(0.5 + self.depth / self.step, 0, 1)
        return float(parts.sum(dtype=np.float64)) * self.step**3


def flood(corners: Points, size: float, cell: float = COARSE) -> Exterior:
    """Flood the space around a surface.

    Args:
        corners: Triangles [m], shape (m, 3, 3).
        size: Length [m] to which the ball and the cells are relative.
        cell: Edge of a cell, relative to ``size``.
    """
    from scipy import ndimage
    from scipy.spatial import cKDTree

    step, radius = cell * size, BALL * size
    lowest, highest = compute_bounds(corners.reshape(-1, 3))
    rim = int(np.ceil(BALL / cell)) + 3
    low = lowest - rim * step
    shape = np.ceil((highest - lowest) / step).astype(np.int64) + 2 * rim + 1
    samples = _sample_surface(corners, low, step)
    marked = np.ones(tuple(shape), dtype=bool)
    marked[tuple(np.rint((samples - low) / step).astype(np.int64).T)] = False
    distance = ndimage.distance_transform_edt(marked).astype(np.float32) * np.float32(step)
    near = np.abs(distance - radius) < _UNCERTAIN * step
    nodes = np.argwhere(near) * step + low
    exact, _ = cKDTree(samples).query(nodes, distance_upper_bound=radius + 2 * step)
    distance[near] = np.where(np.isfinite(exact), exact, distance[near])
    labels, _ = ndimage.label(distance >= radius)
    free = labels == labels[0, 0, 0]
    depth = _compute_closing_depth(distance / np.float32(step), free) * np.float32(step)
    return Exterior(low, step, distance, free, depth)


def _compute_closing_depth(
    distance: npt.NDArray[np.float32], free: Mask
) -> npt.NDArray[np.float32]:
    """Compute the signed distance of nodes from the union of empty balls, in cells.

    Each free node is the center of a ball, whose radius is its distance from the surface. The
    nearest free node and its neighbors stand for all of them.
    """
    from scipy import ndimage

    away, nearest = ndimage.distance_transform_edt(~free, return_indices=True)
    depth: npt.NDArray[np.float32] = away.astype(np.float32) - distance[tuple(nearest)]
    close = np.abs(depth) < _REFINED
    close &= ~free
    nodes = np.argwhere(close)
    center = nearest[:, close].T
    best = depth[close]
    for offset in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)):
        other = np.clip(center + offset, 0, np.array(free.shape) - 1)
        at = tuple(other.T)
        there = np.linalg.norm(nodes - other, axis=1).astype(np.float32) - distance[at]
        best = np.where(free[at], np.minimum(best, there), best)
    depth[close] = best
    return depth


def _sample_surface(corners: Points, low: Points, step: float) -> Points:
    """Sample a surface densely; at most one point in each half cell."""
    area = float(compute_areas(corners).sum())
    count = int(min(_MOST_SAMPLES, _SAMPLES_PER_CELL * area / step**2 + 20_000))
    points = np.concatenate([spread(corners, count).points, corners.reshape(-1, 3)])
    cells = np.floor((points - low) * (2 / step)).astype(np.int64)
    sizes = cells.max(axis=0) + 1
    _, first = np.unique(
        (cells[:, 0] * sizes[1] + cells[:, 1]) * sizes[2] + cells[:, 2], return_index=True
    )
    return points[first]
