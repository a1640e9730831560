"""Meshes of a stage as STL files, or OBJ files with texture coordinates."""

from __future__ import annotations

import re
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import numpy as np
import numpy.typing as npt
from pxr import Usd, UsdGeom

from ...errors import ModelError
from ...source.location import Place
from ...storage import write_files

MAX_BYTES = 512 << 20
"""Maximum size of the files of a stage [bytes]. Chosen, no source."""

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Triangles:
    """Triangles of a mesh prim.

    Attributes:
        corners: Their corners [m], shape (n, 3, 3).
        coordinates: Texture coordinates of the corners, shape (n, 3, 2); None without them.
        faces: The face of each triangle, shape (n,).
    """

    corners: Array
    coordinates: Array | None
    faces: Indices

    def select(self, chosen: npt.NDArray[np.bool_]) -> Triangles:
        """Return some of the triangles."""
        uv = self.coordinates
        return Triangles(
            self.corners[chosen], None if uv is None else uv[chosen], self.faces[chosen]
        )


class MeshFolder:
    """Folder of the meshes and images of stages; files are named by prim and content."""

    def __init__(self, folder: Path, place: Place) -> None:
        """Store the path; the folder is created with the first file."""
        self._folder, self._place = folder, place
        self._size = 0
        self._new: list[Path] = []
        self._known: dict[str, str] = {}

    def store(self, triangles: Triangles, name: str, *, textured: bool) -> str:
        """Write triangles, and return the path of the file."""
        uv = triangles.coordinates
        if textured and uv is not None:
            content, suffix = _format_obj(triangles.corners, uv), ".obj"
        else:
            content, suffix = _format_stl(triangles.corners), ".stl"
        key = sha256(content).hexdigest()
        if key not in self._known:
            start = re.sub(r"[^A-Za-z0-9_.]+", "_", name)
            self._known[key] = self.store_file(f"{start}-{key[:8]}{suffix}", content)
        return self._known[key]

    def store_file(self, name: str, content: bytes) -> str:
        """Write a file unless it exists, and return its path.

        Raises:
            ModelError: The files of the stage are too large.
        """
        self._size += len(content)
        if self._size > MAX_BYTES:
            text = f"the meshes and images of the stage are larger than {MAX_BYTES >> 20} MiB"
            raise ModelError(f"{text}; it is not read", at=self._place)
        path = self._folder / name
        if not path.is_file():
            self._folder.mkdir(parents=True, exist_ok=True)
            self._new.append(path)
            write_files({path: content})
        return str(path)

    def remove_new(self) -> None:
        """Remove the files that did not exist before."""
        for path in self._new:
            path.unlink(missing_ok=True)


def _format_stl(corners: Array) -> bytes:
    floats = np.ascontiguousarray(corners, dtype="<f4")
    data = np.zeros(len(floats), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    data["v"] = floats
    head = b"Written by urdftool from a mesh of a stage".ljust(80)
    content: bytes = head + np.uint32(len(floats)).tobytes() + data.tobytes()
    return content


def _format_obj(corners: Array, uv: Array) -> bytes:
    points, at = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    coordinates, mapped = np.unique(uv.reshape(-1, 2), axis=0, return_inverse=True)
    pairs = np.stack([at.reshape(-1), mapped.reshape(-1)], axis=1).reshape(-1, 6) + 1
    lines = ["# Written by urdftool from a mesh of a stage"]
    lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points.tolist()]
    lines += [f"vt {u:.7g} {v:.7g}" for u, v in coordinates.tolist()]
    lines += [f"f {a}/{b} {c}/{d} {e}/{f}" for a, b, c, d, e, f in pairs.tolist()]
    return ("\n".join(lines) + "\n").encode()


def read_triangles(prim: Usd.Prim, residual: Array, length: float) -> Triangles | None:
    """Return the triangles of a mesh prim; None if it has no face, or invalid numbers.

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
    if sizes.sum() != len(flat) or sizes.min() < 0 or not np.isfinite(vertices).all():
        return None
    if flat.min() < 0 or flat.max() >= len(vertices):
        return None
    rows, faces = _split_faces(sizes)
    left = mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded
    if left != (np.linalg.det(residual) < 0):
        rows = rows[:, ::-1]
    if not len(rows):
        return None
    uv = _read_coordinates(prim, flat, len(vertices))
    return Triangles(vertices[flat[rows]], None if uv is None else uv[rows], faces)


def _split_faces(sizes: Indices) -> tuple[Indices, Indices]:
    """Return the corners of the fans of the faces, shape (n, 3), and the face of each triangle."""
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    counts = np.maximum(sizes - 2, 0)
    faces = np.repeat(np.arange(len(sizes)), counts)
    corner = np.arange(len(faces)) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    order = np.argsort(corner, kind="stable")  # the first triangles of all faces are first
    faces, corner = faces[order], corner[order]
    first = starts[faces]
    return np.stack([first, first + corner, first + corner + 1], axis=1), faces


def _read_coordinates(prim: Usd.Prim, corners: Indices, points: int) -> Array | None:
    """Return the texture coordinates of the corners of all faces; None without valid ones."""
    for name in ("st", "UVMap", "st0", "map1"):
        primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar(name)
        values = primvar.ComputeFlattened() if primvar and primvar.HasValue() else None
        if not values:
            continue
        uv = np.array(values, dtype=np.float64).reshape(len(values), -1)[:, :2]
        if not np.isfinite(uv).all():
            continue
        if len(uv) == points and primvar.GetInterpolation() in ("vertex", "varying"):
            return uv[corners]
        if len(uv) == len(corners) and primvar.GetInterpolation() == "faceVarying":
            return uv
    return None
