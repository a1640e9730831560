"""Convex hulls: exact, or with few vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..errors import MeshError
from ..geometry.mesh import Faces, Points
from .vec3 import compute_dot, compute_lengths, compute_normals

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

# chosen, no source, where a line gives none
_BATCH = 6  # points that are added to a hull in one step
_APART = 4.0  # their least distance, in multiples of that from the hull
_AT_ONCE = 200_000  # point-plane distances per block


def compute_hull(points: Points) -> tuple[Points, Faces]:
    """Compute the convex hull of points, with its triangles wound outward.

    Raises:
        MeshError: The points lie in a plane.
    """
    found = _run_qhull(points)
    seen = np.zeros(len(points), dtype=bool)
    seen[found.simplices] = True
    faces = (np.cumsum(seen) - 1)[found.simplices]
    vertices = points[seen]
    inwards = compute_dot(compute_normals(vertices[faces]), found.equations) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return vertices, faces[np.lexsort(faces.T[::-1])]


def _run_qhull(points: Points) -> ConvexHull:
    from scipy.spatial import ConvexHull, QhullError

    # Q12: nearly coplanar points may give facets wider than Qhull accepts by default
    for options in ("Qt", "Qt Q12 Pp"):
        try:
            return ConvexHull(points, qhull_options=options)
        except (QhullError, ValueError) as error:
            cause = error
    raise MeshError("the mesh is flat; it encloses no volume") from cause


def compute_capped_hull(points: Points, most: int, tolerance: float = 0.0) -> tuple[Points, Faces]:
    """Compute a convex hull of few of the points.

    Starting from extreme points, it repeatedly adds the point farthest outside, until no point is
    farther out than the tolerance, or the limit is reached.

    Args:
        points: Points [m].
        most: Largest number of vertices, at least 4.
        tolerance: Distance [m] by which points may stay outside.

    Raises:
        MeshError: The points lie in a plane.
    """
    outer, faces = compute_hull(points)
    if len(outer) <= min(most, 8):
        return outer, faces
    chosen = _select_first(outer, most)
    while True:
        vertices, faces = compute_hull(outer[chosen])
        beyond = measure_plane_distance(outer, compute_planes(vertices, faces))
        beyond[chosen] = -np.inf
        worst = float(beyond.max())
        if worst <= tolerance or len(chosen) >= most:
            return vertices, faces
        chosen += _select_farthest(outer, beyond, max(tolerance, worst / 2), most - len(chosen))


def _select_farthest(points: Points, beyond: Points, tolerance: float, most: int) -> list[int]:
    """Select the points that are farthest outside, and not next to each other."""
    found: list[int] = []
    left = np.flatnonzero(beyond > tolerance)
    left = left[np.argsort(-beyond[left], kind="stable")]
    while len(left) and len(found) < min(most, _BATCH):
        found.append(int(left[0]))
        distances = np.linalg.norm(points[left] - points[left[0]], axis=1)
        left = left[distances > _APART * beyond[left[0]]]
    return found or [int(np.argmax(beyond))]


def _select_first(outer: Points, most: int) -> list[int]:
    """Select at least four points that span a volume, including extremes along the axes."""
    chosen: list[int] = []
    start = int(np.argmax(np.linalg.norm(outer - outer.mean(axis=0), axis=1)))
    chosen.append(start)
    chosen.append(int(np.argmax(np.linalg.norm(outer - outer[start], axis=1))))
    along = outer[chosen[1]] - outer[start]
    along = along / np.linalg.norm(along)
    off = outer - outer[start]
    chosen.append(int(np.argmax(np.linalg.norm(off - np.outer(off @ along, along), axis=1))))
    normal = np.cross(along, outer[chosen[2]] - outer[start])
    chosen.append(int(np.argmax(np.abs(off @ normal))))
    for axis in np.eye(3):
        for sign in (1, -1):
            index = int(np.argmax(sign * (outer @ axis)))
            if index not in chosen and len(chosen) < most:
                chosen.append(index)
    return chosen


def compute_planes(vertices: Points, faces: Faces) -> Points:
    """Compute the planes of triangles: outward unit normal and offset, shape (m, 4).

    Triangles without area, and all but one of coplanar triangles, are dropped.
    """
    corners = vertices[faces]
    normal = compute_normals(corners)
    long = compute_lengths(normal)
    extent = float(np.ptp(vertices, axis=0).max())
    sound = long > 1e-12 * extent**2
    found = np.empty((np.count_nonzero(sound), 4))
    found[:, :3] = normal[sound] / long[sound, None]
    found[:, 3] = compute_dot(found, corners[sound, 0])
    scale = np.array([1, 1, 1, 1 / max(extent, 1e-300)])
    return found[_find_first_of_each(np.round(found * scale, 6))]


def _find_first_of_each(rows: Points) -> npt.NDArray[np.int64]:
    """Return the index of the first of each group of equal rows, shape (n, 4), ascending."""
    order = np.lexsort(rows.T)
    ordered = rows[order]
    new = np.ones(len(rows), dtype=bool)
    np.any(ordered[1:] != ordered[:-1], axis=1, out=new[1:])
    return np.sort(order[new])  # lexsort is stable


def measure_plane_distance(points: Points, sides: Points) -> Points:
    """Compute the largest signed distance [m] of points to planes; negative inside.

    For a convex shape it is the exact distance inside and near faces, and too small outside near
    edges.

    Args:
        points: Points [m].
        sides: Planes, from :func:`planes`.
    """
    result = np.empty(len(points))
    # the offset is a fourth coordinate; blocks fit the processor's cache
    step = max(1, _AT_ONCE // max(1, len(sides)))
    columns = np.concatenate([sides[:, :3], -sides[:, 3:]], axis=1).T.copy()
    whole = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    for begin in range(0, len(points), step):
        some = slice(begin, begin + step)
        result[some] = (whole[some] @ columns).max(axis=1)
    return result


def thicken(points: Points, thickness: float) -> Points:
    """Move copies of points [m] of a flat mesh to both sides of their plane, some [m] apart.

    Raises:
        MeshError: The points lie on a line.
    """
    middle = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - middle, full_matrices=False)
    if len(sizes) < 3 or sizes[1] <= 1e-9 * max(float(sizes[0]), 1e-300):
        raise MeshError("the mesh has no area; all of its points lie on one line")
    step = axes[2] * thickness / 2
    return np.concatenate([points + step, points - step])
