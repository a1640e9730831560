"""Convex hulls, by Manifold: it is there in milliseconds, scipy's in a third of a second."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .mesh import Faces, Points

if TYPE_CHECKING:
    from manifold3d import Manifold

FLAT = 1e-12
"""The volume of a hull without any, as a part of the cube of its points' extent."""


def convex_hull(points: Points) -> Manifold | None:
    """The convex hull of points, shape (n, 3); None where they lie in a plane or are no numbers.

    A point that is beyond the others' hull by less than about 1e-7 of their extent may be left out.
    The same points in the same order have the same hull, to the bit.
    """
    from manifold3d import Manifold

    if len(points) < 4 or not np.isfinite(points).all():
        return None
    hull = Manifold.hull_points(np.ascontiguousarray(points, dtype=np.float64))
    extent = max(float(np.ptp(points[:, axis])) for axis in range(3))
    return hull if hull.volume() > FLAT * extent**3 else None


def hull_surface(hull: Manifold) -> tuple[Points, Faces]:
    """Corners (n, 3) and triangles (m, 3) of a hull, counter-clockwise seen from outside."""
    mesh = hull.to_mesh64()
    faces = np.array(mesh.tri_verts, dtype=np.int64)
    # the triangles of a large one come in another order each time
    first = faces.argmin(axis=1)[:, None]
    faces = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return np.array(mesh.vert_properties[:, :3]), faces[np.lexsort(faces.T[::-1])]
