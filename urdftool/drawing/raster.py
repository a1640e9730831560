"""Rasterization: the nearest triangle at each sample, computed in whole arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
Owners = npt.NDArray[np.int32]
Nearness = npt.NDArray[np.float32]

NO_TRIANGLE = -1
"""Owner of a sample that no triangle covers."""

# sized for the processor's cache
_ROWS_AT_ONCE = 100_000
"""Rows of triangles filled at a time, which bounds memory."""

_SAMPLES_AT_ONCE = 250_000
"""Samples filled at a time, which bounds memory."""


class Samples(NamedTuple):
    """Samples that triangles cover, one row per pair of triangle and sample."""

    triangle: Indices
    """Row of the triangle."""
    sample: Indices
    """Index of the sample: column + row × width."""
    nearness: Nearness
    """Nearness, interpolated linearly between the corners."""


def find_front(corners: Floats, size: tuple[int, int]) -> tuple[Owners, Nearness]:
    """Find the nearest triangle at the center of each sample; of equally near ones the last.

    Args:
        corners: Column and row in samples, from the upper left corner, and nearness, which is above
            zero, larger when nearer, and linear on the picture; shape (m, 3, 3). Both sides of a
            triangle are visible.
        size: Columns and rows of samples.

    Returns:
        Rows of triangles, or ``NO_TRIANGLE``, and their nearness, or 0; each of shape
        (columns * rows,).
    """
    keys = np.zeros(size[0] * size[1], dtype=np.uint64)
    for found in list_covered(corners, size):
        # positive floats sort like their bits
        near = np.maximum(found.nearness, np.float32(0)).view(np.uint32).astype(np.uint64)
        key = (near << np.uint64(32)) | (found.triangle + 1).astype(np.uint64)
        np.maximum.at(keys, found.sample, key)
    owners = (keys & np.uint64(0xFFFFFFFF)).astype(np.int64) - 1
    return owners.astype(np.int32), (keys >> np.uint64(32)).astype(np.uint32).view(np.float32)


def list_covered(corners: Floats, size: tuple[int, int]) -> Iterator[Samples]:
    """Yield the samples that triangles cover, in blocks; arguments as :func:`find_front`."""
    width, height = size
    (ax, ay, _), (bx, by, _), (cx, cy, _) = np.ascontiguousarray(corners.transpose(1, 2, 0))
    left, right = np.minimum(np.minimum(ax, bx), cx), np.maximum(np.maximum(ax, bx), cx)
    top, bottom = np.minimum(np.minimum(ay, by), cy), np.maximum(np.maximum(ay, by), cy)
    low = np.clip(np.ceil(top - 0.5), 0, height)
    rows = np.clip(np.floor(bottom - 0.5), -1, height - 1) - low + 1
    # a triangle between two columns of sample centers covers none
    seen = (rows > 0) & (right > 0) & (left < width) & (np.ceil(left - 0.5) <= right - 0.5)
    used = np.flatnonzero(seen)
    counts = rows[used].astype(np.int64)
    ends = np.cumsum(counts)
    begin = 0
    while begin < len(used):
        done = ends[begin - 1] if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + _ROWS_AT_ONCE, side="right")))
        some = used[begin:stop]
        yield from _split_samples(some, corners[some], low[some], counts[begin:stop], width)
        begin = stop


def _split_samples(
    triangles: Indices, corners: Floats, low: Floats, rows: Indices, width: int
) -> Iterator[Samples]:
    """Split triangles into spans, one per row, and spans into samples."""
    a, b, c = np.ascontiguousarray(corners.transpose(1, 2, 0))
    ab, ac = b - a, c - a
    area = ab[0] * ac[1] - ab[1] * ac[0]
    rows = np.where(area == 0, 0, rows)
    safe = np.where(area == 0, 1.0, area)
    slope_x = (ab[2] * ac[1] - ac[2] * ab[1]) / safe
    slope_y = (ac[2] * ab[0] - ab[2] * ac[0]) / safe
    span = np.repeat(np.arange(len(rows)), rows)
    if not len(span):
        return
    line = low[span] + _enumerate_within(rows)
    y = line + 0.5
    begin, end = np.full(len(span), -np.inf), np.full(len(span), np.inf)
    for one, other in ((a, b), (b, c), (c, a)):
        dx, dy = other[0] - one[0], other[1] - one[1]
        # an edge bounds the span on the side given by its direction, unless it is horizontal
        side = np.where(area > 0, dy, -dy)
        ratio = dx / np.where(dy == 0, 1.0, dy)
        at = (one[0] - one[1] * ratio)[span] + y * ratio[span]
        sides = side[span]
        np.minimum(end, at, out=end, where=sides > 0)
        np.maximum(begin, at, out=begin, where=sides < 0)
    first = np.clip(np.ceil(begin - 0.5), 0, width).astype(np.int64)
    counts = np.clip(np.floor(end - 0.5), -1, width - 1).astype(np.int64) - first + 1
    filled = np.flatnonzero(counts > 0)
    span, y, first, counts = span[filled], y[filled], first[filled], counts[filled]
    start = a[2][span] + (y - a[1][span]) * slope_y[span] + (0.5 - a[0][span]) * slope_x[span]
    start += slope_x[span] * first
    slope, owner = slope_x[span], triangles[span]
    place = line[filled].astype(np.int64) * width + first
    ends = np.cumsum(counts)
    at_span = 0
    while at_span < len(counts):
        done = ends[at_span - 1] if at_span else 0
        stop = max(at_span + 1, int(np.searchsorted(ends, done + _SAMPLES_AT_ONCE, side="right")))
        some = slice(at_span, stop)
        which = np.repeat(np.arange(at_span, stop), counts[some])
        step = _enumerate_within(counts[some])
        nearness = start[which] + slope[which] * step
        yield Samples(owner[which], place[which] + step, nearness.astype(np.float32))
        at_span = stop


def _enumerate_within(counts: Indices) -> Indices:
    """Concatenate 0, 1, 2 … for each count."""
    ends = np.cumsum(counts)
    return np.asarray(np.arange(ends[-1] if len(ends) else 0) - np.repeat(ends - counts, counts))
