"""How good a collision geometry is: distances, volumes and counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Points
from ..inertia.sampling import spread_points
from ..inertia.winding import boxes_of, winding_numbers
from . import convex, primitives
from .distance import Samples, Surface, areas_of, spread
from .piece import Piece, mesh_piece, near_ones
from .remesh import Layer
from .surface import Prepared
from .touchable import Flood, flood

SAMPLES = 20_000
"""Points on each surface between which distances are measured."""

MARGIN = 0.001
"""Depth, relative to the part's size, up to which a point counts as on a surface."""

_DENSE = 80_000
_SEAM = 0.004  # pieces that meet at a cut leave gaps of a part of this, relative to the size


@dataclass(frozen=True)
class Measures:
    """A collision geometry against the visual it stands for.

    Distances are two-sided, between what can be touched of the two: enclosed surfaces of the
    visual, and faces of a piece within another, are left out.
    """

    size: float
    """Diagonal of the visual's bounding box [m]; ``error`` is relative to it."""
    hausdorff: float
    """Largest distance [m] from a point of either surface to the other."""
    mean: float
    """Mean distance [m], of both directions."""
    visual_to_collision: float
    """Largest distance [m] from the visual to the collision."""
    collision_to_visual: float
    """Largest distance [m] from the collision to the visual."""
    volume: float
    """Volume [m³] of the collision; space that pieces share counts once."""
    volume_ratio: float
    """That volume over the visual's."""
    outside: float
    """Share of the visual's touchable area that lies outside the collision, by over 0.1 %."""
    enclosed: float
    """Share of the visual's area that cannot be touched, and was not measured."""
    pieces: int
    triangles: int
    vertices: int

    @property
    def error(self) -> float:
        """The Hausdorff distance relative to the size."""
        return self.hausdorff / self.size

    def as_dict(self) -> dict[str, Any]:
        """All of it, with the relative error."""
        return {"error": self.error, **asdict(self)}


