"""A solid known only by an inside test: its moments from evenly spread points.

The points are Roberts' additive recurrence on the generalised golden ratio of three dimensions
("The Unreasonable Effectiveness of Quasirandom Sequences", 2018). Unlike the cells of a voxel grid
they do not line up with the flat faces machined parts are made of, and any run of them is spread
as evenly, so that two halves give two independent results to compare.
"""

from __future__ import annotations

import numpy as np

from ..geometry.mesh import Array
from .crossings import crossing_numbers
from .polyhedron import Moments
from .winding import boxes_of, winding_numbers

SAMPLES = 30_000
"""Points in the bounding box, for both halves together."""

_GOLDEN = 1.2207440846057596  # the real root of x⁴ = x + 1


def spread_points(count: int, lower: Array, upper: Array, *, start: int = 0) -> Array:
    """``count`` evenly spread points [m] of a box, from number ``start`` of the sequence."""
    steps = _GOLDEN ** -np.arange(1.0, 4.0)
    numbers = np.arange(start + 1, start + count + 1, dtype=np.float64)
    return lower + (upper - lower) * ((0.5 + numbers[:, None] * steps) % 1.0)


def sampled_moments(
    corners: Array, samples: int = SAMPLES, *, caps: Array | None = None
) -> tuple[Moments, Moments] | None:
    """Compute the moments of the space that a surface winds round, from each half of the samples.

    A point counts as inside where the winding number is above one half in size, so that a body
    that is inside out counts like any other, and space that two bodies share counts once.

    Args:
        corners: Triangles [m], shape (m, 3, 3).
        samples: Points in the bounding box.
        caps: Triangles [m] that close the surface, shape (c, 3, 3); None for a closed one.

    Returns:
        None where hardly a point is inside.
    """
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    half = samples // 2
    results = []
    for start in (0, half):
        points = spread_points(half, low, high, start=start)
        numbers = winding_with_caps(points, corners, caps)
        inside = points[np.abs(numbers) > 0.5]
        if len(inside) < 20:
            return None
        volume = float(np.prod(high - low)) * len(inside) / half
        centroid = inside.mean(axis=0)
        centred = inside - centroid
        results.append(Moments(volume, centroid, volume / len(inside) * centred.T @ centred))
    return results[0], results[1]


def winding_with_caps(points: Array, corners: Array, caps: Array | None) -> Array:
    """Compute the winding number of a surface at each point, faster than triangle by triangle.

    The number of an open surface is that of the surface with its caps, which is a whole number that
    crossings count, less the solid angles of the caps alone.

    Args:
        points: Points [m], shape (n, 3).
        corners: Triangles [m], shape (m, 3, 3).
        caps: Triangles [m] that close the surface, shape (c, 3, 3); None for a closed one.
    """
    if caps is None or not len(caps):
        return crossing_numbers(points, corners)
    if len(caps) > len(corners):
        return winding_numbers(points, boxes_of(corners))
    whole = crossing_numbers(points, np.concatenate([corners, caps]))
    return np.asarray(whole - winding_numbers(points, boxes_of(caps)))
