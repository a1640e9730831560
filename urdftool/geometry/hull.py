"""Convex hulls by Manifold, which imports in milliseconds (scipy takes a third of a second)."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from .mesh import Faces, Points

if TYPE_CHECKING:
    from manifold3d import Manifold

FLAT = 1e-12
"""Smallest volume of a hull, relative to the cube of the extent of its points. Chosen, no source.
"""


_MANY = 20_000
"""Number of points from which Manifold starts its threads; 12,000 were enough in Manifold 3.5."""


def load_manifold() -> Any:
    """Import ``Manifold``, without threads on Linux.

    It would start one for each core (TBB). A process forked while one of them falls asleep waits
    for it without end, and urdftool computes with forked processes. TBB starts as many threads as
    the process may use cores when it is first used.
    """
    if "manifold3d" in sys.modules or sys.platform != "linux":
        from manifold3d import Manifold

        return Manifold
    from manifold3d import Manifold

    allowed = {thread: os.sched_getaffinity(thread) for thread in (0, os.getpid())}
    points = np.zeros((_MANY, 3))
    points[:4, :] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    try:
        for thread, cores in allowed.items():  # this one, and the first, which TBB asks
            os.sched_setaffinity(thread, {min(cores)})
        Manifold.hull_points(points)
    finally:
        for thread, cores in allowed.items():
            os.sched_setaffinity(thread, cores)
    return Manifold


def compute_convex_hull(points: Points) -> Manifold | None:
    """Compute the convex hull of points, shape (n, 3); None if they are coplanar or not finite.

    Points outside the others' hull by less than about 1e-7 of the extent may be dropped. The same
    points in the same order give the same hull, bit for bit.
    """
    manifold = load_manifold()
    if len(points) < 4 or not np.isfinite(points).all():
        return None
    hull = manifold.hull_points(np.ascontiguousarray(points, dtype=np.float64))
    extent = max(float(np.ptp(points[:, axis])) for axis in range(3))
    return hull if hull.volume() > FLAT * extent**3 else None


def extract_hull_surface(hull: Manifold) -> tuple[Points, Faces]:
    """Return vertices (n, 3) and triangles (m, 3) of a hull, counter-clockwise from outside."""
    mesh = hull.to_mesh64()
    faces = np.array(mesh.tri_verts, dtype=np.int64)
    # Manifold returns the triangles of large hulls in a random order
    first = faces.argmin(axis=1)[:, None]
    faces = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return np.array(mesh.vert_properties[:, :3]), faces[np.lexsort(faces.T[::-1])]
