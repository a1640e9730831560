"""Cover of a link's shapes by convex pieces.

A piece is the convex hull of points, inflated by a radius: it contains its part of the shape.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..geometry.hull import compute_convex_hull, extract_hull_surface
from ..geometry.mesh import Array, Faces, Points

THICKNESS = 1e-5
"""Thickness that flat pieces get on both sides [m]; it only enlarges them. Chosen, no source."""

_MEASURED = 1_000_000  # points times faces of a hull; chosen, no source

_STEPS = 30  # of the search for the nearest point of a hull; chosen, no source


@dataclass(frozen=True, eq=False)
class Piece:
    """Convex piece in the frame of its link.

    Attributes:
        points: Corners [m], shape (n, 3).
        faces: Triangles of the hull, shape (m, 3); empty for a point or a segment.
        inflation: Radius around the hull of the corners [m].
    """

    points: Points
    faces: Faces
    inflation: float = 0.0


@dataclass(frozen=True, eq=False)
class Cover:
    """Convex pieces of links that are fixed to each other, in the frame of their body.

    Attributes:
        pieces: The pieces.
        owner: Index of the link of each piece, shape (k,).
        centers: Centers of the bounding spheres [m], shape (k, 3).
        radii: Radii of the bounding spheres, with the inflation [m], shape (k,).
        inflation: Radius around the corners of each piece [m], shape (k,).
        solids: Geometry of FCL of each piece, made on first use.
        swept: What the pieces sweep about an axis, made on first use.
    """

    pieces: tuple[Piece, ...]
    owner: np.ndarray
    centers: Points
    radii: Array
    inflation: Array
    solids: dict[int, Any] = field(default_factory=dict)
    swept: dict[bytes, Cover] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of pieces."""
        return len(self.pieces)


def make_cover(pieces: Sequence[tuple[Piece, int]]) -> Cover:
    """Make a cover of pieces, each with the index of its link."""
    kept = tuple(piece for piece, _ in pieces)
    centers = np.array([(p.points.max(axis=0) + p.points.min(axis=0)) / 2 for p in kept])
    reach = [
        float(np.sqrt(((piece.points - center) ** 2).sum(axis=1)).max()) + piece.inflation
        for piece, center in zip(kept, centers, strict=True)
    ]
    inflation = np.array([piece.inflation for piece in kept])
    owner = np.array([link for _, link in pieces], dtype=np.int64)
    return Cover(kept, owner, centers.reshape(-1, 3), np.array(reach) + 1e-9, inflation)


def make_hull(points: Points, inflation: float = 0.0) -> Piece:
    """Make the hull of points; flat ones are thickened, so that they have a volume."""
    hull = compute_convex_hull(points)
    if hull is None:
        normal = _find_normal(points)
        points = np.concatenate([points + THICKNESS * normal, points - THICKNESS * normal])
        hull = compute_convex_hull(points)
    if hull is None:  # a line or a point
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        points = (points[:, None] + THICKNESS * signs).reshape(-1, 3)
        hull = compute_convex_hull(points)
    if hull is None:
        low, high = points.min(axis=0) - THICKNESS, points.max(axis=0) + THICKNESS
        points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
        hull = compute_convex_hull(low + points * (high - low))
        assert hull is not None
    return _bound_hull(points, hull, inflation)


def _bound_hull(points: Points, hull: Any, inflation: float) -> Piece:
    """Make a piece of a hull, inflated by what rounding has cut off its points.

    That is measured; for very many points, the bound of :func:`compute_convex_hull` times ten is
    taken.
    """
    corners, faces = extract_hull_surface(hull)
    extent = float(np.ptp(points, axis=0).max())
    if len(points) * len(faces) > _MEASURED:
        return Piece(corners, faces, inflation + 1e-6 * extent)
    points = _drop_repeated(points)
    a, b, c = corners[faces].swapaxes(0, 1)
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1)
    valid = length > 1e-14
    normals = normals[valid] / length[valid, None]
    tolerance = 1e-9 * extent
    outside = points @ normals.T > (normals * a[valid]).sum(axis=1) + tolerance
    lost = _bound_distance(points[outside.any(axis=1)], corners)
    return Piece(corners, faces, inflation + lost + 100 * tolerance)


def _drop_repeated(points: Points) -> Points:
    """Keep one of points with the same bytes: corners of triangles are six times as many."""
    rows = np.ascontiguousarray(points).view(np.dtype((np.void, points.itemsize * 3)))
    kept: Points = points[np.unique(rows.reshape(-1), return_index=True)[1]]
    return kept


def _bound_distance(points: Points, hull: Points) -> float:
    """Return an upper bound of the largest distance of points to the hull of others [m].

    The distance to any point of the hull is one; the conditional gradient method finds near ones.
    """
    if not len(points):
        return 0.0
    squared = ((points[:, None, :] - hull[None]) ** 2).sum(axis=2)
    near = hull[np.argmin(squared, axis=1)].copy()
    for _ in range(_STEPS):
        toward = points - near
        step = hull[np.argmax(toward @ hull.T, axis=1)] - near
        length = np.maximum((step * step).sum(axis=1), 1e-30)
        near += np.clip((toward * step).sum(axis=1) / length, 0.0, 1.0)[:, None] * step
    return float(np.sqrt(((points - near) ** 2).sum(axis=1)).max())


def _find_normal(points: Points) -> Array:
    """Return the unit direction in which points extend least."""
    if len(points) < 3:
        return np.array([0.0, 0.0, 1.0])
    centered = points - points.mean(axis=0)
    normal: Array = np.linalg.svd(centered, full_matrices=False)[2][-1]
    return normal


def split_triangles(corners: Points, pieces: int) -> list[Points]:
    """Split triangles into groups by the longest side of their centroids.

    Args:
        corners: Triangles [m], shape (n, 3, 3).
        pieces: Largest number of groups.

    Returns:
        The distinct points of each group.
    """
    groups, centers = [corners], [corners.mean(axis=1)]
    spans = [_measure_span(centers[0])]
    while len(groups) < pieces and max(spans) > 0:
        largest = int(np.argmax(spans))
        group, center = groups.pop(largest), centers.pop(largest)
        spans.pop(largest)
        axis = int(np.argmax(np.ptp(center, axis=0)))
        order = np.argsort(center[:, axis], kind="stable")
        for half in (order[: len(order) // 2], order[len(order) // 2 :]):
            groups.append(group[half])
            centers.append(center[half])
            spans.append(_measure_span(center[half]))
    return [np.unique(group.reshape(-1, 3), axis=0) for group in groups]


def _measure_span(centers: Points) -> float:
    return float(np.ptp(centers, axis=0).max()) if len(centers) > 1 else 0.0
