"""Winding numbers of closed surfaces, from the triangles that a vertical ray crosses.

For a surface without a border this equals the generalized winding number of :mod:`.winding`. It is
exact and much faster, as only the triangles above and below a point matter. For an open surface it
would jump at holes.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Array

STRIPS = 160
"""Largest number of strips along y into which the points are sorted."""

_AT_ONCE = 500_000
"""Pairs of points and triangles per block, which bounds the memory. Chosen, no source."""

_Numbers = npt.NDArray[np.int64]


def compute_crossing_numbers(points: Array, corners: Array) -> Array:
    """Compute the winding number of a closed surface at each point, shape (n,).

    No ray may hit an edge to within rounding. Points chosen independently of the surface fulfill
    this.

    Args:
        points: Points [m], shape (n, 3).
        corners: Triangles [m], shape (m, 3, 3), counter-clockwise from outside.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    least, most = corners.min(axis=1), corners.max(axis=1)
    near = ((most >= low) & (least[:, :2] <= high[:2]).all(axis=1)[:, None]).all(axis=1)
    corners = corners[near]
    strips = min(STRIPS, max(1, int(1.3 * len(points) ** 0.5)))
    height = max(float(high[1] - low[1]) / strips, 1e-300)
    width = 1.001 * max(float(high[0] - low[0]), 1e-300)
    strip = np.minimum((points[:, 1] - low[1]) / height, strips - 1).astype(np.int64)
    key = strip * width + (points[:, 0] - low[0])
    order = np.argsort(key, kind="stable")
    key, points = key[order], points[order]
    numbers = np.zeros(len(points))
    x = corners[:, :, 0] - low[0]
    y = (corners[:, :, 1] - low[1]) / height
    for triangle, row in _list_strips(y, strips):
        left, right = _compute_span(x[triangle], y[triangle], row)
        slack = 1e-9 * width
        meets = (left <= width) & (right >= -slack)
        triangle, row = triangle[meets], row[meets]
        begin = np.searchsorted(key, row * width + np.maximum(left[meets], 0.0) - slack)
        end = np.searchsorted(key, row * width + np.minimum(right[meets], width) + slack)
        for some, point in _list_pairs(begin, end):
            signs = _get_passes_below(points[point], corners[triangle[some]])
            numbers += np.bincount(point, weights=signs, minlength=len(points))
    result = np.empty(len(points))
    result[order] = numbers
    return result


def _list_strips(y: Array, strips: int) -> Iterator[tuple[_Numbers, _Numbers]]:
    """Yield the pairs of a triangle and a strip it overlaps, in blocks."""
    lowest, highest = y.min(axis=1), y.max(axis=1)
    first = np.clip(np.floor(lowest), 0, strips - 1).astype(np.int64)
    last = np.clip(np.floor(highest), 0, strips - 1).astype(np.int64)
    counts = np.where((highest < 0) | (lowest > strips), 0, last - first + 1)
    yield from _list_ranges(first, counts)


def _list_pairs(begin: _Numbers, end: _Numbers) -> Iterator[tuple[_Numbers, _Numbers]]:
    """Yield the pairs of a range and an index in it, in blocks."""
    yield from _list_ranges(begin, np.maximum(end - begin, 0))


def _list_ranges(first: _Numbers, counts: _Numbers) -> Iterator[tuple[_Numbers, _Numbers]]:
    total = np.cumsum(counts)
    start = 0
    while start < len(counts):
        done = int(total[start - 1]) if start else 0
        stop = max(start + 1, int(np.searchsorted(total, done + _AT_ONCE, side="right")))
        some = counts[start:stop]
        which = np.repeat(np.arange(start, stop), some)
        before = np.repeat(np.cumsum(some) - some, some)
        yield which, first[which] + np.arange(len(which)) - before
        start = stop


def _compute_span(x: Array, y: Array, strip: _Numbers) -> tuple[Array, Array]:
    """Compute the interval along x that each triangle covers within its strip."""
    left, right = np.full(len(strip), np.inf), np.full(len(strip), -np.inf)
    for k in range(3):
        x0, x1, y0, y1 = x[:, k], x[:, k - 1], y[:, k], y[:, k - 1]
        level = y0 == y1
        rise = np.where(level, 1.0, y1 - y0)
        meets = (np.minimum(y0, y1) <= strip + 1) & (np.maximum(y0, y1) >= strip)
        for side in (0, 1):
            share = np.where(level, side, np.clip((strip + side - y0) / rise, 0.0, 1.0))
            at = x0 + share * (x1 - x0)
            left = np.where(meets, np.minimum(left, at), left)
            right = np.where(meets, np.maximum(right, at), right)
    return left, right


def _get_passes_below(points: Array, corners: Array) -> Array:
    """Return +1 if an upward ray leaves through the point's triangle, −1 if it enters, else 0."""
    a, b, c = (corners[:, k] - points for k in range(3))
    # twice the areas, projected along z, of the triangles of the point with each edge
    u = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
    v = c[:, 0] * a[:, 1] - c[:, 1] * a[:, 0]
    w = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    outward = (u > 0) & (v > 0) & (w > 0)
    inward = (u < 0) & (v < 0) & (w < 0)
    # height of the triangle above the point, times its projected area, which has the same sign
    height = u * a[:, 2] + v * b[:, 2] + w * c[:, 2]
    return np.where(outward & (height > 0), 1.0, 0.0) - np.where(inward & (height < 0), 1.0, 0.0)
