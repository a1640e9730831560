"""Proof by boxes of joint values that links of two bodies never touch.

A box is free for a pair of links if the distance of their covers at its center is larger than all
displacements within it (the theorems of :mod:`.motion`), by a margin that is larger than all errors
of rounding. Else it is halved, unless the links touch at its center, which is a witness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import Array
from .body import Body, Contacts
from .chain import Chain, Placement, place
from .directed import MovingBoxes
from .motion import bound_motion
from .separate import Candidates, Separator, get_poses

MARGIN = 1e-4
"""Distance added to each displacement [m], above the errors of FCL (1e-6) and of sums (1e-8).

Chosen, no source.
"""

BATCH = 256
"""Boxes in one computation; chosen, no source."""

THIN = 0.01
"""Displacement below which triangles are asked for their distance [m]; chosen, no source."""

NARROWEST = 1e-4
"""Half width below which a box is not halved [rad, m]; chosen, no source."""

SAMPLES = 512
"""Random poses that are tried before the proof; chosen, no source."""

ROUNDS, ELITE = 6, 24
"""Rounds of the search around the nearest poses, and how many of them; chosen, no source."""

CHECKED = 2048
"""Boxes after which the proof compares its progress with its budget; chosen, no source."""

HOPELESS = 8.0
"""The proof stops if it would use so many times its budget at the same pace; chosen, no source."""

_PIECES_AT_ONCE = 64
"""Pairs of convex pieces in one array; chosen, no source."""

TESTS = 6
"""Tests of contact for each pair in a batch; chosen, no source."""


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


@dataclass
class Result:
    """Outcomes of the pairs of two bodies, and the boxes that were computed."""

    outcomes: dict[tuple[int, int], Outcome]
    boxes: int = 0
    tests: int = 0


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


class Prover:
    """Proof for two bodies."""

    def __init__(
        self, chain: Chain, a: Body, b: Body, pairs: list[tuple[int, int]], seed: int = 0
    ) -> None:
        """Store the bodies.

        Args:
            chain: Joints between them.
            a: One body.
            b: The other.
            pairs: Indices of the links to compare.
            seed: Of the random poses.
        """
        self.chain, self.covers, self.pairs = chain, (a.cover, b.cover), pairs
        self.contacts = Contacts(a, b)
        self.outcomes = {pair: Outcome() for pair in pairs}
        self.random = np.random.default_rng(seed)
        self.boxes = self.tests = self.measures = 0
        number = -np.ones((len(a.shapes), len(b.shapes)), dtype=np.int64)
        for index, pair in enumerate(pairs):
            number[pair] = index
        self.pair_of = number[a.cover.owner[:, None], b.cover.owner[None]]
        """Index of the pair of links of two pieces, shape (ka, kb); -1 for none."""
        self.separator = Separator(self.covers, self.pair_of, MARGIN)
        self.columns = tuple(step.column for step in chain.steps)
        self.lower = np.array([c.lower for c in chain.coordinates])
        self.upper = np.array([c.upper for c in chain.coordinates])

    def run(self, budget: int) -> Result:
        """Sample, and prove until everything is decided or the budget of boxes is used."""
        whole = self._make_first()
        if not len(self._advance(whole)):
            self._mark_free([])
            return Result(self.outcomes, self.boxes, self.tests)
        self.sample(SAMPLES if self.chain.coordinates else 1)
        stack, check = [whole], CHECKED
        while stack and self.boxes < budget:
            boxes = self._advance(_take(stack))
            if len(boxes):
                stack.append(boxes)
            if self.boxes >= check:
                check *= 2
                done = 1.0 - sum(map(self._measure_volume, stack))
                if done * HOPELESS * budget < self.boxes:
                    break
        self._mark_free(stack)
        return Result(self.outcomes, self.boxes, self.tests)

    def _make_first(self) -> Boxes:
        center, half = (self.lower + self.upper) / 2, (self.upper - self.lower) / 2
        half = half * (1 + 1e-12) + 1e-12
        one, other = np.nonzero(self.pair_of >= 0)
        candidates = Candidates(np.zeros(len(one), dtype=np.int64), one, other)
        return Boxes(center[None], half[None], np.eye(3)[:1], candidates)

    def _measure_volume(self, boxes: Boxes) -> float:
        """Return the share of boxes in all joint values."""
        whole = np.maximum((self.upper - self.lower) / 2, 1e-12)
        return float((boxes.halves / whole).prod(axis=1).sum())

    def _list_open(self) -> np.ndarray:
        """Return which pairs have no witness, shape (pairs,)."""
        return np.array([self.outcomes[pair].witness is None for pair in self.pairs])

    def sample(self, count: int) -> None:
        """Test random poses for contact, then poses around those with the smallest distances.

        The distance is that of the bounding spheres of pieces. This is the cross-entropy method
        (Rubinstein, Methodol. Comput. Appl. Probab. 1, 1999) for each pair that is left.
        """
        values = self.random.uniform(self.lower, self.upper, (count, len(self.lower)))
        if not len(self.lower):
            values = values[:1]
        else:
            values[: count // 2] = self._push_to_limits(values[: count // 2])
        placed = place(self.chain, values)
        depth = self._measure_spheres(placed, np.nonzero(self.pair_of >= 0))
        self._test(values, placed, depth, 4 * TESTS)
        if len(self.lower):
            for index in np.nonzero(self._list_open())[0]:
                self._narrow(values, depth[:, index], int(index))

    def _narrow(self, values: Array, depth: Array, index: int) -> None:
        """Sample around the nearest poses of one pair, several times."""
        pieces = np.nonzero(self.pair_of == index)
        for _ in range(ROUNDS):
            best = values[np.argsort(depth, kind="stable")[:ELITE]]
            spread = np.maximum(best.std(axis=0), (self.upper - self.lower) / 200)
            parents = best[self.random.integers(0, len(best), len(values))]
            values = parents + self.random.normal(size=parents.shape) * spread
            values = np.clip(values, self.lower, self.upper)
            values[: len(best)] = best
            placed = place(self.chain, values)
            depth = self._measure_spheres(placed, pieces)[:, index]
            wide = np.full((len(values), len(self.pairs)), np.inf)
            wide[:, index] = depth
            self._test(values, placed, wide, TESTS)
            if self.outcomes[self.pairs[index]].witness is not None:
                return

    def _measure_spheres(self, placed: Placement, pieces: tuple[np.ndarray, ...]) -> Array:
        """Return the smallest distance of the bounding spheres of each pair of links [m]."""
        ones, others = pieces
        centers = self.separator.locate(get_poses(placed))
        reach = self.covers[0].radii[ones] + self.covers[1].radii[others]
        depth: Array = np.full((len(centers[0]), len(self.pairs)), np.inf)
        pair = self.pair_of[ones, others]
        for start in range(0, len(ones), _PIECES_AT_ONCE):
            some = slice(start, start + _PIECES_AT_ONCE)
            between = centers[0][:, ones[some]] - centers[1][:, others[some]]
            slack = np.sqrt(np.einsum("nki,nki->nk", between, between)) - reach[some]
            for index in np.unique(pair[some]):
                least = slack[:, pair[some] == index].min(axis=1)
                depth[:, index] = np.minimum(depth[:, index], least)
        return depth

    def _push_to_limits(self, values: Array) -> Array:
        """Put half of the coordinates of each pose at a limit, where robots fold."""
        choice = self.random.integers(0, 4, values.shape)
        return np.where(choice == 0, self.lower, np.where(choice == 1, self.upper, values))

    def _advance(self, boxes: Boxes) -> Boxes:
        """Look at boxes, and return the halves of those that are not free."""
        c = boxes.candidates
        c = c.choose(np.nonzero(self._list_open()[self.pair_of[c.one, c.other]])[0])
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
        self._test(boxes.values, placed, depth, TESTS)
        undecided: np.ndarray = np.isfinite(depth)
        self._measure(boxes.values, placed, moves, undecided)
        left = rows[(undecided & self._list_open()).reshape(-1)[group]]
        return self._halve(boxes, c.choose(left), moving.choose_shares())

    def _test(self, values: Array, placed: Placement, depth: Array, tests: int) -> None:
        """Test the deepest overlaps of each pair for contact."""
        for index, pair in enumerate(self.pairs):
            if self.outcomes[pair].witness is not None:
                continue
            rows = np.nonzero(depth[:, index] <= MARGIN)[0]
            for row in rows[np.argsort(depth[rows, index], kind="stable")][:tests]:
                self.tests += 1
                if self.contacts.find_contact(pair, get_pose_of(placed, row)):
                    self.outcomes[pair].witness = values[row].copy()
                    break

    def _measure(
        self, values: Array, placed: Placement, motion: Array, undecided: np.ndarray
    ) -> None:
        """Ask the triangles for their distance where the motion is small; clear free boxes."""
        for row, index in zip(*np.nonzero(undecided & (motion < THIN)), strict=True):
            outcome = self.outcomes[self.pairs[index]]
            if outcome.witness is not None:
                continue
            self.measures += 1
            distance = self.contacts.measure(self.pairs[index], get_pose_of(placed, row))
            if distance <= 0:
                outcome.witness = values[row].copy()
                continue
            if distance < outcome.nearest:
                outcome.nearest, outcome.near_values = distance, values[row].copy()
            undecided[row, index] = distance <= motion[row, index]

    def _halve(self, boxes: Boxes, candidates: Candidates, share: Array) -> Boxes:
        """Halve boxes in the coordinate that moves the pieces most."""
        if not len(candidates):
            return boxes.choose(np.zeros(0, dtype=np.int64), candidates)
        kept, c = _number_boxes(candidates)
        boxes, share = boxes.choose(kept, c), share[kept]
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

    def _mark_free(self, stack: list[Boxes]) -> None:
        """Mark the pairs that no box has left as free."""
        left = np.zeros(len(self.pairs), dtype=bool)
        for boxes in stack:
            c = boxes.candidates
            left[self.pair_of[c.one, c.other]] = True
        for index, pair in enumerate(self.pairs):
            outcome = self.outcomes[pair]
            outcome.is_free = outcome.witness is None and not left[index]


def _number_boxes(candidates: Candidates) -> tuple[np.ndarray, Candidates]:
    """Return the boxes of candidates, and the candidates with the boxes numbered from 0."""
    kept, box = np.unique(candidates.box, return_inverse=True)
    return kept, Candidates(box, candidates.one, candidates.other)


def get_pose_of(placed: Placement, row: int) -> list[tuple[Array, Array]]:
    """Return rotation and translation [m] of A and of B in one box."""
    return [(rotation[row], translation[row]) for rotation, translation in get_poses(placed)]


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
