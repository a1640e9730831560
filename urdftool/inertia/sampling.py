"""A solid known only by an inside test: its moments from evenly spread points.

The points are Roberts' additive recurrence on the generalised golden ratio of three dimensions
("The Unreasonable Effectiveness of Quasirandom Sequences", 2018). Unlike the cells of a voxel grid
they do not line up with the flat faces machined parts are made of, and any run of them is spread
as evenly, so that two halves give two independent results to compare.
"""

from __future__ import annotations

import numpy as np

from .crossings import crossing_numbers
from .polyhedron import Moments
from .tensor import Array
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
    corners: Array, samples: int = SAMPLES, *, closed: bool = False
) -> tuple[Moments, Moments] | None:
    """The moments of what a surface winds round, from each half of the samples.

    A point counts as inside where the winding number is above one half in size, so that a body
    that is inside out counts like any other, and space that two bodies share counts once.

    Args:
        corners: Triangles [m], shape (m, 3, 3).
        samples: Points in the bounding box.
        closed: Whether the surface has no border, which is much faster.

    Returns:
        None where hardly a point is inside.
    """
    boxes = None if closed else boxes_of(corners)
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    half = samples // 2
    results = []
    for start in (0, half):
        points = spread_points(half, low, high, start=start)
        if boxes is None:
            numbers = crossing_numbers(points, corners)
        else:
            numbers = winding_numbers(points, boxes)
        inside = points[np.abs(numbers) > 0.5]
        if len(inside) < 20:
            return None
        volume = float(np.prod(high - low)) * len(inside) / half
        centroid = inside.mean(axis=0)
        centred = inside - centroid
        results.append(Moments(volume, centroid, volume / len(inside) * centred.T @ centred))
    return results[0], results[1]
