"""Convex pieces within a distance: CoACD's, and those that are too far off cut again."""

from __future__ import annotations

import math
from functools import cached_property

from .convex import capped_hull
from .decompose import Budget, DecompositionError, decompose, divided, solid_of
from .measure import Measures, Target, measure, piece_distances
from .merge import Joiner
from .piece import Piece, mesh_piece
from .settings import Settings
from .surface import Prepared

AGAIN = 8
"""Pieces that are cut again at most: those that are farthest off."""

JOINS = (1.0, 0.8, 0.6)
"""Parts of the distance within which pieces are joined, tried in turn."""

JOINS_TO_FEW = (1.0, 0.9, 0.8, 0.6, 1.2)
"""The same where only so many pieces may be left."""

TRIMS = (1.0, 0.5, 0.25)
"""Parts of the distance that vertices may be left out, tried in turn."""

COARSER = 1.25
"""By how much both grow from step to step, where there are too many triangles otherwise."""

HOPELESS = 6
"""Times as many pieces as are wanted, from which joins never come down to so few."""


class Cutter:
    """Cuts one mesh, made ready once."""

    def __init__(
        self,
        target: Target,
        settings: Settings,
        *,
        most: int | None = None,
        few: int | None = None,
    ) -> None:
        """Take a mesh.

        Args:
            target: The mesh.
            settings: Limits of vertices and of time.
            most: Pieces that CoACD may make; None is any number.
            few: Pieces that are to be left in the end; None is any number.
        """
        self.target = target
        self.settings = settings
        self.most = most
        self.few = few
        self.hopeless = False
        self.budget = Budget(settings.time_limit)
        self.notes: list[str] = []
        self._coarse: tuple[list[Piece], float] | None = None

    @cached_property
    def solid(self) -> Prepared:
        """What is cut."""
        return solid_of(self.target)

    @cached_property
    def joiner(self) -> Joiner:
        """What joins pieces again."""
        return Joiner(self.target)

    def cut(
        self, distance: float, within: float, *, last: bool = True
    ) -> tuple[list[Piece], Measures] | None:
        """As few pieces as are within a distance of the mesh, with as few vertices, and how good.

        CoACD judges a piece by few points and sometimes misses one that sticks out, or that buries
        what can be touched; such a piece is cut on its own. The joins and the vertices left out
        afterwards that cost least come first, and go on beyond the distance while there are more
        triangles than may be.

        Args:
            distance: Of the pieces from the mesh, that the cuts and joins aim at [m].
            within: Distance [m] that is good enough.
            last: Whether to go on where the first cuts are not within it already.

        Returns:
            None where it was given up.

        Raises:
            DecompositionError: CoACD died, took too long, or gave nothing.
            MissingDependency: It is not installed.
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
        """The coarse cuts that were not within the distance [m], joined; None without any."""
        if self._coarse is None:
            return None
        return self._fewer(*self._coarse, within)

    def _fewer(
        self, cuts: list[Piece], distance: float, within: float
    ) -> tuple[list[Piece], Measures] | None:
        """Joined and trimmed: the first near enough of those few enough, else the nearest."""
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
                if measures.hausdorff >= before:  # it is not the vertices that are missing
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
                self.notes.append(f"{error.message}; a piece too far off was not cut again.")
                break
            if parts:
                found.remove(pieces[index])
                found += parts
        return found


class _Joins:
    """The pieces after each join, as far as they were asked for."""

    def __init__(self, joiner: Joiner, cuts: list[Piece]) -> None:
        self.levels = [(0.0, cuts)]
        self.steps = joiner.steps(cuts)

    def within(self, distance: float) -> list[Piece]:
        """The pieces where no join has cost more than a distance [m]."""
        while self.levels[-1][0] <= distance:
            step = next(self.steps, None)
            if step is None:
                break
            self.levels.append((max(step[0], self.levels[-1][0]), step[1]))
        return next(living for cost, living in reversed(self.levels) if cost <= distance)
