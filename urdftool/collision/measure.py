"""Quality of collision geometry: how far contact is off, volumes and counts.

Both surfaces are what a ball can touch that comes from outside (``exterior``). *Reach* is how far
the exterior of the visual is from contact: a point inside the collision from the part of its
surface that can be touched, a point outside from its surface. *Excess* is how far the collision
protrudes from the visual, where it does not only close gaps that the ball cannot enter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Points
from ..inertia.sampling import spread_points
from ..inertia.winding import compute_winding_numbers, sort_into_boxes
from . import convex, primitives
from .distance import Surface, add_corners, compute_areas, find_farthest, spread
from .exterior import COARSE, Exterior, flood
from .piece import Piece, make_mesh_piece
from .remesh import Layer
from .surface import Prepared

SAMPLES = 20_000
"""Evenly spread points of the visual whose distance to the collision is measured."""

MARGIN = 0.001
"""Depth, relative to the part's size, up to which a point counts as on a surface. Chosen, no
source."""

# chosen, no source, where a line gives none
_VISUAL_SAMPLES = 150_000  # to which distances are measured
_COLLISION_SAMPLES = 80_000  # from which distances are measured
_AVERAGED = 2000  # samples of the mean distance
_WORST = 200  # farthest samples that are kept


@dataclass(frozen=True)
class Measures:
    """Quality of collision geometry, compared with its visual; lengths are in meters."""

    size: float
    """Diagonal of the visual's bounding box, to which ``error`` is relative."""
    hausdorff: float
    """Larger one of ``visual_to_collision`` and ``collision_to_visual``."""
    mean: float
    """Mean distance of both directions."""
    visual_to_collision: float
    """Reach: largest distance of an exterior point of the visual to where contact is made."""
    collision_to_visual: float
    """Excess: largest distance by which the collision protrudes from the visual."""
    buried: float
    """Reach of the points of the visual inside the collision."""
    uncovered: float
    """Reach of the points of the visual outside the collision."""
    volume: float
    """Volume of the collision [m³]; overlapping space counts once."""
    volume_ratio: float
    """Volume of the collision divided by that of the visual, whose interior counts."""
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
        """Return the larger one of reach and excess, relative to the size."""
        return self.hausdorff / self.size

    def as_dict(self) -> dict[str, Any]:
        """Return all fields, and error, reach and excess relative to the size."""
        return {
            "error": self.error,
            "reach": self.visual_to_collision / self.size,
            "excess": self.collision_to_visual / self.size,
            **asdict(self),
        }


