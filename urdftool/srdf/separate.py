"""Separation of many pairs of convex pieces in one computation, each proved by a direction.

For any unit vector d, two convex sets are at least ``min d·b − max d·a`` apart. Directions come
from FCL, or from boxes around. Only the projections onto them count, so no answer of FCL is part of
a proof. A direction that FCL gives for the two pieces that are nearest is tried for all others of
the box, since it separates most of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..geometry.mesh import Array, Faces, Points
from .chain import Placement
from .cover import Cover, Piece, make_hull
from .directed import Directed, MovingBoxes

Indices = np.ndarray
Poses = tuple[tuple[Array, Array], tuple[Array, Array]]
"""Rotations (n, 3, 3) and translations (n, 3) [m] of A and of B in one frame."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """Pairs of pieces that may touch within boxes, in the order of the boxes.

    Attributes:
        box: Index of the box, shape (m,), ascending.
        one: Index of the piece of A.
        other: Index of the piece of B.
    """

    box: Indices
    one: Indices
    other: Indices

    def __len__(self) -> int:
        """Return the number of pairs."""
        return len(self.box)

    def choose(self, rows: Indices) -> Candidates:
        """Return some of the pairs."""
        return Candidates(self.box[rows], self.one[rows], self.other[rows])


@dataclass(frozen=True, eq=False)
class _Known:
    """What is known of candidates.

    Attributes:
        needed: Distance that must be exceeded by each at the center of its box [m], shape (m,).
        slack: Proved distance minus ``needed`` [m].
        free: Whether a direction separates it in the whole box.
    """

    needed: Array
    slack: Array
    free: Indices


def get_poses(placed: Placement) -> Poses:
    """Return rotation and translation [m] of A and of B."""
    (a, b), (at_a, at_b) = placed.rotations, placed.translations
    return (a, at_a), (b, at_b)


class Separator:
    """Tests of separation for two covers."""

    def __init__(self, covers: tuple[Cover, Cover], pair_of: Indices, margin: float) -> None:
        """Store the covers.

        Args:
            covers: Pieces of A and of B.
            pair_of: Index of the pair of links of two pieces, shape (ka, kb).
            margin: Distance that must remain [m].
        """
        self.directed, self.margin = Directed(covers), margin
        self.covers, self.pair_of = covers, pair_of
        self.count = int(pair_of.max()) + 1
        self.solids: tuple[dict[int, Any], dict[int, Any]] = {}, {}

    @cached_property
    def corners(self) -> list[tuple[Points, Indices]]:
        """Return the corners of all pieces of each cover, and where those of a piece begin."""
        return [
            (
                np.concatenate([piece.points for piece in cover.pieces]),
                np.cumsum([0, *(len(piece.points) for piece in cover.pieces)])[:-1],
            )
            for cover in self.covers
        ]

    def locate(self, poses: Poses) -> tuple[Points, Points]:
        """Return the centers of all pieces of A and of B [m], shape (n, k, 3)."""
        a, b = (
            cover.centers @ rotation.transpose(0, 2, 1) + translation[:, None]
            for cover, (rotation, translation) in zip(self.covers, poses, strict=True)
        )
        return a, b

    def compute_slack(
        self, candidates: Candidates, centers: tuple[Points, Points], needed: Array
    ) -> Array:
        """Return how much the bounding spheres are farther apart than needed [m], shape (m,)."""
        c = candidates
        between = centers[1][c.box, c.other] - centers[0][c.box, c.one]
        distance = np.sqrt(np.einsum("mi,mi->m", between, between))
        reach = self.covers[0].radii[c.one] + self.covers[1].radii[c.other]
        slack: Array = distance - reach - needed
        return slack

    def resolve(
        self,
        candidates: Candidates,
        boxes: MovingBoxes,
        needed: Array,
        slack: Array,
        directions: Array,
    ) -> tuple[Indices, Indices, Array]:
        """Try directions until each pair of links of a box is free, or its nearest pieces are not.

        Args:
            candidates: Pairs of pieces that may touch.
            boxes: Poses of both bodies in each box, and the motion within.
            needed: Distance that must be exceeded by each candidate [m], shape (m,).
            slack: What is known: proved distance minus ``needed`` [m], shape (m,); changed.
            directions: Unit vector that is tried first in each box, shape (n, 3); changed.

        Returns:
            Rows of the candidates that are left; and for each of them the group, which is the
            box times the number of pairs of links plus the pair; and the slack.
        """
        c, poses = candidates, get_poses(boxes.placed)
        group = c.box * self.count + self.pair_of[c.one, c.other]
        order = np.argsort(group, kind="stable")
        tried, which = np.unique(c.box[order], return_inverse=True)
        free = np.zeros(len(c), dtype=bool)
        known = _Known(needed, slack, free)
        rows = order[self._try(c, boxes, known, directions[tried], order, (tried, which))]
        settled: list[Indices] = []
        while len(rows):
            first = np.nonzero(np.diff(group[rows], prepend=-1))[0]
            lowest = np.minimum.reduceat(slack[rows], first)
            number = np.repeat(np.arange(len(first)), np.diff([*first, len(rows)]))
            hits = np.nonzero(slack[rows] == lowest[number])[0]
            queried = rows[hits[np.unique(number[hits], return_index=True)[1]]]
            found = self._ask(c.choose(queried), poses)
            directions[c.box[queried]] = found
            kept = self._try(c, boxes, known, found, rows, (c.box[queried], number))
            stays = (slack[queried] <= 0) & ~free[queried]
            done = kept & stays[number]
            settled.append(rows[done])
            rows = rows[kept & ~stays[number]]
        left = np.sort(np.concatenate(settled)) if settled else rows
        return left, group[left], slack[left]

    def _try(
        self,
        c: Candidates,
        box: MovingBoxes,
        known: _Known,
        unit: Array,
        rows: Indices,
        tried: tuple[Indices, Indices],
    ) -> Array:
        """Update what is known of rows by directions; return which are not free.

        Args:
            c: Candidates.
            box: Poses of both bodies in each box, and the motion within.
            known: What is known of each candidate; changed.
            unit: Unit vectors, shape (g, 3).
            rows: Candidates to update, shape (r,).
            tried: Box of each vector, shape (g,), and the vector of each row, shape (r,).
        """
        (boxes, which), poses = tried, get_poses(box.placed)
        gap = np.einsum("ni,ni->n", unit, poses[1][1][boxes] - poses[0][1][boxes])[which]
        for side, index, sign in ((0, c.one, -1.0), (1, c.other, 1.0)):
            cover = self.covers[side]
            turned = np.einsum("nji,nj->ni", poses[side][0][boxes], sign * unit)
            corners, begins = self.corners[side]
            heights = np.minimum.reduceat(corners @ turned.T, begins, axis=0)
            gap = gap + heights[index[rows], which] - cover.inflation[index[rows]]
        slack = known.slack
        slack[rows] = np.maximum(slack[rows], gap - known.needed[rows])
        kept: Array = (slack[rows] <= 0) & ~known.free[rows]
        left = np.nonzero(kept)[0]
        free = left[self._try_directed(c, box, unit, rows[left], which[left], gap[left])]
        known.free[rows[free]], kept[free] = True, False
        return kept

    def _try_directed(
        self,
        c: Candidates,
        box: MovingBoxes,
        unit: Array,
        rows: Indices,
        which: Indices,
        gap: Array,
    ) -> Indices:
        """Return the positions of the rows that directions separate in the whole box.

        The nearest pieces of a pair of links are looked at first, and the others if these are free.

        Args:
            c: Candidates.
            box: Poses of both bodies in each box, and the motion within.
            unit: Unit vectors, shape (g, 3).
            rows: Candidates, shape (r,).
            which: Vector of each row.
            gap: Distance of each row along its vector at the center [m].
        """
        curves = box.motion.curves
        curve = curves[0][c.box[rows], c.one[rows]] + curves[1][c.box[rows], c.other[rows]]
        group = c.box[rows] * self.count + self.pair_of[c.one[rows], c.other[rows]]
        order = np.lexsort((gap - curve, group))
        first = np.diff(group[order], prepend=-1) > 0
        number = np.cumsum(first) - 1
        nearest = order[first]
        is_free: Indices = np.zeros(len(nearest), dtype=bool)
        tried = np.nonzero((gap - curve)[nearest] > self.margin)[0]
        is_free[tried] = self._find_free(c, box, unit[which], rows, gap, nearest[tried])
        others = order[~first & is_free[number]]
        also = others[self._find_free(c, box, unit[which], rows, gap, others)]
        return np.concatenate([nearest[is_free], also])

    def _find_free(
        self,
        c: Candidates,
        box: MovingBoxes,
        unit: Array,
        rows: Indices,
        gap: Array,
        some: Indices,
    ) -> Indices:
        """Return which of some rows are free in the whole box."""
        chosen = rows[some]
        pieces = c.one[chosen], c.other[chosen]
        return self.directed.find_free(
            box, c.box[chosen], pieces, unit[some], gap[some], self.margin
        )

    def _ask(self, chosen: Candidates, poses: Poses) -> Array:
        """Ask FCL for the nearest points of pieces; return unit vectors from A to B, shape (m, 3).

        The vector of pieces that overlap joins their centers, which is likely to prove nothing.
        """
        import fcl

        request = fcl.DistanceRequest(enable_nearest_points=True)
        found = self._join_centers(chosen, poses)
        boxes, ones, others = (part.tolist() for part in (chosen.box, chosen.one, chosen.other))
        (turn_a, at_a), (turn_b, at_b) = poses
        for row, (box, one, other) in enumerate(zip(boxes, ones, others, strict=True)):
            result = fcl.DistanceResult()
            a = fcl.CollisionObject(self._get_solid(0, one), fcl.Transform(turn_a[box], at_a[box]))
            b = fcl.CollisionObject(
                self._get_solid(1, other), fcl.Transform(turn_b[box], at_b[box])
            )
            if fcl.distance(a, b, request, result) > 0:
                found[row] = result.nearest_points[1] - result.nearest_points[0]
        length = np.sqrt(np.einsum("mi,mi->m", found, found))
        unit: Array = found / np.maximum(length, 1e-12)[:, None]
        return unit

    def _join_centers(self, chosen: Candidates, poses: Poses) -> Array:
        spots = [
            np.einsum("mij,mj->mi", rotation[chosen.box], cover.centers[index])
            + translation[chosen.box]
            for cover, index, (rotation, translation) in zip(
                self.covers, (chosen.one, chosen.other), poses, strict=True
            )
        ]
        between: Array = spots[1] - spots[0]
        return between

    def _get_solid(self, side: int, index: int) -> Any:
        """Return the geometry of FCL of a piece, in the frame of its body."""
        solids = self.solids[side]
        if index not in solids:
            solids[index] = _make_solid(self.covers[side].pieces[index])
        return solids[index]


def _make_solid(piece: Piece) -> Any:
    import fcl

    points, faces = piece.points, piece.faces
    if not len(faces):  # a point or a segment, whose directions are those of a thin hull
        points, faces = _thicken(points)
    table = np.concatenate([np.full((len(faces), 1), 3), faces], axis=1)
    return fcl.Convex(points, len(faces), table.astype(np.int32).ravel())


def _thicken(points: Points) -> tuple[Points, Faces]:
    """Return a thin hull around a point or a segment."""
    piece = make_hull(points)
    return piece.points, piece.faces
