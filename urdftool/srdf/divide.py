"""Proof by boxes of joint values that links of two bodies never touch.

A box is free for a pair of links if the distance of their covers at its center is larger than all
displacements within it (the theorems of :mod:`.motion`), by a margin that is larger than all errors
of rounding. Else it is halved, unless the links touch at its center, which is a witness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import Array
from .chain import Chain, Placement, place
from .directed import MovingBoxes
from .motion import bound_motion
from .separate import Candidates, Separator, get_poses
from .sweep import Covers

MARGIN = 1e-4
"""Distance added to each displacement [m], above the errors of FCL (1e-6) and of sums (1e-8).

Chosen, no source.
"""

BATCH = 256
"""Boxes in one computation; chosen, no source."""

CHECKED = 2048
"""Boxes after which the proof compares its progress with its budget; chosen, no source."""

HOPELESS = 8.0
"""The proof stops if it would use so many times its budget at the same pace; chosen, no source."""


Pair = tuple[int, int]
"""Indices of a link of A and one of B."""


@dataclass
class Outcome:
    """What is known of two links.

    Attributes:
        is_free: Whether the proof is complete.
        witness: Values of the coordinates at which they touch; None if none was found.
        nearest: Smallest distance at a pose that was looked at [m]; infinite if none was measured.
        near_values: Values of the coordinates of that pose.
    """

    is_free: bool = False
    witness: Array | None = None
    nearest: float = np.inf
    near_values: Array | None = None


@dataclass(frozen=True, eq=False)
class Boxes:
    """Boxes of joint values, with the pairs of pieces that may touch within.

    Attributes:
        values: Centers [rad, m], shape (n, number of coordinates).
        halves: Half widths [rad, m], of the same shape.
        directions: Unit vector that is tried first in each box, shape (n, 3).
        candidates: Pairs of pieces.
    """

    values: Array
    halves: Array
    directions: Array
    candidates: Candidates

    def __len__(self) -> int:
        """Return the number of boxes."""
        return len(self.values)

    def choose(self, rows: np.ndarray, candidates: Candidates) -> Boxes:
        """Return some of the boxes, with candidates that are already numbered for them."""
        return Boxes(self.values[rows], self.halves[rows], self.directions[rows], candidates)


class Divider:
    """Proof for two bodies that looks for no contact."""

    def __init__(self, chain: Chain, covers: Covers, outcomes: dict[Pair, Outcome]) -> None:
        """Store the bodies."""
        self.chain, self.covers, self.pairs = chain, covers, list(outcomes)
        self.outcomes = outcomes
        self.boxes, self.check = 0, CHECKED
        pairs = self.pairs
        links = [int(cover.owner.max(initial=0)) + 1 for cover in covers]
        number = -np.ones(links, dtype=np.int64)
        for index, pair in enumerate(pairs):
            number[pair] = index
        self.pair_of = number[covers[0].owner[:, None], covers[1].owner[None]]
        """Index of the pair of links of two pieces, shape (ka, kb); -1 for none."""
        self.separator = Separator(self.covers, self.pair_of, MARGIN)
        self.columns = tuple(step.column for step in chain.steps)
        self.lower = np.array([c.lower for c in chain.coordinates])
        self.upper = np.array([c.upper for c in chain.coordinates])
        self.stack = [self._make_first()]

    def divide(self, count: int, budget: int) -> bool:
        """Divide some boxes; return whether more of them may decide more pairs.

        Args:
            count: Number of boxes.
            budget: Number of boxes in all calls, after which the proof would end.
        """
        end = min(self.boxes + count, budget)
        hopeless = False
        while self.stack and not hopeless and self.boxes < end and self.list_open().any():
            boxes = self._advance(_take(self.stack))
            if len(boxes):
                self.stack.append(boxes)
            hopeless = self._is_hopeless(budget)
        self._mark_free()
        return not hopeless and self.boxes < budget and bool(self.list_open().any())

    def _is_hopeless(self, budget: int) -> bool:
        """Tell whether the proof would need far more boxes than its budget at the same pace."""
        if not len(self.lower):
            return True
        if self.boxes < self.check:
            return False
        self.check *= 2
        done = 1.0 - sum(map(self._measure_volume, self.stack))
        return done * HOPELESS * budget < self.boxes

    def _make_first(self) -> Boxes:
        """Return the box of all joint values, with all pairs of pieces."""
        center, half = (self.lower + self.upper) / 2, (self.upper - self.lower) / 2
        half = half * (1 + 1e-12) + 1e-12
        one, other = np.nonzero(self.pair_of >= 0)
        candidates = Candidates(np.zeros(len(one), dtype=np.int64), one, other)
        return Boxes(center[None], half[None], np.eye(3)[:1], candidates)

    def _measure_volume(self, boxes: Boxes) -> float:
        """Return the share of boxes in all joint values."""
        whole = np.maximum((self.upper - self.lower) / 2, 1e-12)
        return float((boxes.halves / whole).prod(axis=1).sum())

    def list_open(self) -> np.ndarray:
        """Return which pairs are neither proved nor have a witness, shape (pairs,)."""
        outcomes = [self.outcomes[pair] for pair in self.pairs]
        return np.array([one.witness is None and not one.is_free for one in outcomes])

    def _advance(self, boxes: Boxes) -> Boxes:
        """Look at boxes, and return the halves of those that are not free."""
        c = boxes.candidates
        c = c.choose(np.nonzero(self.list_open()[self.pair_of[c.one, c.other]])[0])
        if not len(c):
            return boxes.choose(np.zeros(0, dtype=np.int64), c)
        boxes = boxes.choose(*_number_boxes(c))
        c = boxes.candidates
        self.boxes += len(boxes)
        placed = place(self.chain, boxes.values)
        centers = self.separator.locate(get_poses(placed))
        radii = self.covers[0].radii, self.covers[1].radii
        motion = bound_motion(self.chain, placed, boxes.halves, centers, radii)
        moving = MovingBoxes(placed, motion, self.columns)
        needed = motion.bounds[0][c.box, c.one] + motion.bounds[1][c.box, c.other] + MARGIN
        slack = self.separator.compute_slack(c, centers, needed)
        near = np.nonzero(slack <= 0)[0]
        c, needed, slack = c.choose(near), needed[near], slack[near]
        rows, group, slack = self.separator.resolve(c, moving, needed, slack, boxes.directions)
        shape = len(boxes), len(self.pairs)
        depth: Array = np.full(shape[0] * shape[1], np.inf)
        moves: Array = np.zeros(shape[0] * shape[1])
        np.minimum.at(depth, group, slack + needed[rows])
        np.maximum.at(moves, group, needed[rows])
        depth, moves = depth.reshape(shape), moves.reshape(shape)
        undecided = self._find_undecided(boxes, placed, depth, moves)
        left = rows[undecided.reshape(-1)[group]]
        return self._halve(boxes, c.choose(left), moving.choose_shares())

    def _find_undecided(
        self, boxes: Boxes, placed: Placement, depth: Array, motion: Array
    ) -> np.ndarray:
        """Return which boxes are undecided for which pairs, shape (n, pairs).

        Args:
            boxes: The boxes.
            placed: Both bodies at their centers.
            depth: Slack of the pieces that are nearest [m]; infinite if the pair is free.
            motion: Largest displacement within [m], shape (n, pairs).
        """
        return np.isfinite(depth)

    def _halve(self, boxes: Boxes, candidates: Candidates, share: Array) -> Boxes:
        """Halve boxes in the coordinate that moves the pieces most."""
        if not len(candidates):
            return boxes.choose(np.zeros(0, dtype=np.int64), candidates)
        kept, c = _number_boxes(candidates)
        boxes, share = boxes.choose(kept, c), share[kept]
        if not len(self.lower):
            return boxes  # nothing moves: it stays undecided
        rows = np.arange(len(boxes))
        column = share.argmax(axis=1)
        halves = boxes.halves.copy()
        halves[rows, column] /= 2
        step = np.zeros_like(halves)
        step[rows, column] = halves[rows, column]
        halves *= 1 + 1e-15
        both = Candidates(
            np.concatenate([c.box, c.box + len(rows)]),
            np.concatenate([c.one, c.one]),
            np.concatenate([c.other, c.other]),
        )
        return Boxes(
            np.concatenate([boxes.values - step, boxes.values + step]),
            np.concatenate([halves, halves]),
            np.concatenate([boxes.directions, boxes.directions]),
            both,
        )

    def _mark_free(self) -> None:
        """Mark the pairs that no box has left as free."""
        left = np.zeros(len(self.pairs), dtype=bool)
        for boxes in self.stack:
            c = boxes.candidates
            left[self.pair_of[c.one, c.other]] = True
        for pair, is_left in zip(self.pairs, left, strict=True):
            outcome = self.outcomes[pair]
            outcome.is_free |= outcome.witness is None and not is_left


def _number_boxes(candidates: Candidates) -> tuple[np.ndarray, Candidates]:
    """Return the boxes of candidates, and the candidates with the boxes numbered from 0."""
    kept, box = np.unique(candidates.box, return_inverse=True)
    return kept, Candidates(box, candidates.one, candidates.other)


def _take(stack: list[Boxes]) -> Boxes:
    """Take a batch of boxes from the end of the stack."""
    boxes = stack.pop()
    if len(boxes) <= BATCH:
        return boxes
    start = len(boxes) - BATCH
    c = boxes.candidates
    late = c.box >= start
    rows = np.arange(len(boxes))
    rest = Candidates(c.box[~late], c.one[~late], c.other[~late])
    stack.append(boxes.choose(rows[:start], rest))
    return boxes.choose(rows[start:], Candidates(c.box[late] - start, c.one[late], c.other[late]))
