"""Meshes of a stage as STL files, by content."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

import numpy as np
import numpy.typing as npt
from pxr import Usd, UsdGeom

from ...storage import write_files

Array = npt.NDArray[np.float64]


class MeshFolder:
    """Folder of the meshes of stages."""

    def __init__(self, folder: Path) -> None:
        """Store the path; the folder is created with the first mesh."""
        self._folder = folder

    def store(self, triangles: Array) -> str:
        """Write triangles [m], shape (n, 3, 3), and return the path of the file."""
        corners = np.ascontiguousarray(triangles, dtype="<f4")
        data = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
        data["v"] = corners
        head = b"Written by urdftool from a mesh of a stage".ljust(80)
        content = head + np.uint32(len(corners)).tobytes() + data.tobytes()
        path = self._folder / f"{sha256(content).hexdigest()[:24]}.stl"
        if not path.is_file():
            self._folder.mkdir(parents=True, exist_ok=True)
            write_files({path: content})
        return str(path)


def read_triangles(prim: Usd.Prim, residual: Array, length: float) -> Array | None:
    """Return the triangles of a mesh prim [m], shape (n, 3, 3); None if it has no face.

    Args:
        prim: A ``Mesh``.
        residual: Scale and shear of the prim, shape (3, 3), for column vectors.
        length: Meters in a unit of length.
    """
    mesh = UsdGeom.Mesh(prim)
    points = mesh.GetPointsAttr().Get()
    counts, corners = mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get()
    if not points or not counts or not corners:
        return None
    vertices = np.array(points, dtype=np.float64) @ residual.T * length
    sizes, flat = np.array(counts), np.array(corners)
    if sizes.sum() != len(flat) or flat.min() < 0 or flat.max() >= len(vertices):
        return None
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    fans = []
    for corner in range(1, int(sizes.max(initial=3)) - 1):
        rows = starts[sizes > corner + 1]
        fans.append(np.stack([flat[rows], flat[rows + corner], flat[rows + corner + 1]], axis=1))
    faces = np.concatenate(fans) if fans else np.zeros((0, 3), dtype=np.int64)
    left = mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded
    if left != (np.linalg.det(residual) < 0):
        faces = faces[:, ::-1]
    return vertices[faces] if len(faces) else None
