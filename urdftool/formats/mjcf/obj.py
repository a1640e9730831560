"""Triangles as a Wavefront OBJ file."""

from __future__ import annotations

import numpy as np

from ...meshes.mesh import Faces, Points


def obj_bytes(vertices: Points, faces: Faces) -> bytes:
    """One object with the vertices that are used, each once.

    Nine digits carry the single precision that MuJoCo keeps.
    """
    used, corners = np.unique(faces, return_inverse=True)
    points, same = np.unique(vertices[used], axis=0, return_inverse=True)
    corners = same.reshape(-1)[corners.reshape(-1)].reshape(-1, 3)
    solid = (
        (corners[:, 0] != corners[:, 1])
        & (corners[:, 1] != corners[:, 2])
        & (corners[:, 2] != corners[:, 0])
    )
    if solid.any():
        corners = corners[solid]
    points = points + 0.0  # no -0
    lines = list(map("v %.9g %.9g %.9g".__mod__, map(tuple, points.tolist())))
    lines += map("f %d %d %d".__mod__, map(tuple, (corners + 1).tolist()))
    return ("\n".join(lines) + "\n").encode()
