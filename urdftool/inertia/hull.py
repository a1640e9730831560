"""Convex hull: an upper bound for the solid that any surface encloses."""

from __future__ import annotations

import numpy as np

from ..errors import MeshError
from ..geometry.mesh import Points
from .polyhedron import Moments, compute_solid_moments


def compute_hull_moments(points: Points) -> Moments:
    """Compute the moments of the convex hull of points [m], shape (n, 3).

    Raises:
        MeshError: The points lie in a plane.
    """
    from scipy.spatial import ConvexHull, QhullError

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
