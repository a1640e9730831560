"""Convex pieces within a distance: CoACD's, and those that are too far off cut again."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from .convex import capped_hull
from .decompose import decompose, divided, solid_of
from .measure import Measures, Target, measure, piece_distances
from .merge import Joiner
from .piece import Piece, mesh_piece
from .settings import Settings
from .surface import Prepared

AGAIN = 8
"""Pieces that are cut again at most: those that are farthest off."""

JOINS = (1.0, 0.8, 0.6)
"""Parts of the distance within which pieces are joined, tried in turn."""

TRIMS = (0.5, 0.25)
"""Parts of the distance that vertices may be left out, tried in turn."""

HOPELESS = 6
"""Times as many pieces as are wanted, from which joins never come down to so few."""

_SAME = 1.25  # by so much more is still about as near, and has fewer pieces


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

    @cached_property
    def solid(self) -> Prepared:
        """What is cut."""
        return solid_of(self.target.surface)

    @cached_property
    def joiner(self) -> Joiner:
        """What joins pieces again."""
        return Joiner(self.target)

    def cut(
        self, distance: float, within: float, *, last: bool = True
    ) -> tuple[list[Piece], Measures] | None:
        """As few pieces as are within a distance of the mesh, with as few vertices, and how good.

        CoACD judges a piece by few points and sometimes misses one that sticks out; such a piece is
        cut on its own. What is joined and left out afterwards is measured, and taken back where
        that made it worse than is wanted.

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
            time_limit=self.settings.time_limit,
        )
        if self.most is not None:
            return self._best([cuts], within)
        if self.few is not None and len(cuts) > HOPELESS * self.few:
            return None
        if not last and measure(self.target, cuts).hausdorff > within:
            return None
        cuts = self._mended(cuts, distance)
        joins = (self.joiner.joined(cuts, share * distance) for share in JOINS)
        pieces, _ = self._best(joins, within)
        return self._best((self._trimmed(pieces, share * distance) for share in TRIMS), within)

    def _best(self, found: Iterable[list[Piece]], within: float) -> tuple[list[Piece], Measures]:
        """The first that are near enough; else the first about as near as the nearest."""
        tried = []
        for pieces in found:
            measures = measure(self.target, pieces)
            if measures.hausdorff <= within:
                return pieces, measures
            tried.append((pieces, measures))
        nearest = min(measures.hausdorff for _, measures in tried)
        return next(pair for pair in tried if pair[1].hausdorff <= _SAME * nearest)

    def _trimmed(self, pieces: list[Piece], tolerance: float) -> list[Piece]:
        most = self.settings.max_vertices
        return [mesh_piece(*capped_hull(piece.vertices, most, tolerance)) for piece in pieces]

    def _mended(self, pieces: list[Piece], distance: float) -> list[Piece]:
        off = piece_distances(self.target, pieces)
        worst = sorted((d, index) for index, d in enumerate(off) if d > distance)[-AGAIN:]
        found = list(pieces)
        for _, index in worst:
            parts = divided(
                self.solid,
                pieces[index],
                distance / 2,
                max_vertices=self.settings.max_vertices,
                time_limit=self.settings.time_limit,
            )
            if parts:
                found.remove(pieces[index])
                found += parts
        return found
