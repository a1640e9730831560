"""Distance of two meshes, by points of each on the other."""

from __future__ import annotations

import numpy as np

from .mesh import Array

_SAMPLES = 64
"""Number of points of each mesh that are compared, if its triangles differ; chosen, no source."""


def measure_deviation(one: Array, two: Array, enough: float) -> float:
    """Return how far points of two meshes are from the other mesh [m].

    The points are the centers of triangles, of each mesh as many as of equal parts of its area. If
    both have the same triangles in the same order, all their corners are compared.

    Args:
        one: Corners of the triangles [m], shape (n, 3, 3).
        two: Corners of the triangles of the other mesh [m], shape (m, 3, 3).
        enough: Distance [m] from which the result need not be exact.
    """
    if one.shape == two.shape:
        distance = float(np.abs(one - two).max(initial=0.0))
        if distance <= enough:
            return distance
    return max(_measure_one_sided(one, two, enough), _measure_one_sided(two, one, enough))


_SCALE = 1e3
"""Factor of lengths given to trimesh, whose closest point has a tolerance of 1e-13 on products of
areas: in meters it is on an edge for triangles of less than 0.7 mm (measured).
"""


def _measure_one_sided(one: Array, two: Array, enough: float) -> float:
    from trimesh.triangles import closest_point

    edges = one[:, 1:] - one[:, :1]
    area = np.cumsum(np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1))
    parts = (np.arange(_SAMPLES) + 0.5) / _SAMPLES * area[-1]
    chosen = np.unique(np.minimum(np.searchsorted(area, parts), len(one) - 1))
    centers = two.mean(axis=1)
    radii = np.linalg.norm(two - centers[:, None], axis=2).max(axis=1)
    largest = 0.0
    for point in one[chosen].mean(axis=1):
        distances = np.linalg.norm(centers - point, axis=1)
        nearest = float(distances.min())
        if nearest > largest:
            near = two[distances - radii <= nearest]
            points = np.broadcast_to(point * _SCALE, (len(near), 3))
            on = closest_point(near * _SCALE, points)  # type: ignore[no-untyped-call,unused-ignore]
            found = float(np.linalg.norm(on - points, axis=1).min()) / _SCALE
            largest = max(largest, min(nearest, found))
        if largest > enough:
            break
    return largest
