"""Which triangle is in front at each sample: rows to spans to samples, in whole arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
Owners = npt.NDArray[np.int32]
Nearness = npt.NDArray[np.float32]

NOBODY = -1
"""Owner of a sample where nothing is."""

_ROWS_AT_ONCE = 400_000
_SAMPLES_AT_ONCE = 2_000_000


class Samples(NamedTuple):
    """Samples that triangles cover, a row for each pair of the two."""

    triangle: Indices
    """Row of the triangle."""
    sample: Indices
    """Column + row × width of the sample."""
    nearness: Nearness
    """As given for the corners, linear between them."""


def front(corners: Floats, size: tuple[int, int]) -> tuple[Owners, Nearness]:
    """The nearest triangle at the middle of each sample; of equally near ones the last.

    Args:
        corners: Columns and rows in samples, from the upper left corner, and nearness, which is
            above zero, larger where nearer, and linear on the picture; shape (m, 3, 3). Triangles
            are seen from both sides.
        size: Columns and rows of samples.

    Returns:
        Rows of triangles, ``NOBODY`` where there is none, and their nearness, 0 where there is
        none; each of shape (columns * rows,).
    """
    keys = np.zeros(size[0] * size[1], dtype=np.uint64)
    for found in covered(corners, size):
        # positive floats are in the order of their bits
        near = np.maximum(found.nearness, np.float32(0)).view(np.uint32).astype(np.uint64)
        key = (near << np.uint64(32)) | (found.triangle + 1).astype(np.uint64)
        np.maximum.at(keys, found.sample, key)
    owners = (keys & np.uint64(0xFFFFFFFF)).astype(np.int64) - 1
    return owners.astype(np.int32), (keys >> np.uint64(32)).astype(np.uint32).view(np.float32)


def covered(corners: Floats, size: tuple[int, int]) -> Iterator[Samples]:
    """The samples whose middle each triangle covers, some at a time; arguments as :func:`front`."""
    width, height = size
    low = np.clip(np.ceil(corners[:, :, 1].min(axis=1) - 0.5), 0, height)
    high = np.clip(np.floor(corners[:, :, 1].max(axis=1) - 0.5), -1, height - 1)
    left, right = corners[:, :, 0].min(axis=1), corners[:, :, 0].max(axis=1)
    rows = np.where((right > 0) & (left < width), np.maximum(high - low + 1, 0), 0)
    rows = np.where(_thin(left, right), 0, rows).astype(np.int64)
    used = np.flatnonzero(rows)
    ends = np.cumsum(rows[used])
    begin = 0
    while begin < len(used):
        done = ends[begin - 1] if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + _ROWS_AT_ONCE, side="right")))
        some = used[begin:stop]
        yield from _samples(some, corners[some], low[some].astype(np.int64), rows[some], width)
        begin = stop


def _thin(left: Floats, right: Floats) -> npt.NDArray[np.bool_]:
    """Triangles between the middles of two columns, which cover no sample."""
    return np.asarray(np.ceil(left - 0.5) > np.floor(right - 0.5))


def _samples(
    triangles: Indices, corners: Floats, low: Indices, rows: Indices, width: int
) -> Iterator[Samples]:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac = b - a, c - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    flat = area == 0
    safe = np.where(flat, 1.0, area)
    slope_x = (ab[:, 2] * ac[:, 1] - ac[:, 2] * ab[:, 1]) / safe
    slope_y = (ac[:, 2] * ab[:, 0] - ab[:, 2] * ac[:, 0]) / safe
    span = np.repeat(np.arange(len(rows)), np.where(flat, 0, rows))
    if not len(span):
        return
    rows = np.where(flat, 0, rows)
    y = low[span] + _within(rows) + 0.5
    begin = np.full(len(span), -np.inf)
    end = np.full(len(span), np.inf)
    turn = np.sign(area)
    for one, other in ((a, b), (b, c), (c, a)):
        dx, dy = (other - one)[:, 0] * turn, (other - one)[:, 1] * turn
        level = (dy == 0)[span]
        # inside is where dx (y - y0) - dy (x - x0) >= 0
        steep = np.where(dy == 0, 1.0, dy)
        at = one[span, 0] + (y - one[span, 1]) * (dx / steep)[span]
        upper = (dy > 0)[span]
        end = np.where(upper & ~level, np.minimum(end, at), end)
        begin = np.where(~upper & ~level, np.maximum(begin, at), begin)
    first = np.clip(np.ceil(begin - 0.5), 0, width).astype(np.int64)
    last = np.clip(np.floor(end - 0.5), -1, width - 1).astype(np.int64)
    counts = np.maximum(last - first + 1, 0)
    kept = np.flatnonzero(counts)
    span, y, first, counts = span[kept], y[kept], first[kept], counts[kept]
    line = (y - 0.5).astype(np.int64) * width
    start = a[span, 2] + (y - a[span, 1]) * slope_y[span] + (0.5 - a[span, 0]) * slope_x[span]
    slope, owner = slope_x[span], triangles[span]
    ends = np.cumsum(counts)
    at = 0
    while at < len(counts):
        done = ends[at - 1] if at else 0
        stop = max(at + 1, int(np.searchsorted(ends, done + _SAMPLES_AT_ONCE, side="right")))
        some = slice(at, stop)
        repeats = counts[some]
        column = np.repeat(first[some], repeats) + _within(repeats)
        nearness = np.repeat(start[some], repeats) + np.repeat(slope[some], repeats) * column
        yield Samples(
            np.repeat(owner[some], repeats),
            np.repeat(line[some], repeats) + column,
            nearness.astype(np.float32),
        )
        at = stop


def _within(counts: Indices) -> Indices:
    """0, 1, 2 … for each count, one after the other."""
    ends = np.cumsum(counts)
    return np.asarray(np.arange(ends[-1] if len(ends) else 0) - np.repeat(ends - counts, counts))