class Target:
    """A visual surface, with all that is needed to measure collisions against it."""

    def __init__(self, surface: Prepared, cores: int = 1) -> None:
        """Keep it; nothing is computed before it is asked for.

        Args:
            surface: The visual.
            cores: How many may be used; what is found does not hang on it.
        """
        self.surface = surface
        self.cores = cores
        self.size = surface.size
        self.longest = float(np.ptp(surface.vertices, axis=0).max())

    @cached_property
    def corners(self) -> Points:
        """Its triangles [m]."""
        return self.surface.corners

    @cached_property
    def flood(self) -> Flood:
        """The space around it."""
        return flood(self.corners)

    @cached_property
    def _all(self) -> tuple[Points, npt.NDArray[np.bool_]]:
        points = spread(self.corners, SAMPLES).points
        ends = self.surface.vertices
        ends = ends[:: max(1, len(ends) // SAMPLES)]
        both = np.concatenate([points, ends])
        return both, self.flood.touches(both)

    @cached_property
    def touchable(self) -> Points:
        """Points [m] of what can be touched, spread evenly, and then its vertices."""
        points, reached = self._all
        return points[reached] if reached.any() else points

    @cached_property
    def even(self) -> Points:
        """Those of them that are spread evenly."""
        points, reached = self._all
        even = points[:SAMPLES][reached[:SAMPLES]]
        return even if len(even) else points[:SAMPLES]

    @cached_property
    def enclosed(self) -> float:
        """Share of its area that cannot be touched."""
        return float(1 - self._all[1][:SAMPLES].mean())

    @cached_property
    def area(self) -> float:
        """Area [m²] of what can be touched."""
        return float(areas_of(self.corners).sum()) * len(self.even) / SAMPLES

    @cached_property
    def nearest(self) -> Surface:
        """Answers how far points are from it."""
        return Surface(self.corners, spread(self.corners, _DENSE), workers=self.cores)

    @cached_property
    def layer(self) -> Layer:
        """A thin layer on it, and what that encloses."""
        return Layer(self.corners, self.cores)

    @cached_property
    def volume(self) -> float:
        """What it encloses [m³]: exact for one closed body, by cells for anything else."""
        volume = self.surface.volume
        by_cells = self.flood.volume
        if self.surface.closed and volume > 0 and abs(volume - by_cells) < 0.1 * by_cells:
            return volume
        return by_cells


def _distances(target: Target, pieces: Sequence[Piece]) -> tuple[Points, Points]:
    """Measure how far a visual and some pieces are apart everywhere.

    Returns:
        How far [m] each touchable point of the visual is from the pieces, and how far each of
        their touchable points is from the visual.
    """
    outer = _outer_samples(pieces, target)
    points = np.concatenate([samples.points for samples in outer])
    collision = _surface_of(pieces, outer, target.cores)
    back = target.nearest.distance(points)
    if len(pieces) == 1 and pieces[0].is_primitive:
        forth = np.abs(primitives.signed_distance(pieces[0], target.touchable))
    else:
        forth = collision.distance(target.touchable)
    return forth, back


def measure(target: Target, pieces: Sequence[Piece]) -> Measures:
    """How good some pieces are for a visual."""
    forth, back = _distances(target, pieces)
    mean = (float(forth[: len(target.even)].mean()) + float(back.mean())) / 2
    depth = depths(target.even, pieces, near=MARGIN * target.size)
    volume = volume_of(pieces)
    return Measures(
        size=target.size,
        hausdorff=float(max(forth.max(), back.max())),
        mean=mean,
        visual_to_collision=float(forth.max()),
        collision_to_visual=float(back.max()),
        volume=volume,
        volume_ratio=volume / target.volume if target.volume > 0 else float("inf"),
        outside=float(np.mean(depth > MARGIN * target.size)),
        enclosed=target.enclosed,
        pieces=len(pieces),
        triangles=sum(len(piece.faces) for piece in pieces if not piece.is_primitive),
        vertices=sum(len(piece.vertices) for piece in pieces if not piece.is_primitive),
    )


def hull_error(target: Target, piece: Piece) -> float:
    """The error of a mesh's convex hull, which is what engines touch of a mesh that moves.

    Raises:
        MeshError: The mesh is flat.
    """
    return measure(target, [mesh_piece(*convex.hull(piece.vertices))]).error


def piece_distances(target: Target, pieces: Sequence[Piece]) -> list[float]:
    """How far [m] each piece's outer surface is from the visual at most."""
    outer = _outer_samples(pieces, target)
    off = target.nearest.distance(np.concatenate([samples.points for samples in outer]))
    parts = np.split(off, np.cumsum([len(samples) for samples in outer])[:-1])
    return [float(part.max(initial=0.0)) for part in parts]


def _outer_samples(pieces: Sequence[Piece], target: Target) -> list[Samples]:
    """Points on each piece that lie in no other and can be touched, if there are any such."""
    outer = [_outer(index, pieces, target) for index in range(len(pieces))]
    if not any(map(len, outer)):  # pieces that coincide hide each other
        outer = [spread(piece.corners, max(SAMPLES // len(pieces), 400)) for piece in pieces]
    if len(pieces) == 1:
        return outer
    # faces in narrow gaps between pieces are left out as those of the visual are
    around = flood(np.concatenate([piece.corners for piece in pieces]))
    seen = [samples.only(around.touches(samples.points)) for samples in outer]
    return seen if any(map(len, seen)) else outer


def _outer(index: int, pieces: Sequence[Piece], target: Target) -> Samples:
    """Points on a piece that lie in no other, and that can be touched."""
    piece = pieces[index]
    share = max(SAMPLES // len(pieces), 400)
    samples = spread(piece.corners, share)
    if piece.kind == "mesh":
        return samples.only(flood(piece.corners).touches(samples.points))
    others = _others(piece, pieces, _SEAM * target.size)
    if not others:
        return samples
    buried = depths(samples.points, others) < _SEAM * target.size
    return samples.only(~buried)


def _others(piece: Piece, pieces: Sequence[Piece], gap: float) -> list[Piece]:
    """The convex ones beside a piece in which points of it can lie."""
    near = near_ones(piece.bounds, np.stack([other.bounds for other in pieces]), gap)
    beside = (pieces[index] for index in np.flatnonzero(near).tolist())
    return [other for other in beside if other is not piece and other.kind != "mesh"]


def _surface_of(pieces: Sequence[Piece], outer: Sequence[Samples], workers: int) -> Surface:
    """The surface of all pieces, without what lies in another."""
    corners, points, owners = [], [], []
    first = 0
    for piece, seen in zip(pieces, outer, strict=True):
        triangles = piece.corners
        dense = spread(triangles, max(_DENSE // len(pieces), 800))
        alone = len(pieces) == 1
        if not alone and piece.kind != "mesh":
            others = _others(piece, pieces, 0.0)
            dense = dense.only(depths(dense.points, others) >= -1e-9) if others else dense
        corners.append(triangles)
        points += [dense.points, seen.points]
        owners += [dense.owners + first, seen.owners + first]
        first += len(triangles)
    samples = Samples(np.concatenate(points), np.concatenate(owners))
    return Surface(np.concatenate(corners), samples, workers=workers)


def depths(points: Points, pieces: Sequence[Piece], near: float = 0.0) -> Points:
    """How far points lie outside all pieces [m]; negative where they are in one.

    Exact in sign; near a convex piece's edges the distance is somewhat too small.

    Args:
        points: Points [m].
        pieces: The pieces.
        near: Distance [m] to a concave piece up to which the sign does not matter.
    """
    result = np.full(len(points), np.inf)
    for piece in pieces:
        result = np.minimum(result, _depth(points, piece, near))
    return result


def _depth(points: Points, piece: Piece, near: float) -> Points:
    if piece.is_primitive:
        return primitives.signed_distance(piece, points)
    if piece.kind == "convex":
        return convex.signed_distance(points, piece.sides)
    corners = piece.corners
    off = Surface(corners, spread(corners, SAMPLES)).distance(points)
    asked = off > near
    if asked.any():
        off[asked] *= np.where(_is_within(points[asked], corners), -1.0, 1.0)
    return off


def _is_within(points: Points, corners: Points) -> npt.NDArray[np.bool_]:
    return np.asarray(np.abs(winding_numbers(points, boxes_of(corners))) > 0.5)


def volume_of(pieces: Sequence[Piece]) -> float:
    """The volume [m³] of pieces together; exact for one, by points for several."""
    if len(pieces) == 1:
        a, b, c = (pieces[0].corners[:, k] - pieces[0].vertices.mean(axis=0) for k in range(3))
        return abs(float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6))
    low = np.min([piece.vertices.min(axis=0) for piece in pieces], axis=0)
    high = np.max([piece.vertices.max(axis=0) for piece in pieces], axis=0)
    points = spread_points(SAMPLES, low, high)
    inside = depths(points, pieces) < 0
    return float(np.prod(high - low) * inside.mean())
