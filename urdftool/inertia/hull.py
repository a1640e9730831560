"""Convex hull: an upper bound for the solid that any surface encloses."""

from __future__ import annotations

import numpy as np

from ..errors import MeshError
from ..geometry.hull import compute_convex_hull, extract_hull_surface
from ..geometry.mesh import Points
from .polyhedron import Moments, compute_solid_moments

MAX_QHULL = 20_000
"""Number of points from which Manifold computes the hull: the time of Qhull grows with the square
of the corners of a flat side, for 30,000 to minutes."""


def compute_hull_moments(points: Points) -> Moments:
    """Compute the moments of the convex hull of points [m], shape (n, 3).

    Raises:
        MeshError: The points lie in a plane.
    """
    from scipy.spatial import ConvexHull, QhullError

    if len(points) > MAX_QHULL:
        simpler = compute_convex_hull(points)
        if simpler is not None:
            return compute_solid_moments(*extract_hull_surface(simpler))
    try:
        hull = ConvexHull(points)
    except QhullError as error:
        raise MeshError(
            "the mesh is flat and encloses no volume; for a plate or sheet use a shell"
        ) from error
    faces = hull.simplices.astype(np.int64)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return compute_solid_moments(points, faces)
