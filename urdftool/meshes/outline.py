"""How far a mesh reaches: its outermost points, read faster than its triangles.

``load`` reads a mesh for those who need its faces. A question of size or of contact needs points
alone, and of those only the outermost: what lies inside the convex hull changes neither the box
around a mesh nor the distance between two hulls. So this module reads positions straight from the
bytes and keeps, of as many as there may be, the extreme ones in some hundred directions. Units and
axes are those of :func:`urdftool.meshes.load.load_mesh`.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from ..errors import MeshError
from .facts import HEADER_BYTES, stl_facts
from .mesh import Points

Reach = Callable[[float, float, float], float]
"""How far something reaches along a direction [m]."""

LARGEST = 64_000_000
"""Bytes of a file that is read; more is left to those who must."""

_DIRECTIONS = 90
_BLOCK = 2048  # small enough that a product with 32 directions stays on one core
_MAX_DEPTH = 64


def outline(path: str | Path) -> Points | None:
    """The outermost points of a mesh in the frame of the file, unscaled, shape (n, 3).

    Their hull lies inside that of the mesh and is all but as large; the box around them is the box
    around the mesh. None where the file cannot be read, is larger than :data:`LARGEST`, or holds no
    finite point.
    """
    file = Path(path)
    try:
        if file.stat().st_size > LARGEST:
            return None
        points = _READERS[file.suffix.lower()](file)
    # whatever a damaged file makes arithmetic raise: here it is only a file that says nothing
    except (MeshError, OSError, ValueError, LookupError, TypeError, AttributeError, struct.error):
        return None
    if points is None or not len(points) or not np.isfinite(points).all():
        return None
    return extremes(np.asarray(points, dtype=np.float64))


def extremes(points: Points) -> Points:
    """Those points that reach furthest in some direction, all six along the axes among them."""
    if len(points) <= 2 * _DIRECTIONS:
        return points
    points = np.ascontiguousarray(points)
    while len(points) > _BLOCK:
        blocks = [points[first : first + _BLOCK] for first in range(0, len(points), _BLOCK)]
        points = np.concatenate([_outermost(block) for block in blocks])
        if len(points) > 0.7 * sum(map(len, blocks)):
            break
    return _outermost(points) if len(points) <= _BLOCK else points


def placed(
    points: Points, scale: Sequence[float], rotation: Sequence[Sequence[float]], at: Sequence[float]
) -> Points:
    """Points that are scaled, turned and moved [m], by the factors and the pose of a shape."""
    # einsum, as a product of matrices wakes the other cores for nothing
    turned = np.einsum("ij,kj->ki", np.array(rotation), points * np.array(scale))
    return np.asarray(turned + np.array(at))


def _outermost(points: Points) -> Points:
    ways = _directions()
    centred = (points - points.mean(axis=0)).astype(np.float32)
    kept = np.zeros(len(points), dtype=bool)  # np.unique would import numpy.ma
    for first in range(0, len(ways), 32):
        kept[(centred @ ways[first : first + 32].T).argmax(axis=0)] = True
    return np.asarray(points[kept])


@cache
def _directions() -> Points:
    """Unit vectors: the axes, and a spiral that covers the sphere evenly."""
    count = np.arange(_DIRECTIONS) + 0.5
    z = 1 - 2 * count / _DIRECTIONS
    turn = count * math.pi * (1 + math.sqrt(5))
    radius = np.sqrt(1 - z * z)
    spiral = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)
    return np.concatenate([np.eye(3), -np.eye(3), spiral]).astype(np.float32)


def _stl(path: Path) -> Points | None:
    facts = stl_facts(path)
    if facts.kind == "ascii":
        words = path.read_bytes().split()
        rows = [i for i, word in enumerate(words) if word.lower() == b"vertex"]
        return np.array([words[i + 1 : i + 4] for i in rows], dtype=bytes).astype(np.float64)
    if facts.kind != "binary" or not facts.triangles or facts.bytes < (facts.expected_bytes or 0):
        return None
    raw = np.fromfile(path, dtype=np.uint8, count=50 * facts.triangles, offset=HEADER_BYTES)
    corners = raw.reshape(-1, 50)[:, 12:48].copy().view("<f4")
    return np.asarray(corners.reshape(-1, 3), dtype=np.float64)


def _obj(path: Path) -> Points | None:
    lines = path.read_bytes().splitlines()
    rows = [line.split()[1:4] for line in lines if line.startswith((b"v ", b"v\t"))]
    return np.array(rows, dtype=bytes).astype(np.float64) if rows else None


def _ply(path: Path) -> Points | None:
    from .load import load_mesh

    return load_mesh(path).vertices


def _gltf(path: Path) -> Points | None:
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
        _gltf_node(tree, node, np.eye(4), path, chunk, found, 0)
    if not found:
        return None
    x, y, z = np.concatenate(found).T
    return np.stack([x, -z, y], axis=1)  # its Y is up


def _gltf_node(
    tree: Any, number: int, above: Points, path: Path, chunk: bytes, found: list[Points], depth: int
) -> None:
    if depth > _MAX_DEPTH:
        raise ValueError("nodes in a circle")
    node = tree["nodes"][number]
    matrix = above @ _gltf_matrix(node)
    if "mesh" in node:
        for primitive in tree["meshes"][node["mesh"]]["primitives"]:
            accessor = tree["accessors"][primitive["attributes"]["POSITION"]]
            points = _gltf_points(tree, accessor, path, chunk)
            found.append(points @ matrix[:3, :3].T + matrix[:3, 3])
    for child in node.get("children", ()):
        _gltf_node(tree, child, matrix, path, chunk, found, depth + 1)


def _gltf_matrix(node: Any) -> Points:
    if "matrix" in node:
        return np.asarray(np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T)
    matrix = np.eye(4)
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.get("scale", (1.0, 1.0, 1.0)))
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


def _gltf_points(tree: Any, accessor: Any, path: Path, chunk: bytes) -> Points:
    if "bufferView" not in accessor or accessor["componentType"] != 5126:
        box = np.array([accessor["min"], accessor["max"]], dtype=np.float64)  # packed, but its box
        return np.stack([box[[k & 1, k >> 1 & 1, k >> 2], range(3)] for k in range(8)])
    view = tree["bufferViews"][accessor["bufferView"]]
    uri = tree["buffers"][view["buffer"]].get("uri")
    if uri is None:
        content = chunk
    elif uri.startswith("data:"):
        from base64 import b64decode

        content = b64decode(uri.partition(",")[2])
    else:
        content = (path.parent / unquote(uri)).read_bytes()
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", 12)
    raw = np.ndarray((accessor["count"], 3), "<f4", content, start, (stride, 4))
    return np.asarray(raw, dtype=np.float64)


def _dae(path: Path) -> Points | None:
    from .collada_points import collada_points

    return collada_points(path)


_READERS = {
    ".stl": _stl,
    ".obj": _obj,
    ".ply": _ply,
    ".gltf": _gltf,
    ".glb": _gltf,
    ".dae": _dae,
}


def reach_of(points: Points) -> tuple[tuple[float, float, float], float, Reach]:
    """Points as a convex shape: their middle, the radius about it [m], and their support function.

    The function gives how far the hull reaches from the middle along a direction.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    centred = np.ascontiguousarray((points - middle).T)
    radius = float(np.sqrt((centred * centred).sum(axis=0).max()))
    rows = centred[0].copy(), centred[1].copy(), centred[2].copy()

    def reach(x: float, y: float, z: float) -> float:
        return float((rows[0] * x + rows[1] * y + rows[2] * z).max())

    x, y, z = middle.tolist()
    return (x, y, z), radius, reach
