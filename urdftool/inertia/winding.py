"""Generalized winding numbers: the solid angle of a surface at a point, divided by 4π.

Inside a closed surface the number is 1, outside 0. Where surfaces overlap it counts them, and
across a hole it changes smoothly, so that "above one half" is a sensible inside test for open
surfaces, too (Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using
Generalized Winding Numbers", 2013).

The solid angle of a triangle follows van Oosterom and Strackee ("The Solid Angle of a Plane
Triangle", 1983). Distant triangles are approximated by one dipole, as in Barill et al., "Fast
Winding Numbers for Soups and Clouds", 2018, but with one or two levels of boxes instead of a tree,
which suits array operations.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Array

FAR, GROUP_FAR = 1.8, 3.0
"""Distance, in radii of a box of triangles or a group of boxes, beyond which it is one dipole.
Chosen, no source.
"""

_MANY = 4096
"""Boxes from which they are grouped."""

_SIDE = 6
"""Edge of a group in edges of a box. Chosen, no source."""

_PAIRS_AT_ONCE = 400_000
"""Pairs of points and boxes per block, which bounds the memory. Chosen, no source."""

_DENSE = 60_000
"""Points times boxes per block: fits the cache and is too small for BLAS to start threads."""


@dataclass(frozen=True, eq=False)
class Dipoles:
    """Boxes of triangles, or groups of boxes, each with its dipole."""

    starts: npt.NDArray[np.int64]
    """First member of each, followed by the number of members."""
    area: Array
    """Sum of the area vectors [m²] of each, shape (k, 3)."""
    middle: Array
    """Area-weighted center [m] of each one's triangles, shape (k, 3)."""
    radius: Array
    """Distance [m] from that center within which the triangles are."""


@dataclass(frozen=True, eq=False)
class Boxes:
    """Triangles sorted into boxes, and the boxes into groups if there are many."""

    corners: Array
    """Triangles [m] in the order of the boxes, shape (m, 3, 3)."""
    boxes: Dipoles
    groups: Dipoles | None


