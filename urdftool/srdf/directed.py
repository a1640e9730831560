"""Separation of pieces along a direction, with the bound of second order of :mod:`.motion`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry.mesh import Array
from .chain import Placement
from .cover import Cover
from .motion import Motion

Indices = np.ndarray

_AT_ONCE = 2000
"""Pairs of pieces in one array; chosen, no source."""


@dataclass(frozen=True, eq=False)
class MovingBoxes:
    """Motion within boxes, and the shares of the coordinates in it.

    Attributes:
        placed: Bodies at the centers.
        motion: Bounds on the motion within.
        columns: Coordinate of each joint.
        share: Share of each coordinate [m], shape (n, number of coordinates); of the boxes with
            pieces that are apart along a direction at the center, it is that of this direction.
    """

    placed: Placement
    motion: Motion
    columns: tuple[int, ...]

    @cached_property
    def share(self) -> Array:
        """Return the shares, which :meth:`Directed.bound` raises."""
        return np.zeros_like(self.motion.share)

    def choose_shares(self) -> Array:
        """Return the shares of a direction where one was bounded, else those of any motion."""
        known: Indices = np.asarray((self.share > 0).any(axis=1))
        return np.where(known[:, None], self.share, self.motion.share)


class Directed:
    """Lower bounds on the gap of pieces along directions, within boxes."""

    def __init__(self, covers: tuple[Cover, Cover]) -> None:
        """Store the covers."""
        self.covers = covers

    @cached_property
    def corners(self) -> tuple[Array, Array]:
        """Return the corners of all pieces, shape (k, most corners, 3); some are repeated."""
        return self._pad(self.covers[0]), self._pad(self.covers[1])

    def _pad(self, cover: Cover) -> Array:
        most = max(len(piece.points) for piece in cover.pieces)
        rows = [
            np.concatenate([piece.points, np.repeat(piece.points[:1], most - len(piece.points), 0)])
            for piece in cover.pieces
        ]
        return np.stack(rows)

    def find_free(
        self,
        boxes: MovingBoxes,
        box: Indices,
        pieces: tuple[Indices, Indices],
        unit: Array,
        gap: Array,
        margin: float,
    ) -> Indices:
        """Return which pairs of pieces a direction from A to B separates in the whole box.

        Args:
            boxes: The boxes; the shares are raised.
            box: Index of the box of each pair of pieces, shape (m,).
            pieces: Indices of the pieces of A and of B.
            unit: Unit vectors, shape (m, 3).
            gap: Distance along the vector at the center [m], shape (m,).
            margin: Distance that must remain [m].
        """
        free: Indices = np.zeros(len(box), dtype=bool)
        for start in range(0, len(box), _AT_ONCE):
            some = slice(start, start + _AT_ONCE)
            both = pieces[0][some], pieces[1][some]
            free[some] = self._find_free(boxes, box[some], both, unit[some], gap[some], margin)
        return free

    def _find_free(
        self,
        boxes: MovingBoxes,
        box: Indices,
        pieces: tuple[Indices, Indices],
        unit: Array,
        gap: Array,
        margin: float,
    ) -> Indices:
        """Decide pairs by their bounding spheres, then by one corner, then by all corners."""
        sides = [_Side(boxes, side, box, unit, self.covers[side], pieces[side]) for side in (0, 1)]
        share = boxes.motion.curve_share[box]
        least, most = gap - margin, gap - margin
        for side in sides:
            for column, part in zip(boxes.columns, side.middle, strict=True):
                share[:, column] += part
            least = least - (side.middle + side.spread).sum(axis=0) - side.fixed
            most = most - np.maximum(side.middle - side.spread, 0.0).sum(axis=0) - side.fixed
        np.maximum.at(boxes.share, box, share)
        free: Indices = least > 0
        left = np.nonzero(~free & (most > 0))[0]
        for find in (_Side.find_height, _Side.find_lowest):
            heights = [
                find(side, some, left) for side, some in zip(sides, self.corners, strict=True)
            ]
            left = left[heights[0] + heights[1] > margin]
        free[left] = True
        return free


class _Side:
    """Pieces of A or of B, each in a box and with a direction."""

    def __init__(
        self,
        boxes: MovingBoxes,
        side: int,
        box: Indices,
        unit: Array,
        cover: Cover,
        pieces: Indices,
    ) -> None:
        """Compute the vectors whose products with the corners are needed.

        Args:
            boxes: The boxes.
            side: 0 for A, 1 for B.
            box: Index of the box of each piece, shape (m,).
            unit: Direction of each piece, shape (m, 3).
            cover: Pieces of the side.
            pieces: Indices of the pieces, shape (m,).
        """
        placed, motion = boxes.placed, boxes.motion
        rotation, at = placed.rotations[side][box], placed.translations[side][box]
        count = len(boxes.columns)
        self.pieces = pieces
        self.vectors: Array = np.zeros((count + 1, len(box), 3))
        """Direction, and its change by each joint, in the frame of the body."""
        self.offsets: Array = np.zeros((count + 1, len(box)))
        """Their products with the origin of the body."""
        self.slides: Array = np.zeros((count, len(box)))
        toward = unit if side else -unit
        self.vectors[0], self.offsets[0] = toward, _multiply(toward, at)
        grown: Array = np.ones(len(box))
        for index in range(count):
            sine, slide = motion.turns[side][index][box], motion.slides[side][index][box]
            axis = placed.axes[index][box]
            if sine.any():
                normal = sine[:, None] * np.cross(unit, axis)
                self.vectors[index + 1] = normal
                self.offsets[index + 1] = _multiply(at - placed.points[index][box], normal)
                grown += sine
            self.slides[index] = slide * abs(_multiply(unit, axis))
        self.vectors = np.einsum("nji,knj->kni", rotation, self.vectors)
        self.fixed = motion.curves[side][box, pieces] + self.slides.sum(axis=0)
        """Motion that does not depend on the corners [m], shape (m,)."""
        self.inflation = cover.inflation[pieces] * grown
        products = np.einsum("kni,ni->kn", self.vectors[1:], cover.centers[pieces])
        self.middle: Array = abs(products + self.offsets[1:])
        """Motion of first order of the centers by each joint [m], shape (joints, m)."""
        lengths = np.sqrt(np.einsum("kni,kni->kn", self.vectors[1:], self.vectors[1:]))
        self.spread: Array = lengths * cover.radii[pieces]
        """Difference to it of the other points of the pieces, at most."""

    def find_height(self, corners: Array, rows: Indices) -> Array:
        """Find the heights of the corners that are lowest at the center, with their motion [m]."""
        points, vectors = corners[self.pieces[rows]], self.vectors[:, rows]
        lowest = (points @ vectors[0][:, :, None])[:, :, 0].argmin(axis=1)
        point = points[np.arange(len(points)), lowest]
        heights = np.einsum("kni,ni->kn", vectors, point) + self.offsets[:, rows]
        moved: Array = heights[0] - abs(heights[1:]).sum(axis=0)
        low: Array = moved - self.fixed[rows] - self.inflation[rows]
        return low

    def find_lowest(self, corners: Array, rows: Indices) -> Array:
        """Find the least heights over all corners, with their motion [m]."""
        used = [0, *(1 + np.nonzero(self.vectors[1:, rows].any(axis=(1, 2)))[0])]
        vectors = self.vectors[np.ix_(used, rows)].transpose(1, 2, 0)
        products = corners[self.pieces[rows]] @ vectors
        products += self.offsets[np.ix_(used, rows)].T[:, None]
        heights = products[:, :, 0] - abs(products[:, :, 1:]).sum(axis=2)
        low: Array = heights.min(axis=1) - self.fixed[rows] - self.inflation[rows]
        return low


def _multiply(a: Array, b: Array) -> Array:
    """Return the products of vectors, each of shape (m, 3)."""
    products: Array = np.einsum("mi,mi->m", a, b)
    return products
