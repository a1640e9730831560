"""Writing of triangle meshes as Wavefront OBJ."""

from __future__ import annotations

import numpy as np

from ...geometry.mesh import Faces, Points


def write_obj_bytes(vertices: Points, faces: Faces, uv: Points | None = None) -> bytes:
    """Write one object with the used vertices, each once.

    Nine digits preserve the single precision that MuJoCo keeps.

    Args:
        vertices: Points, shape (m, 3).
        faces: Vertex indices, shape (n, 3).
        uv: Texture coordinates of each corner, shape (n, 3, 2).
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
        uv = None if uv is None else uv[solid]
    points = points + 0.0  # no -0
    lines = list(map("v %.9g %.9g %.9g".__mod__, map(tuple, points.tolist())))
    if uv is not None:
        texels, rows = np.unique(uv.reshape(-1, 2) + 0.0, axis=0, return_inverse=True)
        lines += map("vt %.9g %.9g".__mod__, map(tuple, texels.tolist()))
        pairs = np.stack([corners, rows.reshape(-1, 3)], axis=2).reshape(-1, 6) + 1
        lines += map("f %d/%d %d/%d %d/%d".__mod__, map(tuple, pairs.tolist()))
        return ("\n".join(lines) + "\n").encode()
    lines += map("f %d %d %d".__mod__, map(tuple, (corners + 1).tolist()))
    return ("\n".join(lines) + "\n").encode()
