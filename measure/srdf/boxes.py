"""The boxes of a proof, checked one by one by coal.

A proof clears pairs of convex pieces in boxes of joint positions. For each pair of pieces, the
boxes in which it was cleared must fill all joint positions, and coal must find no contact of the
pieces at the center of each box and at a random one of its corners. Where a proof asked the
triangles instead, coal is asked for their distance. The poses of the links are those of
:mod:`.placement`.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import coal
import numpy as np

from urdftool.geometry.mesh import Array
from urdftool.model.elements import Robot
from urdftool.srdf.body import Contacts
from urdftool.srdf.chain import Chain
from urdftool.srdf.cover import Piece
from urdftool.srdf.divide import Boxes
from urdftool.srdf.prove import Prover
from urdftool.srdf.separate import Candidates
from urdftool.srdf.shapes import LinkShape
from urdftool.srdf.sweep import Covers
from urdftool.srdf.verdicts import Options, list_tasks

from .placement import list_ranges, place_links

NEAR = 1e-4
"""Largest contact that is not a disagreement [m]."""


@dataclass
class Checked:
    """What coal finds in the boxes of the proofs of a robot.

    Attributes:
        proofs: Pairs of links that were proved.
        claims: Pairs of pieces in a box that the proofs cleared.
        boxes: Boxes with at least one of them.
        poses: Poses at which coal was asked.
        triangles: Those at which it was asked for triangles.
        deepest: Largest contact that coal found [m].
        disagreements: Poses with a contact above 0.1 mm.
        least_filled: Least part of the joint positions that the boxes of two pieces fill.
        most_filled: Largest part.
        seconds: Processor time [s].
    """

    proofs: int = 0
    claims: int = 0
    boxes: int = 0
    poses: int = 0
    triangles: int = 0
    deepest: float = 0.0
    disagreements: int = 0
    least_filled: float = 1.0
    most_filled: float = 1.0
    seconds: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return the fields as data of JSON."""
        return asdict(self)


class RecordingProver(Prover):
    """Prover that stores which pairs of pieces it cleared in which boxes, and sweeps no bodies."""

    def __init__(self, *arguments: Any) -> None:
        """Store the bodies, as the prover does."""
        super().__init__(*arguments)
        self.cleared: list[tuple[Array, Array, Candidates]] = []

    def _list_simpler(self) -> Iterator[tuple[Chain, Covers]]:
        """Yield nothing: all proofs are by the boxes of all joints."""
        return iter(())

    def _halve(self, boxes: Boxes, candidates: Candidates, share: Array) -> Boxes:
        before, size = boxes.candidates, len(self.covers[1])
        keys, left = (
            (c.box * len(self.covers[0]) + c.one) * size + c.other for c in (before, candidates)
        )
        gone = before.choose(np.nonzero(~np.isin(keys, left))[0])
        self.cleared.append((boxes.values, boxes.halves, gone))
        return super()._halve(boxes, candidates, share)


def check_boxes(robot: Robot, most: int = 40_000, seed: int = 3) -> Checked:
    """Prove all pairs of a robot, and let coal check every box.

    Args:
        robot: Robot with collision meshes, boxes or cylinders.
        most: Largest number of boxes of each proof.
        seed: Of the corners.
    """
    begin, result = time.process_time(), Checked()
    random = np.random.default_rng(seed)
    for task in list_tasks(robot, Options()):
        covers, contacts = (task.a.cover, task.b.cover), Contacts(task.a, task.b)
        prover = RecordingProver(task.chain, covers, list(task.pairs), contacts)
        outcomes = prover.run(most).outcomes
        free = {prover.pairs.index(pair) for pair, found in outcomes.items() if found.is_free}
        result.proofs += len(free)
        if free:
            _Checker(robot, prover, free, result).check(random)
    result.seconds = time.process_time() - begin
    return result


