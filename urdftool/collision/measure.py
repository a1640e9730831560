"""Quality of collision geometry: distances, volumes and counts."""

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
"""Sampled points on each surface for measuring distances."""

MARGIN = 0.001
"""Depth, relative to the part's size, up to which a point counts as on a surface."""

_DENSE = 80_000
_SEAM = 0.004  # gaps between adjacent pieces of a cut are smaller than this, relative to the size


@dataclass(frozen=True)
class Measures:
    """Quality of collision geometry, compared with its visual.

    Distances are two-sided, between the exterior surfaces: enclosed surfaces of the visual, and
    faces of a piece inside another, are ignored.
    """

    size: float
    """Diagonal of the visual's bounding box [m], to which ``error`` is relative."""
    hausdorff: float
    """Largest distance [m] from a point of either surface to the other."""
    mean: float
    """Mean distance [m] of both directions."""
    visual_to_collision: float
    """Largest distance [m] from the visual to the collision."""
    collision_to_visual: float
    """Largest distance [m] from the collision to the visual."""
    volume: float
    """Volume [m³] of the collision; overlapping space counts once."""
    volume_ratio: float
    """Volume of the collision divided by the visual's."""
    outside: float
    """Part of the visual's exterior area that is outside the collision by over 0.1 % of the
    size."""
    enclosed: float
    """Part of the visual's area that is enclosed and was not measured."""
    pieces: int
    triangles: int
    vertices: int

    @property
    def error(self) -> float:
        """Return the Hausdorff distance relative to the size."""
        return self.hausdorff / self.size

    def as_dict(self) -> dict[str, Any]:
        """Return all fields and the relative error."""
        return {"error": self.error, **asdict(self)}


class Target:
    """Reference surface of a visual, with cached data for measuring collisions against it."""

    def __init__(self, surface: Prepared, cores: int = 1) -> None:
        """Store the surface; everything else is computed on demand.

        Args:
            surface: The visual.
            cores: Number of cores to use, which does not affect results.
        """
        self.surface = surface
        self.cores = cores
        self.size = surface.size
        self.longest = float(np.ptp(surface.vertices, axis=0).max())

    @cached_property
    def corners(self) -> Points:
        """Return the triangles [m], shape (m, 3, 3)."""
        return self.surface.corners

    @cached_property
    def flood(self) -> Flood:
        """Return the flooded space around the surface."""
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
        """Return exterior points [m]: evenly spread ones, then vertices."""
        points, reached = self._all
        return points[reached] if reached.any() else points

    @cached_property
    def even(self) -> Points:
        """Return the evenly spread exterior points [m]."""
        points, reached = self._all
        even = points[:SAMPLES][reached[:SAMPLES]]
        return even if len(even) else points[:SAMPLES]

    @cached_property
    def enclosed(self) -> float:
        """Return the part of the area that is enclosed."""
        return float(1 - self._all[1][:SAMPLES].mean())

    @cached_property
    def area(self) -> float:
        """Return the exterior area [m²]."""
        return float(areas_of(self.corners).sum()) * len(self.even) / SAMPLES

    @cached_property
    def nearest(self) -> Surface:
        """Return the search structure for distances to the surface."""
        return Surface(self.corners, spread(self.corners, _DENSE), workers=self.cores)

    @cached_property
    def layer(self) -> Layer:
        """Return the offset field of a thin layer around the surface."""
        return Layer(self.corners, self.cores)

    @cached_property
    def volume(self) -> float:
        """Return the enclosed volume [m³]: exact for one closed body, from cells otherwise."""
        volume = self.surface.volume
        by_cells = self.flood.volume
        if self.surface.closed and volume > 0 and abs(volume - by_cells) < 0.1 * by_cells:
            return volume
        return by_cells


def _distances(target: Target, pieces: Sequence[Piece]) -> tuple[Points, Points]:
    """Compute the distances between a visual and pieces.

    Returns:
        Distance [m] of each exterior point of the visual to the pieces, and of each of their
        exterior points to the visual.
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
    """Measure the quality of pieces as the collision of a visual."""
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
    """Compute the relative error of a mesh's convex hull, which engines use for moving meshes.

    Raises:
        MeshError: The mesh is flat.
    """
    return measure(target, [mesh_piece(*convex.hull(piece.vertices))]).error


def piece_distances(target: Target, pieces: Sequence[Piece]) -> list[float]:
    """Compute the largest distance [m] of each piece's exterior surface to the visual."""
    outer = _outer_samples(pieces, target)
    off = target.nearest.distance(np.concatenate([samples.points for samples in outer]))
    parts = np.split(off, np.cumsum([len(samples) for samples in outer])[:-1])
    return [float(part.max(initial=0.0)) for part in parts]


def _outer_samples(pieces: Sequence[Piece], target: Target) -> list[Samples]:
    """Sample exterior points of each piece that are inside no other, if there are any."""
    outer = [_outer(index, pieces, target) for index in range(len(pieces))]
    if not any(map(len, outer)):  # coincident pieces hide each other
        outer = [spread(piece.corners, max(SAMPLES // len(pieces), 400)) for piece in pieces]
    if len(pieces) == 1:
        return outer
    # faces in narrow gaps between pieces are enclosed, as for the visual
    around = flood(np.concatenate([piece.corners for piece in pieces]))
    seen = [samples.only(around.touches(samples.points)) for samples in outer]
    return seen if any(map(len, seen)) else outer


def _outer(index: int, pieces: Sequence[Piece], target: Target) -> Samples:
    """Sample exterior points of a piece that are inside no other."""
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
    """Return the other convex pieces that may contain points of a piece."""
    near = near_ones(piece.bounds, np.stack([other.bounds for other in pieces]), gap)
    beside = (pieces[index] for index in np.flatnonzero(near).tolist())
    return [other for other in beside if other is not piece and other.kind != "mesh"]


def _surface_of(pieces: Sequence[Piece], outer: Sequence[Samples], workers: int) -> Surface:
    """Build the union surface of pieces, without parts inside other pieces."""
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
    """Compute the signed distance [m] of points to the union of pieces; negative inside.

    The sign is exact; near edges of a convex piece the distance is slightly too small.

    Args:
        points: Points [m].
        pieces: The pieces.
        near: Distance [m] to a concave piece below which the sign is not computed.
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
    """Compute the volume [m³] of the union of pieces; exact for one, sampled for several."""
    if len(pieces) == 1:
        a, b, c = (pieces[0].corners[:, k] - pieces[0].vertices.mean(axis=0) for k in range(3))
        return abs(float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6))
    low = np.min([piece.vertices.min(axis=0) for piece in pieces], axis=0)
    high = np.max([piece.vertices.max(axis=0) for piece in pieces], axis=0)
    points = spread_points(SAMPLES, low, high)
    inside = depths(points, pieces) < 0
    return float(np.prod(high - low) * inside.mean())
