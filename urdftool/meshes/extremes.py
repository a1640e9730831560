"""Of many points, those that reach furthest in some direction: what the hull needs of them."""

from __future__ import annotations

from functools import cache

import numpy as np

from .mesh import Points
from .outline import directions

_BLOCK = 2048  # small enough that a product with 32 directions stays on one core


def extreme_points(points: Points) -> Points:
    """Those points that reach furthest in some direction, all six along the axes among them.

    Args:
        points: Shape (n, 3); as few as twice the directions stay as they are.
    """
    if len(points) <= 2 * len(_directions()):
        return points
    points = np.ascontiguousarray(points)
    while len(points) > _BLOCK:
        blocks = [points[first : first + _BLOCK] for first in range(0, len(points), _BLOCK)]
        points = np.concatenate([_outermost(block) for block in blocks])
        if len(points) > 0.7 * sum(map(len, blocks)):
            break
    return _outermost(points) if len(points) <= _BLOCK else points


def _outermost(points: Points) -> Points:
    ways = _directions()
    centred = (points - points.mean(axis=0)).astype(np.float32)
    kept = np.zeros(len(points), dtype=bool)  # np.unique would import numpy.ma
    for first in range(0, len(ways), 32):
        kept[(centred @ ways[first : first + 32].T).argmax(axis=0)] = True
    return np.asarray(points[kept])


@cache
def _directions() -> Points:
    return np.array(directions(), dtype=np.float32)
