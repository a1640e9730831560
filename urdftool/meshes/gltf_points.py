"""The positions of a glTF scene, without its faces and materials."""

from __future__ import annotations

import json
import struct
import sys
from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from .positions import UPRIGHT, Affine, Columns, chosen, every_third, joined, moved, product

if TYPE_CHECKING:
    from ..source.description import GltfUp

_MAX_DEPTH = 64
_FLOAT = 5126
_TRIANGLES = 4  # and 5, 6 for strips and fans of them
_UNSIGNED = {5121: "B", 5123: "H", 5125: "I"}
_UP: Affine = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, -1.0, 0.0), (0.0, 1.0, 0.0, 0.0))


def gltf_columns(path: Path, gltf_up: GltfUp = "y") -> Columns | None:
    """The corners of the scene's triangles [m], its Y as Z where that is up; None if it has none.

    Raises:
        ValueError: The file is no glTF file, or its nodes form a circle. What else a damaged one
            raises (LookupError, TypeError, struct.error) is left to the caller.
    """
    data = path.read_bytes()
    chunk = b""
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        chunk = data[20 + length + 8 :]
        data = data[20 : 20 + length]
    tree = json.loads(data)
    found: list[Columns] = []
    scenes = tree.get("scenes")
    roots = (
        scenes[tree.get("scene", 0)].get("nodes", ())
        if scenes
        else range(len(tree.get("nodes", ())))
    )
    for node in roots:
        _node(tree, node, _UP if gltf_up == "y" else UPRIGHT, path, chunk, found, 0)
    return joined(found) if found else None


def _node(
    tree: Any,
    number: int,
    above: Affine,
    path: Path,
    chunk: bytes,
    found: list[Columns],
    depth: int,
) -> None:
    if depth > _MAX_DEPTH:
        raise ValueError("nodes in a circle")
    node = tree["nodes"][number]
    matrix = product(above, _matrix(node))
    if "mesh" in node:
        for primitive in tree["meshes"][node["mesh"]]["primitives"]:
            if primitive.get("mode", _TRIANGLES) < _TRIANGLES:
                continue  # points and lines are not a surface
            accessor = tree["accessors"][primitive["attributes"]["POSITION"]]
            columns = _points(tree, accessor, path, chunk)
            if "indices" in primitive and len(columns[0]) == accessor["count"]:
                rows = _rows(tree, tree["accessors"][primitive["indices"]], path, chunk)
                columns = columns if rows is None else chosen(columns, rows)
            found.append(moved(columns, matrix))
    for child in node.get("children", ()):
        _node(tree, child, matrix, path, chunk, found, depth + 1)


def _matrix(node: Any) -> Affine:
    if "matrix" in node:
        values = [float(value) for value in node["matrix"]]
        a, b, c = (tuple(values[row : row + 13 : 4]) for row in range(3))
        return a, b, c  # type: ignore[return-value]
    if not node.keys() & {"rotation", "scale", "translation"}:
        return UPRIGHT
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    (f, g, h), at = node.get("scale", (1.0, 1.0, 1.0)), node.get("translation", (0.0, 0.0, 0.0))
    return tuple((a * f, b * g, c * h, t) for (a, b, c), t in zip(rows, at, strict=True))


def _points(tree: Any, accessor: Any, path: Path, chunk: bytes) -> Columns:
    if "bufferView" not in accessor or accessor["componentType"] != _FLOAT:
        return _corners(accessor["min"], accessor["max"])  # packed, but its box is said
    view = tree["bufferViews"][accessor["bufferView"]]
    content = _content(tree, view, path, chunk)
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride, count = view.get("byteStride", 12), accessor["count"]
    if min(start, count) < 0 or stride < 12 or start + (count - 1) * stride + 12 > len(content):
        raise ValueError("points beyond the end of the file")
    if stride == 12:
        values = array("f", content[start : start + 12 * count])
        if sys.byteorder == "big":
            values.byteswap()
        return every_third(values)
    rows = [struct.unpack_from("<3f", content, start + stride * row) for row in range(count)]
    x, y, z = zip(*rows, strict=True) if rows else ((), (), ())
    return x, y, z


def _rows(tree: Any, accessor: Any, path: Path, chunk: bytes) -> set[int] | None:
    """The numbers of the points that triangles have; None where they are packed."""
    kind = _UNSIGNED.get(accessor["componentType"])
    if "bufferView" not in accessor or kind is None:
        return None
    view = tree["bufferViews"][accessor["bufferView"]]
    content = _content(tree, view, path, chunk)
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    values = array(kind)
    end = start + values.itemsize * accessor["count"]
    if not 0 <= start <= end <= len(content):
        raise ValueError("corners beyond the end of the file")
    values.frombytes(content[start:end])
    if sys.byteorder == "big":
        values.byteswap()
    return set(values)


def _content(tree: Any, view: Any, path: Path, chunk: bytes) -> bytes:
    """The bytes of the buffer that a view is one of."""
    uri = tree["buffers"][view["buffer"]].get("uri")
    if uri is None:
        return chunk
    if uri.startswith("data:"):
        from base64 import b64decode

        return b64decode(uri.partition(",")[2])
    beside = path.parent / unquote(uri)
    if not beside.is_file():  # a device or a pipe is read without end
        raise ValueError(f"there is no file '{uri}' beside it")
    return beside.read_bytes()


def _corners(low: Sequence[float], high: Sequence[float]) -> Columns:
    ends = list(zip(low, high, strict=True))
    corners = [[float(ends[axis][k >> axis & 1]) for axis in range(3)] for k in range(8)]
    x, y, z = zip(*corners, strict=True)
    return x, y, z
