"""Contact of two surfaces of triangles: whether a triangle of one crosses a triangle of the other.

Both sets are halved along their longest side until few pairs are left, and only halves whose
bounding boxes meet are compared. Two triangles cross if an edge of one passes through the other;
triangles that only touch in one plane do not.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .mesh import Array

PAIRS = 20_000
"""Pairs of triangles that are compared in one step, which bounds the memory. Chosen, no source."""

MOST = 20_000_000
"""Pairs of triangles after which the answer is unknown, about 10 s of processor time. Chosen, no
source."""

_PARALLEL = 1e-14
"""Part of the product of the lengths below which an edge is parallel to a triangle. Chosen, no
source."""

_Mask = npt.NDArray[np.bool_]


def find_crossing(one: Array, other: Array, most: int = MOST) -> bool | None:
    """Find whether two surfaces cross; None if too many pairs would have to be compared.

    Args:
        one: Triangles [m], shape (n, 3, 3).
        other: Triangles in the same frame, shape (m, 3, 3).
        most: Largest number of pairs.
    """
    waiting = [(one, other)]
    compared = 0
    while waiting:
        first, second = _keep_near(*waiting.pop())
        count = len(first) * len(second)
        if count > PAIRS:
            waiting += _halve(first, second)
        elif count:
            compared += count
            if compared > most:
                return None
            if _find_any_crossing(first, second):
                return True
    return False


def _keep_near(one: Array, other: Array) -> tuple[Array, Array]:
    """Keep the triangles of each set whose bounding boxes meet that of the other set."""
    if len(one) and len(other):
        one = one[_find_near(one, other)]
    if len(one) and len(other):
        other = other[_find_near(other, one)]
    return one, other


def _find_near(triangles: Array, others: Array) -> _Mask:
    """Find the triangles whose bounding box meets that of all others."""
    low, high = others.min(axis=(0, 1)), others.max(axis=(0, 1))
    above = triangles.max(axis=1) >= low
    below = triangles.min(axis=1) <= high
    return np.asarray((above & below).all(axis=1))


def _halve(one: Array, other: Array) -> list[tuple[Array, Array]]:
    """Halve the larger of two sets along the longest side of its bounding box."""
    if len(one) < len(other):
        return [(one, half) for half in _split(other)]
    return [(half, other) for half in _split(one)]


def _split(triangles: Array) -> tuple[Array, Array]:
    middles = triangles.mean(axis=1)
    axis = int(np.ptp(middles, axis=0).argmax())
    order = np.argpartition(middles[:, axis], len(triangles) // 2)
    return triangles[order[: len(order) // 2]], triangles[order[len(order) // 2 :]]


def _find_any_crossing(one: Array, other: Array) -> bool:
    """Find whether any triangle of one set crosses any of the other."""
    near = np.ones((len(one), len(other)), dtype=bool)
    for axis in range(3):
        a, b = one[:, :, axis], other[:, :, axis]
        near &= a.max(axis=1)[:, None] >= b.min(axis=1)
        near &= a.min(axis=1)[:, None] <= b.max(axis=1)
    first, second = np.nonzero(near)
    return bool(
        _find_piercing(one[first], other[second]) or _find_piercing(other[second], one[first])
    )


def _find_piercing(edges: Array, triangles: Array) -> bool:
    """Find whether an edge of a triangle passes through the other triangle of its pair.

    The test is that of Möller and Trumbore (1997), with the edge as a bounded ray.
    """
    corner, u, v = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    u, v = u - corner, v - corner
    for number in range(3):
        start, along = edges[:, number], edges[:, (number + 1) % 3] - edges[:, number]
        cross = np.cross(along, v)
        size = (u * cross).sum(axis=1)
        lengths = (np.linalg.norm(one, axis=1) for one in (along, u, v))
        valid = np.abs(size) > _PARALLEL * np.prod(list(lengths), axis=0)
        scale = 1 / np.where(valid, size, 1.0)
        offset = start - corner
        turned = np.cross(offset, u)
        a = scale * (offset * cross).sum(axis=1)
        b = scale * (along * turned).sum(axis=1)
        t = scale * (v * turned).sum(axis=1)
        if (valid & (a >= 0) & (b >= 0) & (a + b <= 1) & (t >= 0) & (t <= 1)).any():
            return True
    return False
