"""Convex pieces of a mesh by plane cuts, within an error or with the smallest one.

The outline of the mesh is cut until every part is within the error, at more parts than permitted;
parts are then joined, and the result is measured. Where the measured error exceeds the estimate,
the points that were missed become probes, and the worst parts are cut again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry.mesh import Points
from .convex import compute_capped_hull, measure_plane_distance
from .distance import Samples, spread
from .measure import Deviation, Measures, ReferenceSurface, measure_and_locate
from .outline import compute_outline
from .partition import Part, Partition, compute_burial, make_probes
from .piece import Piece, make_mesh_piece
from .settings import Effort

# chosen, no source, where a line gives none
_PROBES = 20_000  # sampled; about half of them are used
_GOAL = 0.85  # part of the error that parts may use, so that the measured one is within
_TOLERANCE = 0.05  # part of the error that dropping hull vertices may use
_FINEST = 0.002  # relative tolerance of hulls below which vertices are not worth it
_COVERED = 0.001  # distance outside all pieces, relative to the size, that is ignored
_ENCLOSED = 0.02  # part of the area that is enclosed, up to which a small mesh is cut itself
_SEEN = 0.25  # part of its reach up to which a point may be deep in a part, if that is a gap
_HELPS = 0.9  # part of the error that a repetition must give to be worth its pieces
_SMALL = 1000  # triangles of such a mesh


@dataclass(frozen=True)
class Decomposition:
    """Convex pieces, their quality, and the parts that they were made from."""

    pieces: list[Piece]
    measures: Measures
    parts: list[Part]
    deviation: Deviation

    def estimate_burial(self, points: Points) -> Points:
        """Return the largest depth [m] of each point in a part."""
        return np.asarray(np.max([compute_burial(part, points) for part in self.parts], axis=0))

    def has_closed_gap(self, goal: float) -> bool:
        """Tell whether the error is the depth of a gap between parts that the pieces close.

        The deepest points are then deep in no part, and more cuts do not open the gap.

        Args:
            goal: Cost [m] up to which the parts were cut; a smaller depth in a part is no cause.
        """
        points, reach = self.deviation.worst, self.deviation.depth
        if not len(points) or self.measures.buried < self.measures.hausdorff:
            return False
        deepest = points[reach > _HELPS * reach.max()]
        return float(self.estimate_burial(deepest).max()) < min(goal, _SEEN * float(reach.max()))


class PlaneCutter:
    """Convex decomposition of one mesh by planes; shared data is computed once."""

    def __init__(self, target: ReferenceSurface, max_vertices: int, effort: Effort) -> None:
        """Set the mesh, the number of vertices of a piece, and how long to search."""
        self.target = target
        self.max_vertices = max_vertices
        self.effort = effort
        self.missed = np.zeros((0, 3))
        self.extra = np.zeros(0)

    @cached_property
    def samples(self) -> Samples:
        """Return the exterior points at which burial is estimated."""
        samples = spread(self.target.corners, _PROBES)
        samples = samples.select(np.arange(len(samples)) % 2 == 0)
        reached = self.target.exterior.is_touchable(samples.points)
        return samples.select(reached) if reached.any() else samples

    def _make_partition(self) -> Partition:
        target, samples = self.target, self.samples
        if len(self.missed):
            _, at = target.nearest.tree.query(self.missed)
            points = np.concatenate([samples.points, self.missed])
            owners = np.concatenate([samples.owners, target.nearest.samples.owners[at]])
            samples = Samples(points, owners)
        extra = np.zeros(len(samples))
        extra[len(samples) - len(self.extra) :] = self.extra
        probes = make_probes(samples.points, target.corners, samples.owners, extra)
        return Partition(target.exterior, probes, target.size)

    @cached_property
    def partition(self) -> Partition:
        """Return the search with the first probes."""
        return self._make_partition()

    @cached_property
    def whole(self) -> Part | None:
        """Return the uncut surface; None if it is flat."""
        surface = self.target.surface
        if len(surface.faces) <= _SMALL and self.target.enclosed < _ENCLOSED:
            return self.partition.make_whole(surface.vertices, surface.faces)
        return self.partition.make_whole(*compute_outline(self.target))

    def decompose(self, max_error: float, most: int) -> Decomposition | None:
        """Decompose the mesh into the fewest pieces within an error, relative to its size.

        Returns:
            Pieces within the error, or those with the smallest error; None if the mesh is flat.
        """
        if self.whole is None:
            return None
        goal = _GOAL * max_error * self.target.size
        several = self.target.surface.meshes > 1  # gaps between them stay closed
        parts = self._search([self.whole], most, goal, dense=False)
        if _estimate(parts) > goal and self.effort.retries:
            if several and (best := self._finish(parts, max_error)).has_closed_gap(goal):
                return best  # which no plane opens
            again = self._search([self.whole], most, goal, dense=True)
            parts = min(parts, again, key=_estimate)
        best = self._finish(parts, max_error)
        for _ in range(self.effort.retries):
            if best.measures.error <= max_error or (several and best.has_closed_gap(goal)):
                break
            if not self._add_missed_probes(best):
                break
            old = [self.partition.update_cost(part) for part in best.parts]
            parts = self._search(old, most, goal, dense=True)
            if _estimate(parts) >= _estimate(old):
                break
            found = self._finish(parts, max_error)
            error, before = found.measures.error, best.measures.error
            if error >= before or (several and error > max(_HELPS * before, max_error)):
                break
            best = found
        return best

    def _search(self, parts: Sequence[Part], most: int, goal: float, *, dense: bool) -> list[Part]:
        """Cut parts within a cost [m] or to more than permitted, and join them."""
        partition = self.partition
        surplus = most if most == 1 else int(np.ceil(self.effort.surplus * most))
        found = partition.cut(parts, surplus, goal, dense=dense)
        found = partition.join(found, goal, most)
        return partition.refine(found, goal, self.effort.rounds, dense=dense)

    def _add_missed_probes(self, found: Decomposition) -> bool:
        """Make probes of the points that are deeper than estimated; return whether there are any.

        A point may have been missed, or be deep in the union of parts but not in any one of them.
        """
        points, reach = found.deviation.worst, found.deviation.depth
        if not len(points):
            return False
        estimate = found.estimate_burial(points)
        extra = np.maximum(reach - estimate, 0)
        self.missed = np.concatenate([self.missed, points])
        self.extra = np.concatenate([self.extra, extra])
        self.partition = self._make_partition()
        return True

    def has_closed_gap(self, found: Decomposition, max_error: float) -> bool:
        """Tell whether pieces exceed an error only because they close a gap."""
        return found.has_closed_gap(_GOAL * max_error * self.target.size)

    def forecast_error(self, found: Decomposition, most: int, max_error: float) -> float:
        """Estimate the error with another number of pieces, from the one that was measured."""
        goal = _GOAL * max_error * self.target.size
        before = max(_estimate(found.parts), 1e-12)
        parts = [self.partition.update_cost(part) for part in found.parts]
        more = self._search(parts, most, goal, dense=False)
        return found.measures.error * min(1.0, _estimate(more) / before)

    def _finish(self, parts: Sequence[Part], max_error: float) -> Decomposition:
        pieces = self._make_pieces(parts, max_error)
        measures, deviation = measure_and_locate(self.target, pieces)
        return Decomposition(pieces, measures, list(parts), deviation)

    def _make_pieces(self, parts: Sequence[Part], max_error: float) -> list[Piece]:
        """Make hulls of few vertices, and extend them over exterior points outside of all."""
        size = self.target.size
        tolerance = max(_TOLERANCE * max_error, _FINEST) * size
        hulls = [self._make_capped_piece(part.hull, tolerance) for part in parts]
        points = self.target.exterior_samples
        outside = np.arange(len(points))
        off = np.full(len(points), np.inf)
        owner = np.zeros(len(points), dtype=np.int64)
        for number, piece in enumerate(hulls):
            away = measure_plane_distance(points[outside], piece.sides)
            nearer = away < off[outside]
            off[outside[nearer]] = away[nearer]
            owner[outside[nearer]] = number
            outside = outside[away > 0]
        left = outside[off[outside] > max(_COVERED * size, tolerance)]
        for number in np.unique(owner[left]).tolist():
            more = np.concatenate([parts[number].hull, points[left[owner[left] == number]]])
            hulls[number] = self._make_capped_piece(more, tolerance)
        return sorted(hulls, key=_order)

    def _make_capped_piece(self, points: Points, tolerance: float) -> Piece:
        vertices, faces = compute_capped_hull(points, self.max_vertices, tolerance)
        return make_mesh_piece(vertices, faces)


def _order(piece: Piece) -> tuple[float, ...]:
    middle = piece.vertices.mean(axis=0)
    return (-len(piece.faces), *middle.round(9).tolist())


def _estimate(parts: Sequence[Part]) -> float:
    return max(part.cost for part in parts)
