"""Joining of pieces whose common hull is close enough to the mesh.

Cuts go through the whole part and leave more pieces than necessary. The cost of a join is measured
as the final error is: the distance by which the hull protrudes from the mesh, and the depth to
which it covers exterior surface.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence

import numpy as np

from ..errors import MeshError
from ..geometry.mesh import Points
from .convex import compute_hull, measure_plane_distance
from .distance import spread
from .measure import ReferenceSurface
from .piece import Piece, find_overlapping_boxes, make_mesh_piece
from .remesh import Outside

_TOUCH = 0.01  # largest gap between neighbors, relative to the size
_PROBES = 300
_BURIED = 6000
_ENDS = 16  # vertices of a piece whose midpoints are tested
_SURE = 0.4  # part of a bound below which sampled hull points hardly ever stay
_GUESSED, _BULGE, _WHOLE = range(3)  # states of a join's known cost


class Joiner:
    """Joining of the pieces of one mesh."""

    def __init__(self, target: ReferenceSurface) -> None:
        """Set the mesh."""
        self.outside = Outside(target.layer)
        even = target.uniform_samples
        self.seen = even[:: max(1, len(even) // _BURIED)]
        self.gap = _TOUCH * target.size

    def join(self, pieces: Sequence[Piece], distance: float) -> list[Piece]:
        """Join pieces as long as no hull deviates by more than a distance [m]."""
        found = list(pieces)
        for cost, living in self.join_stepwise(pieces):
            if cost > distance:
                break
            found = living
        return found

    def join_stepwise(self, pieces: Sequence[Piece]) -> Iterator[tuple[float, list[Piece]]]:
        """Join pieces one by one, the cheapest first, until no neighbors are left.

        Yields:
            The deviation of the join's hull [m], and the pieces after it.
        """
        living = dict(enumerate(pieces))
        boxes = np.empty((2 * len(pieces), 2, 3))
        queue: list[tuple[float, int, int, int]] = []
        made: dict[tuple[int, int], Piece] = {}

        def offer(number: int) -> None:
            boxes[number] = living[number].bounds
            before = np.array([other for other in living if other < number], dtype=np.int64)
            near = before[find_overlapping_boxes(boxes[number], boxes[before], self.gap)].tolist()
            least = self._compute_lower_bounds([living[other] for other in near], living[number])
            for cost, other in zip(least, near, strict=True):
                heapq.heappush(queue, (cost, _GUESSED, other, number))

        for number in range(len(pieces)):
            offer(number)
        number = len(pieces)
        while queue:
            cost, known, a, b = heapq.heappop(queue)
            if a not in living or b not in living:
                made.pop((a, b), None)
                continue
            # hulls, and even more their depth, are costly and computed only for the cheapest
            # candidates
            if known == _GUESSED:
                both = self._compute_hull(living[a], living[b])
                if both is not None:
                    made[a, b] = both
                    heapq.heappush(queue, (self._measure_bulge(both), _BULGE, a, b))
                continue
            if known == _BULGE:
                heapq.heappush(queue, (max(cost, self.measure_burial(made[a, b])), _WHOLE, a, b))
                continue
            del living[a], living[b]
            living[number] = made.pop((a, b))
            offer(number)
            number += 1
            yield cost, list(living.values())

    def _compute_lower_bounds(self, ones: Sequence[Piece], other: Piece) -> list[float]:
        """Compute a lower bound of the protrusion [m] of the hull of each piece with another.

        The midpoint of two vertices of theirs is inside that hull.
        """
        if not ones:
            return []
        ends = _select_some(other.vertices)
        middles = [
            ((_select_some(one.vertices)[:, None] + ends) / 2).reshape(-1, 3) for one in ones
        ]
        starts = np.cumsum([0, *(len(points) for points in middles[:-1])])
        off = self.outside.measure_distance(np.concatenate(middles))
        least: list[float] = (_SURE * np.maximum.reduceat(off, starts)).tolist()
        return least

    @staticmethod
    def _compute_hull(one: Piece, other: Piece) -> Piece | None:
        try:
            return make_mesh_piece(*compute_hull(np.concatenate([one.vertices, other.vertices])))
        except MeshError:
            return None

    def _measure_bulge(self, piece: Piece) -> float:
        """Return the largest distance [m] by which the piece protrudes from the mesh."""
        return float(self.outside.measure_distance(spread(piece.corners, _PROBES).points).max())

    def measure_burial(self, piece: Piece) -> float:
        """Return the largest depth [m] of exterior points of the mesh inside the piece."""
        low, high = piece.bounds
        within: Points = self.seen[((self.seen > low) & (self.seen < high)).all(axis=1)]
        return -float(measure_plane_distance(within, piece.sides).min()) if len(within) else 0.0


def _select_some(points: Points) -> Points:
    return points[:: -(-len(points) // _ENDS)]
