"""Convex hulls by Manifold, which imports in milliseconds (scipy takes a third of a second)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .mesh import Faces, Points

if TYPE_CHECKING:
    from manifold3d import Manifold

FLAT = 1e-12
"""Smallest volume of a hull, relative to the cube of the extent of its points."""


def compute_convex_hull(points: Points) -> Manifold | None:
    """Compute the convex hull of points, shape (n, 3); None if they are coplanar or not finite.

    Points outside the others' hull by less than about 1e-7 of the extent may be dropped. The same
    points in the same order give the same hull, bit for bit.
    """
    from manifold3d import Manifold

    if len(points) < 4 or not np.isfinite(points).all():
        return None
    hull = Manifold.hull_points(np.ascontiguousarray(points, dtype=np.float64))
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
