"""PLY, text and binary: triangles and polygons of one object, in no unit (URDF takes metres)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import MeshError
from .mesh import Piece, Reading


def read(path: Path) -> Reading:
    """The faces of a PLY file; colours of single vertices are not used."""
    import trimesh

    try:
        mesh = trimesh.load_mesh(path, file_type="ply", process=False)
    # the parser meets malformed files with whatever its arithmetic raises
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
