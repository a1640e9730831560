"""Positions of a glTF scene, without its faces and materials, by the JSON parser."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

from .mesh import Array, Points
from .points import IDENTITY, select_points, transform_points

if TYPE_CHECKING:
    from ..source.description import GltfUp

_MAX_DEPTH = 64
_FLOAT = 5126
_TRIANGLES = 4  # 5 and 6 are strips and fans
_UNSIGNED = {5121: "u1", 5123: "<u2", 5125: "<u4"}
_UP: Array = np.array(
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)


def read_gltf_points(path: Path, gltf_up: GltfUp = "y") -> Points | None:
    """Read the corners of the scene's triangles [m]; None if there are none.

    Args:
        path: The file.
        gltf_up: Up axis of the file; ``y`` is rotated to Z.

    Raises:
        ValueError: The file is not a glTF file, or its nodes form a cycle. A damaged file may also
            raise LookupError, TypeError or struct.error.
    """
    data = path.read_bytes()
    chunk = b""
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        chunk = data[20 + length + 8 :]
        data = data[20 : 20 + length]
    tree = json.loads(data)
    found: list[Points] = []
    scenes = tree.get("scenes")
    roots = (
        scenes[tree.get("scene", 0)].get("nodes", ())
        if scenes
        else range(len(tree.get("nodes", ())))
    )
    for node in roots:
        _node(tree, node, _UP if gltf_up == "y" else IDENTITY, path, chunk, found, 0)
    return np.concatenate(found) if found else None


def _node(
    tree: Any,
    number: int,
    above: Array,
    path: Path,
    chunk: bytes,
    found: list[Points],
    depth: int,
) -> None:
    if depth > _MAX_DEPTH:
        raise ValueError("nodes in a circle")
    node = tree["nodes"][number]
    matrix = above @ _matrix(node)
    if "mesh" in node:
        for primitive in tree["meshes"][node["mesh"]]["primitives"]:
            if primitive.get("mode", _TRIANGLES) < _TRIANGLES:
                continue  # points and lines are not a surface
            accessor = tree["accessors"][primitive["attributes"]["POSITION"]]
            points = _points(tree, accessor, path, chunk)
            if "indices" in primitive and len(points) == accessor["count"]:
                rows = _rows(tree, tree["accessors"][primitive["indices"]], path, chunk)
                points = points if rows is None else select_points(points, rows)
            found.append(transform_points(points, matrix))
    for child in node.get("children", ()):
        _node(tree, child, matrix, path, chunk, found, depth + 1)


def _matrix(node: Any) -> Array:
    if "matrix" in node:
        values = np.array([float(value) for value in node["matrix"]])
        matrix: Array = values[:16].reshape(4, 4).T.copy()
        matrix[3] = IDENTITY[3]
        return matrix
    if not node.keys() & {"rotation", "scale", "translation"}:
        return IDENTITY
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    (f, g, h), at = node.get("scale", (1.0, 1.0, 1.0)), node.get("translation", (0.0, 0.0, 0.0))
    matrix = IDENTITY.copy()
    matrix[:3, :3] = np.array(rows) * (f, g, h)
    matrix[:3, 3] = at
    return matrix


def _points(tree: Any, accessor: Any, path: Path, chunk: bytes) -> Points:
    if "bufferView" not in accessor or accessor["componentType"] != _FLOAT:
        return _corners(accessor["min"], accessor["max"])  # compressed; its box is declared
    view = tree["bufferViews"][accessor["bufferView"]]
    content = _content(tree, view, path, chunk)
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride, count = view.get("byteStride", 12), accessor["count"]
    if min(start, count) < 0 or stride < 12 or start + (count - 1) * stride + 12 > len(content):
        raise ValueError("points beyond the end of the file")
    points: Points = np.ndarray((count, 3), "<f4", content, start, (stride, 4)).astype(np.float64)
    return points


def _rows(tree: Any, accessor: Any, path: Path, chunk: bytes) -> set[int] | None:
    """Return the point indices that the triangles use; None if they are compressed."""
    kind = _UNSIGNED.get(accessor["componentType"])
    if "bufferView" not in accessor or kind is None:
        return None
    view = tree["bufferViews"][accessor["bufferView"]]
    content = _content(tree, view, path, chunk)
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    count = accessor["count"]
    if start < 0 or count < 0 or start + np.dtype(kind).itemsize * count > len(content):
        raise ValueError("corners beyond the end of the file")
    return set(np.frombuffer(content, kind, count, start).tolist())


def _content(tree: Any, view: Any, path: Path, chunk: bytes) -> bytes:
    """Return the content of the buffer of a view."""
    uri = tree["buffers"][view["buffer"]].get("uri")
    if uri is None:
        return chunk
    if uri.startswith("data:"):
        from base64 import b64decode

        return b64decode(uri.partition(",")[2])
    beside = path.parent / unquote(uri)
    if not beside.is_file():  # reading a device or a pipe would not end
        raise ValueError(f"there is no file '{uri}' beside it")
    return beside.read_bytes()


def _corners(low: Sequence[float], high: Sequence[float]) -> Points:
    """Return the eight corners of a box, shape (8, 3)."""
    ends = list(zip(low, high, strict=True))
    return np.array([[float(ends[axis][k >> axis & 1]) for axis in range(3)] for k in range(8)])
