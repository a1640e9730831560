"""Convex pieces within a distance of a mesh: CoACD's, joined, with inaccurate ones cut again.

CoACD cuts through the whole part and leaves more pieces than necessary. The cost of a join is
measured as the final error is: the distance by which the hull protrudes from the mesh, and the
depth to which it covers exterior surface.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from ..diagnostic import Diagnostic
from ..errors import MeshError
from ..geometry.mesh import Points
from .convex import compute_capped_hull, compute_hull, measure_plane_distance
from .decompose import Budget, DecompositionError, decompose, divide, make_solid
from .distance import spread
from .measure import Measures, ReferenceSurface, compute_excess_of_each, measure
from .notes import make_note
from .piece import Piece, find_overlapping_boxes, make_mesh_piece
from .remesh import Outside
from .settings import Settings
from .surface import Prepared

AGAIN = 8
"""Largest number of pieces that are cut again, the least accurate ones. Chosen, no source."""

JOINS = (1.0, 0.8, 0.6)
"""Multiples of the distance within which pieces are joined, tried in turn. Chosen, no source."""

TRIMS = (1.0, 0.5, 0.25)
"""Multiples of the distance for dropping vertices, tried in turn. Chosen, no source."""

COARSER = 1.25
"""Growth per step of both distances, if there are too many triangles. Chosen, no source."""

# chosen, no source, where a line gives none
_TOUCH = 0.01  # largest gap between neighbors, relative to the size
_PROBES = 300  # samples of a piece, whose distance from the mesh is measured
_BURIED = 6000  # points of the mesh that are searched for in pieces
_ENDS = 16  # vertices of a piece whose midpoints are tested
_SURE = 0.4  # part of a bound below which sampled hull points hardly ever stay
_GUESSED, _BULGE, _WHOLE = range(3)  # states of a join's known cost


class Cutter:
    """Convex decomposition of one mesh; shared data is computed once."""

    def __init__(
        self, target: ReferenceSurface, settings: Settings, *, most: int | None = None
    ) -> None:
        """Set the mesh and the limits.

        CoACD may create ``most`` pieces; None for no limit.
        """
        self.target = target
        self.settings = settings
        self.most = most
        self.budget = Budget(settings.time_limit)
        self.notes: list[Diagnostic] = []

    @cached_property
    def solid(self) -> Prepared:
        """Return the closed surface that is cut."""
        return make_solid(self.target)

    @cached_property
    def joiner(self) -> Joiner:
        """Return the joiner of pieces."""
        return Joiner(self.target)

    def cut(self, distance: float, within: float) -> tuple[list[Piece], Measures]:
        """Decompose the mesh into few pieces with few vertices, within a distance.

        CoACD judges a piece by few points and sometimes misses one that protrudes or that covers
        exterior surface; such a piece is cut again by itself. Then the cheapest joins and vertex
        removals are applied, even beyond the distance while there are too many triangles.

        Args:
            distance: Target distance of cuts and joins from the mesh [m].
            within: Acceptable distance [m].

        Raises:
            DecompositionError: CoACD crashed, took too long, or returned no piece.
            MissingDependency: coacd is not installed.
        """
        cuts = decompose(
            self.solid,
            2 * distance / self.target.longest,
            max_hulls=self.most or -1,
            max_vertices=self.settings.max_vertices,
            budget=self.budget,
            cores=self.target.cores,
        )
        if self.most is None:
            cuts = self._cut_again(cuts, distance)
        return self._reduce(cuts, distance, within)

    def _reduce(
        self, cuts: list[Piece], distance: float, within: float
    ) -> tuple[list[Piece], Measures]:
        """Join and trim pieces; return the first acceptable result, or else the most accurate."""
        joins = _Joins(self.joiner, cuts)
        tried: list[tuple[float, int, list[Piece], Measures]] = []
        for join in JOINS:
            living = joins.get_within(join * distance)
            before = math.inf
            for trim in TRIMS:
                pieces = self._trim(living, trim * min(distance, within))
                if not self._is_affordable(pieces):
                    break
                measures = measure(self.target, pieces)
                if measures.hausdorff <= within:
                    return pieces, measures
                tried.append((measures.hausdorff, len(tried), pieces, measures))
                if measures.hausdorff >= before:  # more vertices do not help
                    break
                before = measures.hausdorff
        if tried:
            _, _, pieces, measures = min(tried, key=lambda one: one[:2])
            return pieces, measures
        while True:
            distance *= COARSER
            living = joins.get_within(distance)
            pieces = self._trim(living, distance)
            if self._is_affordable(pieces) or distance > self.target.size:
                return pieces, measure(self.target, pieces)

    def _is_affordable(self, pieces: list[Piece]) -> bool:
        return sum(len(piece.faces) for piece in pieces) <= self.settings.max_triangles

    def _trim(self, pieces: list[Piece], tolerance: float) -> list[Piece]:
        most = self.settings.max_vertices
        return [
            make_mesh_piece(*compute_capped_hull(piece.vertices, most, tolerance))
            for piece in pieces
        ]

    def _cut_again(self, pieces: list[Piece], distance: float) -> list[Piece]:
        beyond = compute_excess_of_each(self.target, pieces)
        off = [
            max(far, self.joiner.measure_burial(p)) for far, p in zip(beyond, pieces, strict=True)
        ]
        worst = sorted((d, index) for index, d in enumerate(off) if d > distance)[-AGAIN:]
        found = list(pieces)
        for _, index in worst:
            try:
                parts = divide(
                    self.solid,
                    pieces[index],
                    distance / 2,
                    max_vertices=self.settings.max_vertices,
                    budget=self.budget,
                    cores=self.target.cores,
                )
            except DecompositionError as error:
                text = f"{error.message}; an inaccurate piece was not cut again."
                self.notes.append(make_note(error.code, text))
                break
            if parts:
                found.remove(pieces[index])
                found += parts
        return found


class _Joins:
    """Pieces after each join, computed lazily."""

    def __init__(self, joiner: Joiner, cuts: list[Piece]) -> None:
        self.levels = [(0.0, cuts)]
        self.steps = joiner.join_stepwise(cuts)

    def get_within(self, distance: float) -> list[Piece]:
        """Return the pieces after all joins that cost at most a distance [m]."""
        while self.levels[-1][0] <= distance:
            step = next(self.steps, None)
            if step is None:
                break
            self.levels.append((max(step[0], self.levels[-1][0]), step[1]))
        return next(living for cost, living in reversed(self.levels) if cost <= distance)


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
