"""Convex pieces within a distance of a mesh: CoACD's, with inaccurate ones cut again."""

from __future__ import annotations

import math
from functools import cached_property

from ..diagnostic import Diagnostic
from .convex import compute_capped_hull
from .decompose import Budget, DecompositionError, decompose, divide, make_solid
from .measure import Measures, ReferenceSurface, compute_excess_of_each, measure
from .merge import Joiner
from .notes import make_note
from .piece import Piece, make_mesh_piece
from .settings import Settings
from .surface import Prepared

AGAIN = 8
"""Largest number of pieces that are cut again, the least accurate ones."""

JOINS = (1.0, 0.8, 0.6)
"""Multiples of the distance within which pieces are joined, tried in turn."""

TRIMS = (1.0, 0.5, 0.25)
"""Multiples of the distance for dropping vertices, tried in turn."""

COARSER = 1.25
"""Growth per step of both distances, if there are too many triangles."""


class Cutter:
    """Convex decomposition of one mesh; shared data is computed once."""

    def __init__(
        self, target: ReferenceSurface, settings: Settings, *, most: int | None = None
    ) -> None:
        """Set the mesh and the limits.

        Args:
            target: The mesh.
            settings: Limits of vertices and time.
            most: Largest number of pieces that CoACD may create; None for no limit.
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
