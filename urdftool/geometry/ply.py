"""PLY, text and binary: triangles and polygons of one object; it declares no unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import MeshError
from .mesh import Piece, Reading


def read(path: Path) -> Reading:
    """Read the faces of a PLY file; vertex colors are ignored.

    Raises:
        MeshError: The file is malformed or has no faces.
    """
    import trimesh

    try:
        mesh = trimesh.load_mesh(path, file_type="ply", process=False)
    # the parser raises arbitrary exceptions for malformed files
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the PLY file cannot be read ({reason}); export or fetch it again", path=path
        ) from error
    faces = getattr(mesh, "faces", None)
    if faces is None or len(faces) == 0:
        raise MeshError("the PLY file has points and no faces; a mesh needs triangles", path=path)
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    return Reading([Piece(vertices, np.asarray(faces, dtype=np.int64))], [])