class ReferenceSurface:
    """Surface of a visual, with cached data for measuring collisions against it."""

    def __init__(self, surface: Prepared, cores: int = 1, cell: float = COARSE) -> None:
        """Store the surface; everything else is computed on demand.

        A cell of the flood is relative to the size; ``cores`` do not affect results.
        """
        self.surface = surface
        self.cores = cores
        self.cell = cell
        self.size = surface.size
        self.longest = float(np.ptp(surface.vertices, axis=0).max())

    @cached_property
    def corners(self) -> Points:
        """Return the triangles [m], shape (m, 3, 3)."""
        return self.surface.corners

    @cached_property
    def exterior(self) -> Exterior:
        """Return the flooded space around the surface."""
        return flood(self.corners, self.size, self.cell)

    @cached_property
    def _samples(self) -> tuple[Points, npt.NDArray[np.bool_]]:
        points = spread(self.corners, SAMPLES).points
        ends = self.surface.vertices
        ends = ends[:: max(1, len(ends) // SAMPLES)]
        both = np.concatenate([points, ends])
        return both, self.exterior.is_touchable(both)

    @cached_property
    def exterior_samples(self) -> Points:
        """Return exterior points [m]: evenly spread ones, then vertices."""
        points, reached = self._samples
        return points[reached] if reached.any() else points

    @cached_property
    def uniform_samples(self) -> Points:
        """Return the evenly spread exterior points [m], which come first in the others."""
        points, reached = self._samples
        even = points[:SAMPLES][reached[:SAMPLES]]
        return even if len(even) else points[:SAMPLES]

    @cached_property
    def enclosed(self) -> float:
        """Return the part of the area that is enclosed."""
        return float(1 - self._samples[1][:SAMPLES].mean())

    @cached_property
    def nearest(self) -> Surface:
        """Return the search structure for distances to the exterior surface."""
        dense = spread(self.corners, _VISUAL_SAMPLES)
        step = float(np.sqrt(compute_areas(self.corners).sum() / len(dense)))
        if len(self.corners) < _VISUAL_SAMPLES // 3:
            dense = add_corners(dense, self.corners)
        reached = self.exterior.is_touchable(dense.points)
        dense = dense.select(reached) if reached.any() else dense
        return Surface(self.corners, dense, workers=self.cores, step=step)

    @cached_property
    def layer(self) -> Layer:
        """Return the offset field of a thin layer around the surface."""
        return Layer(self.corners, self.cores)

    @cached_property
    def volume(self) -> float:
        """Return the volume [m³] of the closing: exact for a solid, by cells otherwise."""
        volume = self.surface.volume
        by_cells = self.exterior.volume
        if self.surface.closed and volume > 0 and abs(volume - by_cells) < 0.05 * by_cells:
            return volume
        return by_cells


@dataclass(frozen=True, eq=False)
class Deviation:
    """Distances of two surfaces, and the points of the visual where they are largest.

    Attributes:
        buried: Reach [m] inside the collision.
        uncovered: Reach [m] outside the collision.
        excess: Excess [m].
        mean: Mean distance [m] of both directions.
        worst: Points [m] of the visual that are deepest in the collision.
        depth: Reach [m] of those points.
    """

    buried: float
    uncovered: float
    excess: float
    mean: float
    worst: Points
    depth: Points


def measure(target: ReferenceSurface, pieces: Sequence[Piece]) -> Measures:
    """Measure the quality of pieces as the collision of a visual."""
    return measure_and_locate(target, pieces)[0]


def measure_and_locate(
    target: ReferenceSurface, pieces: Sequence[Piece]
) -> tuple[Measures, Deviation]:
    """Measure the quality of pieces, and find where the visual is farthest from contact."""
    depth = compute_depths(target.exterior_samples, pieces, near=MARGIN * target.size)
    found = _measure_deviation(target, pieces, depth)
    reach = max(found.buried, found.uncovered)
    volume = compute_volume(pieces)
    even = depth[: len(target.uniform_samples)]
    measures = Measures(
        size=target.size,
        hausdorff=max(reach, found.excess),
        mean=found.mean,
        visual_to_collision=reach,
        collision_to_visual=found.excess,
        buried=found.buried,
        uncovered=found.uncovered,
        volume=volume,
        volume_ratio=volume / target.volume if target.volume > 0 else float("inf"),
        outside=float(np.mean(even > MARGIN * target.size)),
        enclosed=target.enclosed,
        pieces=len(pieces),
        triangles=sum(len(piece.faces) for piece in pieces if not piece.is_primitive),
        vertices=sum(len(piece.vertices) for piece in pieces if not piece.is_primitive),
    )
    return measures, found


def compute_hull_error(target: ReferenceSurface, piece: Piece) -> float:
    """Compute the relative error of a mesh's convex hull, which engines use for moving meshes.

    Raises:
        MeshError: The mesh is flat.
    """
    return measure(target, [make_mesh_piece(*convex.compute_hull(piece.vertices))]).error


def compute_excess_of_each(target: ReferenceSurface, pieces: Sequence[Piece]) -> list[float]:
    """Compute the largest distance [m] by which each piece protrudes from the visual."""
    found = []
    for piece in pieces:
        points = spread(piece.corners, max(SAMPLES // len(pieces), 400)).points
        points = np.concatenate([points, piece.vertices])
        protruding = points[target.exterior.interpolate(target.exterior.depth, points) < 0]
        found.append(find_farthest(target.nearest, protruding)[0])
    return found


def _measure_deviation(
    target: ReferenceSurface, pieces: Sequence[Piece], depth: Points
) -> Deviation:
    """Measure distances, given the signed distance of the visual's points to the pieces."""
    points = target.exterior_samples
    collision, touchable, samples = _sample_surfaces(pieces, target)
    inside = depth < 0
    if len(pieces) == 1 and pieces[0].kind != "mesh":
        off = -depth[inside]  # exact inside a convex shape
        order = np.argsort(-off)[:_WORST]
        deepest = float(off.max(initial=0.0)), points[inside][order], off[order]
    else:
        deepest = find_farthest(touchable, points[inside], _WORST)
    if len(pieces) == 1 and pieces[0].is_primitive:
        off = depth[~inside]
        farthest = float(off.max(initial=0.0))
    else:
        farthest = find_farthest(collision, points[~inside])[0]
    protruding = samples[target.exterior.interpolate(target.exterior.depth, samples) < 0]
    excess = find_farthest(target.nearest, protruding, 1)[0]
    mean = _compute_mean(target, collision, touchable, samples, inside)
    return Deviation(deepest[0], farthest, excess, mean, deepest[1], deepest[2])


def _compute_mean(
    target: ReferenceSurface,
    collision: Surface,
    touchable: Surface,
    samples: Points,
    inside: npt.NDArray[np.bool_],
) -> float:
    """Compute the mean distance [m] of both directions, from a part of the points."""
    count = len(target.uniform_samples)
    step = max(1, count // _AVERAGED)
    points, within = target.uniform_samples[::step], inside[:count:step]
    forth = np.concatenate(
        [touchable.measure_distance(points[within]), collision.measure_distance(points[~within])]
    )
    back = target.nearest.measure_distance(samples[:: max(1, len(samples) // _AVERAGED)])
    return float(forth.mean() + back.mean()) / 2


def _sample_surfaces(
    pieces: Sequence[Piece], target: ReferenceSurface
) -> tuple[Surface, Surface, Points]:
    """Sample the surfaces of pieces.

    Returns:
        Search structures of all of it, and of what the ball can touch, and points [m] of the
        latter: evenly spread ones, then vertices.
    """
    corners = np.concatenate([piece.corners for piece in pieces])
    step = float(np.sqrt(compute_areas(corners).sum() / _COLLISION_SAMPLES))
    dense = add_corners(spread(corners, _COLLISION_SAMPLES), corners)
    whole = Surface(corners, dense, workers=target.cores, step=step)
    if len(pieces) == 1 and pieces[0].kind != "mesh":
        return whole, whole, dense.points
    reached = flood(corners, target.size, target.cell).is_touchable(dense.points)
    if not reached.any():
        return whole, whole, dense.points
    seen = dense.select(reached)
    return whole, Surface(corners, seen, workers=target.cores, step=step), seen.points


def compute_depths(points: Points, pieces: Sequence[Piece], near: float = 0.0) -> Points:
    """Compute the signed distance [m] of points to the union of pieces; negative inside.

    The sign is exact; near edges of a convex piece the distance is slightly too small.

    Args:
        points: Points [m].
        pieces: The pieces.
        near: Distance [m] to a concave piece below which the sign is not computed.
    """
    result = np.full(len(points), np.inf)
    for piece in pieces:
        result = np.minimum(result, _compute_depth(points, piece, near))
    return result


def _compute_depth(points: Points, piece: Piece, near: float) -> Points:
    if piece.is_primitive:
        return primitives.measure_primitive_distance(piece, points)
    if piece.kind == "convex":
        return convex.measure_plane_distance(points, piece.sides)
    corners = piece.corners
    off = Surface(corners, spread(corners, SAMPLES)).measure_distance(points)
    is_outside = off > near
    if is_outside.any():
        off[is_outside] *= np.where(_is_within(points[is_outside], corners), -1.0, 1.0)
    return off


def _is_within(points: Points, corners: Points) -> npt.NDArray[np.bool_]:
    return np.asarray(np.abs(compute_winding_numbers(points, sort_into_boxes(corners))) > 0.5)


def compute_volume(pieces: Sequence[Piece]) -> float:
    """Compute the volume [m³] of the union of pieces; exact for one, sampled for several."""
    if len(pieces) == 1:
        a, b, c = (pieces[0].corners[:, k] - pieces[0].vertices.mean(axis=0) for k in range(3))
        return abs(float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6))
    low = np.min([piece.vertices.min(axis=0) for piece in pieces], axis=0)
    high = np.max([piece.vertices.max(axis=0) for piece in pieces], axis=0)
    points = spread_points(SAMPLES, low, high)
    inside = compute_depths(points, pieces) < 0
    return float(np.prod(high - low) * inside.mean())
