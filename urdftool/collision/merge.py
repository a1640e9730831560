"""Pieces joined again where their common hull is near enough to the mesh.

Cuts go through the whole of a part, and leave more pieces than its shape needs. What a join costs
is measured here by what counts in the end: how far the hull bulges out of the mesh, and how deep it
buries what of the mesh can be touched.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from ..errors import MeshError
from ..meshes.mesh import Points
from .convex import hull, signed_distance
from .distance import spread
from .measure import Target
from .piece import Piece, mesh_piece
from .remesh import Outside

_TOUCH = 0.01  # gap of neighbours, relative to the size
_PROBES = 300
_BURIED = 6000


class Joiner:
    """Joins pieces of one mesh."""

    def __init__(self, target: Target) -> None:
        """Take the mesh."""
        self.outside = Outside(target.corners)
        even = target.even
        self.seen = even[:: max(1, len(even) // _BURIED)]
        self.gap = _TOUCH * target.size

    def joined(self, pieces: Sequence[Piece], distance: float) -> list[Piece]:
        """The pieces, joined as long as no hull is farther off than a distance [m]."""
        found = list(pieces)
        for cost, living in self.steps(pieces):
            if cost > distance:
                break
            found = living
        return found

    def steps(self, pieces: Sequence[Piece]) -> Iterator[tuple[float, list[Piece]]]:
        """One join after another, the cheapest first, until one piece is left of what is near.

        Yields:
            How far off the hull of the join is [m], and the pieces after it.
        """
        living = dict(enumerate(pieces))
        queue: list[tuple[float, bool, int, int]] = []
        made: dict[tuple[int, int], Piece] = {}

        def offer(a: int, b: int) -> None:
            if not living[a].is_near(living[b], self.gap):
                return
            both = self._hull(living[a], living[b])
            if both is not None:
                made[a, b] = both
                heapq.heappush(queue, (self._bulge(both), False, a, b))

        for a, b in combinations(list(living), 2):
            offer(a, b)
        number = len(living)
        while queue:
            cost, whole, a, b = heapq.heappop(queue)
            if a not in living or b not in living:
                made.pop((a, b), None)
                continue
            if not whole:  # what it buries is dear to find, and is asked for where it can matter
                heapq.heappush(queue, (max(cost, self.burial(made[a, b])), True, a, b))
                continue
            del living[a], living[b]
            living[number] = made.pop((a, b))
            for other in list(living)[:-1]:
                offer(other, number)
            number += 1
            yield cost, list(living.values())

    @staticmethod
    def _hull(one: Piece, other: Piece) -> Piece | None:
        try:
            return mesh_piece(*hull(np.concatenate([one.vertices, other.vertices])))
        except MeshError:
            return None

    def _bulge(self, piece: Piece) -> float:
        """How far the piece is out of the mesh at most [m]."""
        return float(self.outside.distance(spread(piece.corners, _PROBES).points).max())

    def burial(self, piece: Piece) -> float:
        """How deep in the piece what can be touched of the mesh is at most [m]."""
        low, high = piece.bounds
        within: Points = self.seen[((self.seen > low) & (self.seen < high)).all(axis=1)]
        return -float(signed_distance(within, piece.sides).min()) if len(within) else 0.0