def sort_into_boxes(corners: Array) -> Boxes:
    """Sort triangles [m], shape (m, 3, 3), into boxes of a grid, about a dozen in each."""
    centers = corners.mean(axis=1)
    low = corners.reshape(-1, 3).min(axis=0)
    extent = np.ptp(corners.reshape(-1, 3), axis=0)
    # a surface intersects about 3 n² of the n³ cells of a cube's grid
    side = max(float(extent.max()), 1e-300) / max(1.0, (16 * len(corners) ** 0.5 / 3) ** 0.5)
    cells = np.floor((centers - low) / side).astype(np.int64)
    shape = cells.max(axis=0) + 1
    key, coarse = _compute_keys(cells, shape), _compute_keys(cells // _SIDE, shape)
    order = np.argsort(key, kind="stable")
    many = np.count_nonzero(np.diff(key[order])) >= _MANY
    if many:
        order = np.lexsort((key, coarse))
    starts = np.flatnonzero(np.r_[True, np.diff(key[order]) != 0])
    ordered, centers = corners[order], centers[order]
    vectors = np.cross(ordered[:, 1] - ordered[:, 0], ordered[:, 2] - ordered[:, 0]) / 2
    weights = np.linalg.norm(vectors, axis=1) + 1e-300
    middle, total = _average(centers, weights, starts)
    count = np.diff(np.r_[starts, len(corners)])
    reach = np.linalg.norm(ordered - np.repeat(middle, count, axis=0)[:, None], axis=2).max(axis=1)
    boxes = Dipoles(
        np.r_[starts, len(corners)],
        np.add.reduceat(vectors, starts),
        middle,
        np.maximum.reduceat(reach, starts),
    )
    groups = _group_boxes(boxes, total, coarse[order][starts]) if many else None
    return Boxes(ordered, boxes, groups)


def _compute_keys(
    cells: npt.NDArray[np.int64], shape: npt.NDArray[np.int64]
) -> npt.NDArray[np.int64]:
    return np.asarray((cells[:, 0] * shape[1] + cells[:, 1]) * shape[2] + cells[:, 2])


def _average(points: Array, weights: Array, starts: npt.NDArray[np.int64]) -> tuple[Array, Array]:
    """Return the weighted mean of each run of points, and the sum of its weights."""
    total = np.add.reduceat(weights, starts)
    return np.add.reduceat(weights[:, None] * points, starts) / total[:, None], total


def _group_boxes(boxes: Dipoles, weights: Array, keys: npt.NDArray[np.int64]) -> Dipoles:
    """Group boxes with equal keys, which are next to each other."""
    starts = np.flatnonzero(np.r_[True, np.diff(keys) != 0])
    middle, _ = _average(boxes.middle, weights, starts)
    ends = np.r_[starts, len(keys)]
    off = boxes.middle - np.repeat(middle, np.diff(ends), axis=0)
    reach = np.linalg.norm(off, axis=1) + boxes.radius
    return Dipoles(
        ends, np.add.reduceat(boxes.area, starts), middle, np.maximum.reduceat(reach, starts)
    )


def compute_winding_numbers(points: Array, boxes: Boxes) -> Array:
    """Compute the generalized winding number of the surface at each point, to about 0.01.

    Args:
        points: Points [m], shape (n, 3).
        boxes: The surface, from ``sort_into_boxes``.
    """
    result = np.empty(len(points))
    dense = boxes.groups or boxes.boxes
    step = max(1, _DENSE // max(1, len(dense.radius)))
    for begin in range(0, len(points), step):
        result[begin : begin + step] = _compute_chunk(points[begin : begin + step], boxes)
    return result / (4 * np.pi)


def count_direct_triangles(points: Array, boxes: Boxes) -> float:
    """Count the triangles near a point, whose solid angles are computed, on average of the points.

    Args:
        points: A few points [m], shape (n, 3).
        boxes: The surface, from ``sort_into_boxes``.
    """
    each = boxes.boxes
    off = np.linalg.norm(points[:, None] - each.middle, axis=2)
    return float(((off <= FAR * each.radius) @ np.diff(each.starts)).mean())


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


def _compute_chunk(points: Array, surface: Boxes) -> Array:
    """Compute the solid angle [sr] of a surface at few points."""
    dense = surface.groups or surface.boxes
    square = (
        np.einsum("ij,ij->i", points, points)[:, None]
        + np.einsum("ij,ij->i", dense.middle, dense.middle)
        - 2 * points @ dense.middle.T
    )
    near = square <= ((GROUP_FAR if surface.groups else FAR) * dense.radius) ** 2
    flux = np.einsum("ij,ij->i", dense.area, dense.middle) - points @ dense.area.T
    square[near] = 1.0
    flux[near] = 0.0
    result: Array = (flux / (square * np.sqrt(square))).sum(axis=1)
    which, owner = np.nonzero(near)
    if surface.groups is None:
        return result + _sum_triangles(points, which, owner, surface)
    for some in _list_blocks(np.diff(surface.groups.starts)[owner]):
        result += _sum_boxes(points, which[some], owner[some], surface)
    return result


def _sum_boxes(
    points: Array, which: npt.NDArray[np.int64], group: npt.NDArray[np.int64], surface: Boxes
) -> Array:
    """Sum the solid angles [sr] of groups of boxes at points, given as pairs of indices."""
    assert surface.groups is not None
    boxes = surface.boxes
    point, box = _expand(which, group, surface.groups.starts)
    off = boxes.middle[box] - points[point]
    square = np.einsum("ij,ij->i", off, off)
    near = square <= (FAR * boxes.radius[box]) ** 2
    flux = np.einsum("ij,ij->i", boxes.area[box], off)[~near]
    angles = flux / (square[~near] * np.sqrt(square[~near]))
    result = np.bincount(point[~near], weights=angles, minlength=len(points))
    return np.asarray(result + _sum_triangles(points, point[near], box[near], surface))


def _sum_triangles(
    points: Array, which: npt.NDArray[np.int64], box: npt.NDArray[np.int64], surface: Boxes
) -> Array:
    """Sum the solid angles [sr] of boxes of triangles at points, given as pairs of indices."""
    result = np.zeros(len(points))
    for some in _list_blocks(np.diff(surface.boxes.starts)[box]):
        point, triangle = _expand(which[some], box[some], surface.boxes.starts)
        angles = compute_solid_angles(points[point], surface.corners[triangle])
        result += np.bincount(point, weights=angles, minlength=len(points))
    return result


def _list_blocks(sizes: npt.NDArray[np.int64]) -> Iterator[slice]:
    """Yield slices of pairs, in which few members are."""
    ends = np.cumsum(sizes)
    begin = 0
    while begin < len(sizes):
        done = ends[begin - 1] if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + _PAIRS_AT_ONCE)))
        yield slice(begin, stop)
        begin = stop


def _expand(
    which: npt.NDArray[np.int64], owner: npt.NDArray[np.int64], starts: npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Replace each pair of a point and a box, or group, by pairs of the point and a member."""
    sizes = np.diff(starts)[owner]
    first = np.repeat(starts[owner] - (np.cumsum(sizes) - sizes), sizes)
    return np.repeat(which, sizes), first + np.arange(int(sizes.sum()))
