"""Generalized winding numbers: the solid angle of a surface at a point, divided by 4π.

Inside a closed surface the number is 1, outside 0. Where surfaces overlap it counts them, and
across a hole it changes smoothly, so that "above one half" is a sensible inside test for open
surfaces, too (Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using
Generalized Winding Numbers", 2013).

The solid angle of a triangle follows van Oosterom and Strackee ("The Solid Angle of a Plane
Triangle", 1983). Distant triangles are approximated by one dipole, as in Barill et al., "Fast
Winding Numbers for Soups and Clouds", 2018, but with one level of boxes instead of a tree, which
suits array operations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Array

FAR = 1.8
"""Distance, in radii of a box of triangles, beyond which they are one dipole."""

_PAIRS_AT_ONCE = 400_000

_DENSE = 60_000
"""Points times boxes per block: fits the cache and is too small for BLAS to start threads."""


@dataclass(frozen=True, eq=False)
class Boxes:
    """Triangles sorted into boxes, each with its dipole."""

    corners: Array
    """Triangles [m] in the order of the boxes, shape (m, 3, 3)."""
    starts: npt.NDArray[np.int64]
    """First triangle of each box, followed by the number of triangles."""
    area: Array
    """Sum of the area vectors [m²] of each box, shape (k, 3)."""
    middle: Array
    """Area-weighted center [m] of each box's triangles, shape (k, 3)."""
    radius: Array
    """Distance [m] from that center to the farthest corner."""


def sort_into_boxes(corners: Array) -> Boxes:
    """Sort triangles [m], shape (m, 3, 3), into boxes of a grid, about a dozen in each."""
    centers = corners.mean(axis=1)
    low = corners.reshape(-1, 3).min(axis=0)
    extent = np.ptp(corners.reshape(-1, 3), axis=0)
    # a surface intersects about 3 n² of the n³ cells of a cube's grid
    side = max(float(extent.max()), 1e-300) / max(1.0, (16 * len(corners) ** 0.5 / 3) ** 0.5)
    cells = np.floor((centers - low) / side).astype(np.int64)
    shape = cells.max(axis=0) + 1
    key = (cells[:, 0] * shape[1] + cells[:, 1]) * shape[2] + cells[:, 2]
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(key[order]) != 0])
    ordered = corners[order]
    vectors = np.cross(ordered[:, 1] - ordered[:, 0], ordered[:, 2] - ordered[:, 0]) / 2
    weights = np.linalg.norm(vectors, axis=1) + 1e-300
    total = np.add.reduceat(weights, starts)
    middle = np.add.reduceat(weights[:, None] * centers[order], starts) / total[:, None]
    count = np.diff(np.r_[starts, len(corners)])
    reach = np.linalg.norm(ordered - np.repeat(middle, count, axis=0)[:, None], axis=2).max(axis=1)
    return Boxes(
        ordered,
        np.r_[starts, len(corners)],
        np.add.reduceat(vectors, starts),
        middle,
        np.maximum.reduceat(reach, starts),
    )


def compute_winding_numbers(points: Array, boxes: Boxes) -> Array:
    """Compute the generalized winding number of the surface at each point, to about 0.01.

    Args:
        points: Points [m], shape (n, 3).
        boxes: The surface, from ``sort_into_boxes``.
    """
    result = np.empty(len(points))
    step = max(1, _DENSE // max(1, len(boxes.radius)))
    for begin in range(0, len(points), step):
        result[begin : begin + step] = _compute_chunk(points[begin : begin + step], boxes)
    return result / (4 * np.pi)


def compute_solid_angles(points: Array, corners: Array) -> Array:
    """Compute the signed solid angle [sr] of triangle i at point i; positive from behind it.

    Args:
        points: Points [m], shape (n, 3).
        corners: Triangles [m], shape (n, 3, 3).
    """
    a, b, c = (corners[:, k] - points for k in range(3))
    la, lb, lc = (np.sqrt(np.einsum("ij,ij->i", v, v)) for v in (a, b, c))
    above = (
        a[:, 0] * (b[:, 1] * c[:, 2] - b[:, 2] * c[:, 1])
        + a[:, 1] * (b[:, 2] * c[:, 0] - b[:, 0] * c[:, 2])
        + a[:, 2] * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    )
    below = (
        la * lb * lc
        + np.einsum("ij,ij->i", a, b) * lc
        + np.einsum("ij,ij->i", b, c) * la
        + np.einsum("ij,ij->i", c, a) * lb
    )
    return np.asarray(2 * np.arctan2(above, below))


def _compute_chunk(points: Array, boxes: Boxes) -> Array:
    square = (
        np.einsum("ij,ij->i", points, points)[:, None]
        + np.einsum("ij,ij->i", boxes.middle, boxes.middle)
        - 2 * points @ boxes.middle.T
    )
    near = square <= (FAR * boxes.radius) ** 2
    flux = np.einsum("ij,ij->i", boxes.area, boxes.middle) - points @ boxes.area.T
    square[near] = 1.0
    flux[near] = 0.0
    result: Array = (flux / (square * np.sqrt(square))).sum(axis=1)
    which, box = np.nonzero(near)
    sizes = np.diff(boxes.starts)[box]
    ends = np.cumsum(sizes)
    begin = 0
    while begin < len(box):
        done = ends[begin - 1] if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + _PAIRS_AT_ONCE)))
        some = sizes[begin:stop]
        point = np.repeat(which[begin:stop], some)
        first = np.repeat(boxes.starts[box[begin:stop]] - (np.cumsum(some) - some), some)
        triangle = first + np.arange(len(point))
        angles = compute_solid_angles(points[point], boxes.corners[triangle])
        result += np.bincount(point, weights=angles, minlength=len(points))
        begin = stop
    return result