class _Checker:
    """Questions to coal about two bodies."""

    def __init__(
        self, robot: Robot, prover: RecordingProver, free: set[int], result: Checked
    ) -> None:
        self.robot, self.prover, self.free, self.result = robot, prover, free, result
        self.pieces = [[_make_convex(p) for p in cover.pieces] for cover in prover.covers]
        self.links: dict[tuple[int, int], list[tuple[Any, Any]]] = {}
        self.joints = [coordinate.joint for coordinate in prover.chain.coordinates]

    def check(self, random: np.random.Generator) -> None:
        """Ask about all boxes, and add up what they fill."""
        filled = np.zeros((len(self.prover.covers[0]), len(self.prover.covers[1])))
        whole = np.maximum((self.prover.upper - self.prover.lower) / 2, 1e-12)
        for values, halves, gone in self.prover.cleared:
            rows = np.isin(self.prover.pair_of[gone.one, gone.other], list(self.free))
            gone = gone.choose(np.nonzero(rows)[0])
            share = np.minimum(halves / whole, 1.0).prod(axis=1)
            np.add.at(filled, (gone.one, gone.other), share[gone.box])
            corners = values + halves * random.choice((-1.0, 1.0), values.shape)
            corners = np.clip(corners, self.prover.lower, self.prover.upper)
            self.result.claims += len(gone)
            self.result.boxes += len(np.unique(gone.box))
            for poses in (values, corners):
                self._ask(poses, gone)
        mine = filled[np.isin(self.prover.pair_of, list(self.free))]
        self.result.least_filled = min(self.result.least_filled, float(mine.min()))
        self.result.most_filled = max(self.result.most_filled, float(mine.max()))

    def _ask(self, values: Array, gone: Candidates) -> None:
        used, number = np.unique(gone.box, return_inverse=True)
        if not len(used):
            return
        frames = self._place(values[used])
        for row, one, other in zip(number, gone.one, gone.other, strict=True):
            at = [coal.Transform3s(turn[row], shift[row]) for turn, shift in frames]
            distance = self._measure_pieces(int(one), int(other), at)
            self.result.poses += 1
            if distance <= NEAR:
                pair = self.prover.pairs[self.prover.pair_of[one, other]]
                self.result.triangles += 1
                distance = self._measure_links(pair, at)
            if distance <= 0:
                self.result.deepest = max(self.result.deepest, -distance)
                self.result.disagreements += distance < -NEAR or distance == 0

    def _place(self, values: Array) -> list[tuple[Array, Array]]:
        """Return the poses of A and of B."""
        count = len(values)
        positions = {name: np.zeros(count) for name in list_ranges(self.robot)}
        positions |= {name: values[:, i] for i, name in enumerate(self.joints)}
        frames = place_links(self.robot, positions, count)
        return [frames[body.top] for body in self.prover.contacts.bodies]

    def _measure_pieces(self, one: int, other: int, at: list[Any]) -> float:
        (a, _, grown_a), (b, _, grown_b) = self.pieces[0][one], self.pieces[1][other]
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        return float(coal.distance(a, at[0], b, at[1], request, result)) - grown_a - grown_b

    def _measure_links(self, pair: tuple[int, int], at: list[Any]) -> float:
        """Return the distance of the shapes of two links; 0 or less in contact [m]."""
        sides = []
        for side, index in enumerate(pair):
            if (side, index) not in self.links:
                body = self.prover.contacts.bodies[side]
                self.links[side, index] = _make_shapes(body.shapes[index], body.poses[index])
            sides.append(self.links[side, index])
        least = np.inf
        for a, where_a in sides[0]:
            for b, where_b in sides[1]:
                request, result = coal.DistanceRequest(), coal.DistanceResult()
                to_a, to_b = at[0] * where_a, at[1] * where_b
                least = min(least, float(coal.distance(a, to_a, b, to_b, request, result)))
        return least


def _make_convex(piece: Piece) -> tuple[Any, Any, float]:
    """Return a convex shape of coal, the model that owns it, and its inflation [m]."""
    model = coal.BVHModelOBBRSS()
    model.beginModel(max(len(piece.faces), 1), len(piece.points))
    model.addVertices(piece.points)
    model.endModel()
    model.buildConvexHull(True, "Qt")
    return model.convex, model, piece.inflation


def _make_shapes(shape: LinkShape, pose: tuple[Array, Array]) -> list[tuple[Any, Any]]:
    """Return the shapes of a link for coal, with their poses in the body."""
    found = []
    for solid in shape.solids:
        if solid.kind == "mesh":
            model = coal.BVHModelOBBRSS()
            model.beginModel(len(solid.faces), len(solid.vertices))
            model.addVertices(solid.vertices)
            model.addTriangles(solid.faces)
            model.endModel()
        else:
            model = getattr(coal, solid.kind.capitalize())(*solid.size)
        turn, shift = pose
        at = coal.Transform3s(turn @ solid.rotation, turn @ solid.translation + shift)
        found.append((model, at))
    return found
