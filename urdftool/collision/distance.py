"""Distances between surfaces, by points spread evenly over them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..meshes.mesh import Points

_GOLDEN = 1.324717957244746  # the real root of x³ = x + 1
_NEIGHBOURS = 6
_FEW = 24  # triangles all of which are tried
_COARSE = 1000  # triangles below which more neighbours are looked at


@dataclass(frozen=True, eq=False)
class Samples:
    """Points of a surface, and the triangle each lies on."""

    points: Points
    owners: npt.NDArray[np.int64]

    def __len__(self) -> int:
        """How many there are."""
        return len(self.points)

    def only(self, mask: npt.NDArray[np.bool_]) -> Samples:
        """Some of them."""
        return Samples(self.points[mask], self.owners[mask])


def areas_of(corners: Points) -> Points:
    """The area [m²] of each triangle."""
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(np.linalg.norm(crossed, axis=1) / 2)


def spread(corners: Points, count: int) -> Samples:
    """Points spread evenly by area, the same ones each time.

    A surface is walked in equal steps of area; the place within a triangle is Roberts' additive
    recurrence in two dimensions, folded into the triangle.

    Args:
        corners: Triangles [m], shape (m, 3, 3).
        count: How many points.
    """
    ends = np.cumsum(areas_of(corners))
    if not len(ends) or ends[-1] <= 0:
        return Samples(corners[:, 0].copy(), np.arange(len(corners)))
    marks = (np.arange(count) + 0.5) / count * ends[-1]
    owners = np.minimum(np.searchsorted(ends, marks), len(ends) - 1)
    numbers = np.arange(1, count + 1, dtype=np.float64)
    u = (0.5 + numbers / _GOLDEN) % 1.0
    v = (0.5 + numbers / _GOLDEN**2) % 1.0
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    first = corners[owners, 0]
    points = (
        first
        + u[:, None] * (corners[owners, 1] - first)
        + v[:, None] * (corners[owners, 2] - first)
    )
    return Samples(points, owners)


class Surface:
    """Triangles to which the distance of points is asked for."""

    def __init__(self, corners: Points, samples: Samples) -> None:
        """Keep a tree of points on the triangles.

        Args:
            corners: The triangles [m], shape (m, 3, 3).
            samples: Points on them, on average nearer to each other than any distance that counts.
        """
        from scipy.spatial import cKDTree

        self.corners = corners
        self.samples = samples
        self.tree = cKDTree(samples.points)

    def distance(self, points: Points) -> Points:
        """How far points are from the nearest triangle [m].

        Exact for the triangles of the samples nearest to a point; never too small.
        """
        if not len(points):
            return np.zeros(0)
        if len(self.corners) <= _FEW:
            each = [to_triangles(points, triangle[None]) for triangle in self.corners]
            return np.asarray(np.min(each, axis=0))
        wanted = _NEIGHBOURS * (2 if len(self.corners) < _COARSE else 1)
        near = min(wanted, len(self.samples))
        found, index = self.tree.query(points, k=near)
        if near == 1:
            found, index = found[:, None], index[:, None]
        index = np.minimum(index, len(self.samples) - 1)  # beyond: none is at a finite distance
        owners = self.samples.owners[index]
        pairs = np.repeat(points, near, axis=0)
        exact = to_triangles(pairs, self.corners[owners.reshape(-1)]).reshape(-1, near)
        return np.asarray(np.minimum(exact.min(axis=1), found[:, 0]))


def to_triangles(points: Points, corners: Points) -> Points:
    """The distance [m] of point i to triangle i (Ericson, "Real-Time Collision Detection", 5.1.5).

    The nearest point is within the triangle, or on one of its three edges.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    square = np.einsum("ij,ij->i", normal, normal)
    safe = np.where(square > 0, square, 1.0)
    to_point = points - a
    # barycentric coordinates of the foot on the plane
    v = np.einsum("ij,ij->i", np.cross(to_point, c - a), normal) / safe
    w = np.einsum("ij,ij->i", np.cross(b - a, to_point), normal) / safe
    inside = (v >= 0) & (w >= 0) & (v + w <= 1) & (square > 0)
    height = np.abs(np.einsum("ij,ij->i", to_point, normal)) / np.sqrt(safe)
    edges = np.minimum(
        np.minimum(_to_segments(points, a, b), _to_segments(points, b, c)),
        _to_segments(points, c, a),
    )
    return np.where(inside, height, np.sqrt(edges))


def _to_segments(points: Points, begin: Points, end: Points) -> Points:
    along = end - begin
    square = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", points - begin, along) / np.where(square > 0, square, 1.0)
    foot = points - begin - np.clip(share, 0, 1)[:, None] * along
    return np.asarray(np.einsum("ij,ij->i", foot, foot))
