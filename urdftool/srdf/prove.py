"""Proofs and witnesses of contact for the links of two bodies.

Random poses, and the centers of the boxes of :mod:`.divide`, are tested for contact. Where the
motion in a box is small, triangles are asked for their distance.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import Array
from .body import Contacts
from .chain import Chain, Placement, place
from .divide import MARGIN, Boxes, Divider, Outcome, Pair
from .separate import get_poses
from .sweep import Covers, list_simpler

THIN = 0.01
"""Displacement below which triangles are asked for their distance [m]; chosen, no source."""

SAMPLES = 512
"""Random poses that are tried before the proof; chosen, no source."""

ROUNDS, ELITE, NARROWED = 6, 24, 128
"""Rounds of the search around the nearest poses, how many of them, and poses of a round; chosen, no
source.
"""

TURN = 512
"""Boxes in the first turn of a proof; chosen, no source."""

FASTER = 3
"""Boxes in a turn of a proof with one joint less, to those of a longer one; chosen, no source."""

SWEPT = 4
"""A proof with swept bodies gets the budget divided by this; chosen, no source."""

_DISTANCES_AT_ONCE = 1 << 16
"""Distances in one array, which then stays in the cache of a processor; chosen, no source."""

TESTS = 6
"""Tests of contact for each pair in a batch; chosen, no source."""


@dataclass
class Result:
    """Outcomes of the pairs of two bodies, and the boxes that were computed."""

    outcomes: dict[tuple[int, int], Outcome]
    boxes: int = 0
    tests: int = 0


class Prover(Divider):
    """Proof for two bodies, and search for a contact."""

    def __init__(
        self,
        chain: Chain,
        covers: Covers,
        pairs: Sequence[Pair],
        contacts: Contacts,
        seed: int = 0,
    ) -> None:
        """Store the bodies."""
        super().__init__(chain, covers, {pair: Outcome() for pair in pairs})
        self.contacts = contacts
        self.random = np.random.default_rng(seed)
        self.tests = self.measures = 0

    def run(self, budget: int) -> Result:
        """Sample, and prove until everything is decided or the budget of boxes is used.

        The proof with all joints and those with swept bodies take turns, each twice as long as
        before, so that the fastest of them ends the others.
        """
        boxes = 0
        if self.divide(1, budget):
            self.sample(SAMPLES if self.chain.coordinates else 1)
            boxes = self._take_turns(budget)
        return Result(self.outcomes, self.boxes + boxes, self.tests)

    def _take_turns(self, budget: int) -> int:
        """Prove pairs by all proofs; return the boxes of those with swept bodies."""
        count = min(TURN, budget // 2)
        if not self.divide(count, budget) or budget < SWEPT * TURN // 2:
            return 0
        swept = [Divider(*simpler, self._get_open_outcomes()) for simpler in self._list_simpler()]
        left, running = list(swept), True
        while running or left:
            left = [one for one in left if one.divide(self._scale(one, count), budget // SWEPT)]
            count *= 2
            running = running and self.divide(count, budget)
            if not self.list_open().any():
                break
        return sum(proof.boxes for proof in swept)

    def _scale(self, proof: Divider, count: int) -> int:
        """Return more boxes for a proof with fewer joints, of which fewer boxes are needed."""
        factor: int = FASTER ** (len(self.lower) - len(proof.lower))
        return count * factor

    def _list_simpler(self) -> Iterator[tuple[Chain, Covers]]:
        """Yield the proofs with swept bodies."""
        return list_simpler(self.chain, self.covers)

    def _get_open_outcomes(self) -> dict[Pair, Outcome]:
        """Return what is known of the pairs that are neither proved nor have a witness."""
        return {
            pair: self.outcomes[pair]
            for pair, is_open in zip(self.pairs, self.list_open(), strict=True)
            if is_open
        }

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
        depth = self._measure_spheres(placed, range(len(self.pairs)))
        self._test(values, placed, depth, 4 * TESTS)
        if len(self.lower):
            for index in np.nonzero(self.list_open())[0]:
                self._narrow(values, depth[:, index], int(index))

    def _narrow(self, values: Array, depth: Array, index: int) -> None:
        """Sample around the nearest poses of one pair, several times."""
        for _ in range(ROUNDS):
            best = values[np.argsort(depth, kind="stable")[:ELITE]]
            spread = np.maximum(best.std(axis=0), (self.upper - self.lower) / 200)
            parents = best[self.random.integers(0, len(best), min(NARROWED, len(values)))]
            values = parents + self.random.normal(size=parents.shape) * spread
            values = np.clip(values, self.lower, self.upper)
            values[: len(best)] = best
            placed = place(self.chain, values)
            depth = self._measure_spheres(placed, (index,))[:, index]
            wide = np.full((len(values), len(self.pairs)), np.inf)
            wide[:, index] = depth
            self._test(values, placed, wide, TESTS)
            if self.outcomes[self.pairs[index]].witness is not None:
                return

    def _measure_spheres(self, placed: Placement, indices: Iterable[int]) -> Array:
        """Return the smallest distance of the bounding spheres of pairs of links [m].

        Args:
            placed: Poses of the bodies.
            indices: Which pairs are measured; the distance of the others is infinite.
        """
        centers = self.separator.locate(get_poses(placed))
        depth: Array = np.full((len(centers[0]), len(self.pairs)), np.inf)
        for index in indices:
            ones, others = (np.unique(found) for found in np.nonzero(self.pair_of == index))
            step = max(1, _DISTANCES_AT_ONCE // (len(depth) * len(others)))
            for start in range(0, len(ones), step):
                some = ones[start : start + step]
                reach = self.covers[0].radii[some][:, None] + self.covers[1].radii[others]
                between = _measure_distances(centers[0][:, some], centers[1][:, others])
                least = (between - reach).min(axis=(1, 2))
                depth[:, index] = np.minimum(depth[:, index], least)
        return depth

    def _push_to_limits(self, values: Array) -> Array:
        """Put half of the coordinates of each pose at a limit, where robots fold."""
        choice = self.random.integers(0, 4, values.shape)
        return np.where(choice == 0, self.lower, np.where(choice == 1, self.upper, values))

    def _find_undecided(
        self, boxes: Boxes, placed: Placement, depth: Array, motion: Array
    ) -> np.ndarray:
        """Test the deepest overlaps for contact; measure distances where the motion is small."""
        self._test(boxes.values, placed, depth, TESTS)
        undecided: np.ndarray = np.isfinite(depth)
        self._measure(boxes.values, placed, motion, undecided)
        undecided &= self.list_open()
        return undecided

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


def get_pose_of(placed: Placement, row: int) -> list[tuple[Array, Array]]:
    """Return rotation and translation [m] of A and of B in one box."""
    return [(rotation[row], translation[row]) for rotation, translation in get_poses(placed)]


def _measure_distances(ones: Array, others: Array) -> Array:
    """Return the distances of points [m], (poses, ones, others), from (poses, points, 3)."""
    squares = (ones**2).sum(axis=2)[:, :, None] + (others**2).sum(axis=2)[:, None, :]
    squares -= 2 * ones @ others.transpose(0, 2, 1)
    distances: Array = np.sqrt(np.maximum(squares, 0))
    return distances
