"""Copies of meshes with fewer triangles, for pictures; kept by the content of the file.

Vertices in one cell of a grid become one of them, and triangles without an area are dropped, so no
vertex moves by more than the diagonal of a cell.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import MeshError
from ..source.access import list_companions
from ..storage import DiskCache, cache_key, join_parts, split_parts
from .load import load_mesh
from .mesh import Mesh, Part, Points
from .plain_form import decode_numbers, decode_triangles, encode_triangles
from .topology import find_used_vertices

if TYPE_CHECKING:
    from ..source.description import GltfUp

SMALL_FILE = 300_000
"""Size [bytes] of a file up to which its mesh is read as it is. Chosen, no source."""

FINEST = 1024
"""Largest number of cells along the diagonal of a mesh; a finer one is read as it is. Chosen, no
source."""

_COARSEST = 16  # cells along the diagonal of a mesh at least; chosen, no source
_REVISION = 2  # part of the keys of the cache; increment it when the same file gives another result
_MATERIALS = {".gltf": "*.bin", ".obj": "*.mtl"}  # files that belong to a mesh file


class ThinMeshes:
    """Reader of meshes with as much detail as a picture shows."""

    def __init__(self, cache: DiskCache) -> None:
        """Set the cache, whose entries are bounding boxes and thinned meshes."""
        self.cache = cache
        self._loaded: dict[object, Mesh] = {}
        self._keys: dict[object, str] = {}

    def read_bounds(self, path: Path, scale: Sequence[float], gltf_up: GltfUp) -> Points:
        """Return the corners [m] of a mesh's bounding box, shape (2, 3).

        Raises:
            UrdftoolError: The file cannot be read.
        """
        key = self._make_key(path, scale, gltf_up, "bounds")
        data = None if key is None else self.cache.get(key)
        known = None if data is None else _unpack_bounds(data)
        if known is not None:
            return known
        used = self._read_full(path, scale, gltf_up)
        points = used.vertices[find_used_vertices(used.faces, len(used.vertices))]
        bounds = np.array([points.min(axis=0), points.max(axis=0)])
        if key is not None:
            self.cache.put(key, json.dumps(bounds.tolist()).encode())
        return bounds

    def read(self, path: Path, scale: Sequence[float], gltf_up: GltfUp, cell: float) -> Mesh:
        """Read a mesh whose vertices may be off by the diagonal of a cell.

        The edge of a cell is in m.

        Raises:
            UrdftoolError: The file cannot be read.
        """
        if path.stat().st_size <= SMALL_FILE:
            return self._read_full(path, scale, gltf_up)
        low, high = self.read_bounds(path, scale, gltf_up)
        diagonal = float(np.linalg.norm(high - low))
        count = _COARSEST
        while count * cell < diagonal and count <= FINEST:
            count *= 2
        if count > FINEST:
            return self._read_full(path, scale, gltf_up)
        key = self._make_key(path, scale, gltf_up, count)
        data = None if key is None else self.cache.get(key)
        known = None if data is None else _unpack(data, path)
        if known is not None:
            return known
        mesh = merge_in_cells(self._read_full(path, scale, gltf_up), diagonal / count)
        if key is not None and all(part.image is None for part in mesh.parts):
            self.cache.put(key, _pack(mesh))
        return mesh

    def _read_full(self, path: Path, scale: Sequence[float], gltf_up: GltfUp) -> Mesh:
        key = (path, tuple(scale))
        if key not in self._loaded:
            self._loaded[key] = load_mesh(path, scale, gltf_up=gltf_up)
        return self._loaded[key]

    def _make_key(
        self, path: Path, scale: Sequence[float], gltf_up: GltfUp, detail: object
    ) -> str | None:
        if self.cache.folder is None or not path.is_file():
            return None  # load_mesh says what else it is
        if path not in self._keys:
            self._keys[path] = compute_content_key(path)
        facts = [list(scale), gltf_up, detail]
        return cache_key(_REVISION, facts, [self._keys[path].encode()])


def compute_content_key(path: Path) -> str:
    """Return a digest of a mesh file and of the files that belong to it.

    Raises:
        MeshError: The file cannot be read.
    """
    suffix = path.suffix.lower()
    try:
        inputs = [path.read_bytes()]
        if pattern := _MATERIALS.get(suffix):
            for other in list_companions(path, pattern):
                inputs += [other.name.encode(), other.read_bytes()]
    except OSError as error:
        raise MeshError(f"the mesh cannot be read: {error.strerror}", path=path) from error
    return cache_key(_REVISION, suffix, inputs)


def merge_in_cells(mesh: Mesh, cell: float) -> Mesh:
    """Merge the vertices in each cell, of edge ``cell`` [m], and drop the triangles that vanish."""
    at = np.floor((mesh.vertices - mesh.vertices.min(axis=0)) / cell).astype(np.int64)
    sizes = at.max(axis=0) + 1
    number = (at[:, 0] * sizes[1] + at[:, 1]) * sizes[2] + at[:, 2]
    _, first, owner = np.unique(number, return_index=True, return_inverse=True)
    faces = owner.reshape(-1)[mesh.faces]
    a, b, c = faces.T
    rows = np.flatnonzero((a != b) & (b != c) & (c != a))
    ordered = np.sort(faces[rows], axis=1)
    triples = (ordered[:, 0] * len(first) + ordered[:, 1]) * len(first) + ordered[:, 2]
    if len(first) < 2_000_000:  # else the product does not fit
        rows = rows[np.sort(np.unique(triples, return_index=True)[1])]
    if not len(rows):
        return mesh
    parts = []
    ends = np.searchsorted(rows, [part.first for part in mesh.parts])
    lasts = np.searchsorted(rows, [part.first + part.count for part in mesh.parts])
    for part, start, end in zip(mesh.parts, ends.tolist(), lasts.tolist(), strict=True):
        uv = None if part.uv is None else part.uv[rows[start:end] - part.first]
        parts.append(replace(part, first=start, count=end - start, uv=uv))
    return replace(
        mesh, vertices=mesh.vertices[first], faces=faces[rows].astype(np.int64), parts=tuple(parts)
    )


def _pack(mesh: Mesh) -> bytes:
    parts = [
        {
            "name": part.name,
            "first": part.first,
            "count": part.count,
            "rgba": part.rgba,
            "texture": None if part.texture is None else str(part.texture),
            "uv": part.uv is not None,
        }
        for part in mesh.parts
    ]
    corners = [np.ascontiguousarray(p.uv, "<f8").tobytes() for p in mesh.parts if p.uv is not None]
    head = {"parts": parts, "format": mesh.format}
    return join_parts(head, [*encode_triangles(mesh.vertices, mesh.faces), *corners])


def _unpack(data: bytes, path: Path) -> Mesh | None:
    """Return the mesh of an entry; None if the entry is damaged."""
    try:
        head, (points, triangles, *corners) = split_parts(data)
        vertices, faces = decode_triangles(points, triangles)
        parts = tuple(_unpack_part(part, corners, len(faces)) for part in head["parts"])
        return Mesh(vertices, faces, parts, str(head["format"]), path)
    except (ValueError, TypeError, KeyError, IndexError, OverflowError):
        return None


def _unpack_part(table: dict[str, Any], corners: list[bytes], faces: int) -> Part:
    """Return a part of a mesh, and remove its texture coordinates from the list."""
    first, count = int(table["first"]), int(table["count"])
    if not 0 <= first <= first + count <= faces:
        raise ValueError("a part has a face that does not exist")
    rgba = None
    if table["rgba"] is not None:
        red, green, blue, alpha = map(float, table["rgba"])
        rgba = red, green, blue, alpha
    uv = decode_numbers(corners.pop(0), 3, 2) if table["uv"] else None
    if uv is not None and len(uv) != count:
        raise ValueError("a part has other texture coordinates")
    texture = None if table["texture"] is None else Path(table["texture"])
    return Part(str(table["name"]), first, count, rgba, texture, None, uv)


def _unpack_bounds(data: bytes) -> Points | None:
    """Return the corners of an entry; None if the entry is damaged."""
    try:
        bounds = np.array(json.loads(data), dtype=np.float64)
    except (ValueError, TypeError, RecursionError):
        return None
    return bounds if bounds.shape == (2, 3) and np.isfinite(bounds).all() else None
