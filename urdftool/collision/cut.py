"""Convex pieces within a distance of a mesh: CoACD's, with inaccurate ones cut again."""

from __future__ import annotations

import math
from functools import cached_property

from ..diagnostic import Diagnostic, warning
from .convex import capped_hull
from .decompose import Budget, DecompositionError, decompose, divided, solid_of
from .measure import Measures, Target, measure, piece_distances
from .merge import Joiner
from .piece import Piece, mesh_piece
from .settings import Settings
from .surface import Prepared

AGAIN = 8
"""Largest number of pieces that are cut again, the least accurate ones."""

JOINS = (1.0, 0.8, 0.6)
"""Multiples of the distance within which pieces are joined, tried in turn."""

JOINS_TO_FEW = (1.0, 0.9, 0.8, 0.6, 1.2)
"""Values of ``JOINS`` if the number of pieces is limited."""

TRIMS = (1.0, 0.5, 0.25)
"""Multiples of the distance for dropping vertices, tried in turn."""

COARSER = 1.25
"""Growth per step of both distances, if there are too many triangles."""

HOPELESS = 6
"""Ratio of pieces to permitted pieces above which joins never reduce them enough."""


class Cutter:
    """Convex decomposition of one mesh; shared data is computed once."""

    def __init__(
        self,
        target: Target,
        settings: Settings,
        *,
        most: int | None = None,
        few: int | None = None,
    ) -> None:
        """Set the mesh and the limits.

        Args:
            target: The mesh.
            settings: Limits of vertices and time.
            most: Largest number of pieces that CoACD may create; None for no limit.
            few: Largest number of pieces in the result; None for no limit.
        """
        self.target = target
        self.settings = settings
        self.most = most
        self.few = few
        self.hopeless = False
        self.budget = Budget(settings.time_limit)
        self.notes: list[Diagnostic] = []
        self._coarse: tuple[list[Piece], float] | None = None

    @cached_property
    def solid(self) -> Prepared:
        """Return the closed surface that is cut."""
        return solid_of(self.target)

    @cached_property
    def joiner(self) -> Joiner:
        """Return the joiner of pieces."""
        return Joiner(self.target)

    def cut(
        self, distance: float, within: float, *, last: bool = True
    ) -> tuple[list[Piece], Measures] | None:
        """Decompose the mesh into few pieces with few vertices, within a distance.

        CoACD judges a piece by few points and sometimes misses one that protrudes or that covers
        exterior surface; such a piece is cut again by itself. Then the cheapest joins and vertex
        removals are applied, even beyond the distance while there are too many triangles.

        Args:
            distance: Target distance of cuts and joins from the mesh [m].
            within: Acceptable distance [m].
            last: Whether to continue if the first cuts are not within it.

        Returns:
            Pieces and their quality; None if the attempt was abandoned.

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
        if self.few is not None and len(cuts) > HOPELESS * self.few:
            self.hopeless = True
            return None
        if not last and measure(self.target, cuts).hausdorff > within:
            self._coarse = cuts, distance
            return None
        if self.most is None:
            cuts = self._mended(cuts, distance)
        return self._fewer(cuts, distance, within)

    def coarser(self, within: float) -> tuple[list[Piece], Measures] | None:
        """Join the coarse cuts that were not within the distance [m]; None if there are none."""
        if self._coarse is None:
            return None
        return self._fewer(*self._coarse, within)

    def _fewer(
        self, cuts: list[Piece], distance: float, within: float
    ) -> tuple[list[Piece], Measures] | None:
        """Join and trim pieces; return the first acceptable result, or else the most accurate."""
        joins = _Joins(self.joiner, cuts)
        tried: list[tuple[float, int, list[Piece], Measures]] = []
        for join in JOINS if self.few is None else JOINS_TO_FEW:
            living = joins.within(join * distance)
            if self.few is not None and len(living) > self.few:
                continue
            before = math.inf
            for trim in TRIMS:
                pieces = self._trimmed(living, trim * min(distance, within))
                if not self._affordable(pieces):
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
        if self.few is not None:
            return None
        while True:
            distance *= COARSER
            living = joins.within(distance)
            pieces = self._trimmed(living, distance)
            if self._affordable(pieces) or distance > self.target.size:
                return pieces, measure(self.target, pieces)

    def _affordable(self, pieces: list[Piece]) -> bool:
        if self.few is not None:
            return True
        return sum(len(piece.faces) for piece in pieces) <= self.settings.max_triangles

    def _trimmed(self, pieces: list[Piece], tolerance: float) -> list[Piece]:
        most = self.settings.max_vertices
        return [mesh_piece(*capped_hull(piece.vertices, most, tolerance)) for piece in pieces]

    def _mended(self, pieces: list[Piece], distance: float) -> list[Piece]:
        beyond = piece_distances(self.target, pieces)
        off = [max(far, self.joiner.burial(p)) for far, p in zip(beyond, pieces, strict=True)]
        worst = sorted((d, index) for index, d in enumerate(off) if d > distance)[-AGAIN:]
        found = list(pieces)
        for _, index in worst:
            try:
                parts = divided(
                    self.solid,
                    pieces[index],
                    distance / 2,
                    max_vertices=self.settings.max_vertices,
                    budget=self.budget,
                    cores=self.target.cores,
                )
            except DecompositionError as error:
                message = f"{error.message}; a piece too far off was not cut again."
                self.notes.append(warning("piece-not-cut", message, **error.data))
                break
            if parts:
                found.remove(pieces[index])
                found += parts
        return found


class _Joins:
    """Pieces after each join, computed lazily."""

    def __init__(self, joiner: Joiner, cuts: list[Piece]) -> None:
        self.levels = [(0.0, cuts)]
        self.steps = joiner.steps(cuts)

    def within(self, distance: float) -> list[Piece]:
        """Return the pieces after all joins that cost at most a distance [m]."""
        while self.levels[-1][0] <= distance:
            step = next(self.steps, None)
            if step is None:
                break
            self.levels.append((max(step[0], self.levels[-1][0]), step[1]))
        return next(living for cost, living in reversed(self.levels) if cost <= distance)
