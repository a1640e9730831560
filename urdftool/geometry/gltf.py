"""glTF 2.0 (.gltf, .glb): a scene in meters with Y up, as its standard defines.

How the consumers of a robot description read it, according to their sources: RViz (rviz_rendering
since 2025), Drake and Blender rotate the scene by +90° about X so that Y becomes Z. Older releases
of RViz and Gazebo (gz-common's ``AssimpLoader``) keep the file's axes. PyBullet and MuJoCo do not
read glTF. This reader rotates it, as the standard requires, unless the user declares that Z is up
(``--gltf-up z``); a note reports either.

Why not trimesh (5.2 reads 18 of 18 files as this reader does): it ignores sparse accessors, loses
fans, and takes compressed meshes and corners out of range without an error.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import MeshError
from .gltf_file import GltfFile
from .limits import check_instances
from .mesh import Array, Faces, MeshNote, Piece, Points, Reading
from .points import IDENTITY, select_used, transform_points

if TYPE_CHECKING:
    from ..source.description import GltfUp

MAX_DEPTH = 256
"""Largest depth of nested nodes, which may form a cycle in a damaged file. Chosen, no source."""

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
"""Modes of primitives, as glTF numbers them."""

_UPRIGHT: Array = np.array(
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)

_NOTES = {
    "y": "Y is up in a glTF file and was turned to Z, as RViz does since 2025; `--gltf-up z` keeps "
    "the axes of the file, as Gazebo does.",
    "z": "The axes of the glTF file were kept, as Gazebo does; `--gltf-up y` turns Y to Z, as RViz "
    "does since 2025.",
}


def read(path: Path, *, gltf_up: GltfUp = "y") -> Reading:
    """Read the triangles of a glTF scene, one piece per primitive of each instance.

    Args:
        path: The file.
        gltf_up: Up axis of the file; ``y`` is rotated to Z.

    Raises:
        MeshError: The file is malformed or compressed, or a buffer or an image is missing.
    """
    with _raise_mesh_errors(path):
        file = GltfFile(path)
        file.check_references()
        pieces = [
            _make_piece(file, mesh, primitive, matrix)
            for mesh, primitive, matrix in _list_primitives(file, gltf_up)
        ]
    return Reading(pieces, [MeshNote("gltf-axes", _NOTES[gltf_up])])


def read_points(path: Path, gltf_up: GltfUp = "y") -> Points | None:
    """Read the corners of the scene's triangles [m], shape (n, 3); None if there are none.

    Compressed positions are replaced by the corners of the box that the file declares.

    Args:
        path: The file.
        gltf_up: Up axis of the file; ``y`` is rotated to Z.

    Raises:
        MeshError: The file is malformed, or a buffer is missing.
    """
    with _raise_mesh_errors(path):
        file = GltfFile(path)
        points = [
            transform_points(_read_used_points(file, primitive), matrix)
            for _, primitive, matrix in _list_primitives(file, gltf_up)
        ]
    return np.concatenate(points) if points else None


@contextmanager
def _raise_mesh_errors(path: Path) -> Iterator[None]:
    """Raise a MeshError for any error that a damaged file causes."""
    try:
        yield
    except (
        *(ValueError, LookupError, TypeError, AttributeError, ArithmeticError),
        *(RecursionError, MemoryError, struct.error),
    ) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the glTF file cannot be read ({reason}); export or fetch it again, with its buffers "
            "in its folder and without Draco compression",
            path=path,
        ) from error


def _list_primitives(file: GltfFile, gltf_up: GltfUp) -> list[tuple[Any, Any, Array]]:
    """List the triangle meshes of the scene, as :func:`_find_primitives`.

    Raises:
        MeshError: They exceed a limit; nothing was read of them.
    """
    primitives: list[tuple[Any, Any, Array]] = []
    triangles = 0
    for mesh, primitive, matrix in _find_primitives(file, gltf_up):
        primitives.append((mesh, primitive, matrix))
        corners = (
            file.count_values(primitive["indices"])
            if "indices" in primitive
            else file.count_elements(primitive["attributes"]["POSITION"])
        )
        triangles += corners // 3 if primitive.get("mode", _TRIANGLES) == _TRIANGLES else corners
        check_instances(file.path, file.size, triangles=triangles, parts=len(primitives))
    return primitives


def _find_primitives(file: GltfFile, gltf_up: GltfUp) -> Iterator[tuple[Any, Any, Array]]:
    """Yield the triangle meshes of the scene: mesh, primitive and pose, shape (4, 4)."""
    nodes = file.tree.get("nodes", [])
    scenes = file.tree.get("scenes")
    if scenes:
        roots = scenes[file.tree.get("scene", 0)].get("nodes", ())
    else:
        children = {child for node in nodes for child in node.get("children", ())}
        roots = [number for number in range(len(nodes)) if number not in children]
    top = _UPRIGHT if gltf_up == "y" else IDENTITY
    waiting = [(root, top, 0) for root in reversed(dict.fromkeys(roots))]
    walked: set[tuple[int, int]] = set()
    check_instances(file.path, file.size, nodes=len(nodes))
    while waiting:
        number, above, depth = waiting.pop()
        if depth > MAX_DEPTH or number < 0:
            raise ValueError(f"nodes more than {MAX_DEPTH} deep, or node {number}")
        node = nodes[number]
        matrix = above @ _make_matrix(node)
        if "mesh" in node:
            mesh = file.tree["meshes"][node["mesh"]]
            for primitive in mesh["primitives"]:
                if primitive.get("mode", _TRIANGLES) in (_TRIANGLES, _STRIP, _FAN):
                    yield mesh, primitive, matrix
        for child in reversed(node.get("children", ())):
            if (number, child) not in walked:  # a child of two nodes does not conform
                walked.add((number, child))
                check_instances(file.path, file.size, nodes=len(walked))
                waiting.append((child, matrix, depth + 1))


def _make_matrix(node: Any) -> Array:
    """Return the pose and scale of a node in its parent, shape (4, 4)."""
    matrix: Array = IDENTITY.copy()
    if "matrix" in node:
        matrix = np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
        matrix[3] = IDENTITY[3]
    if node.keys() & {"rotation", "scale", "translation"}:
        local: Array = IDENTITY.copy()
        rotation = _make_rotation(node.get("rotation", (0.0, 0.0, 0.0, 1.0)))
        local[:3, :3] = rotation * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
        local[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
        matrix = matrix @ local
    return matrix


def _make_rotation(quaternion: Any) -> Array:
    """Return the matrix of a quaternion x y z w, which need not be of unit length."""
    values = np.array(quaternion, dtype=np.float64)
    length = float(np.linalg.norm(values))
    x, y, z, w = values / length if length else (0.0, 0.0, 0.0, 1.0)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _make_piece(file: GltfFile, mesh: Any, primitive: Any, matrix: Array) -> Piece:
    """Read the triangles and the material of a primitive, placed in the scene."""
    file.check_not_compressed(primitive)
    values = file.read_accessor(primitive["attributes"]["POSITION"])
    faces = _read_faces(file, primitive, len(values))
    if np.linalg.det(matrix[:3, :3]) < 0:
        faces = np.ascontiguousarray(faces[:, ::-1])
    uv = _read_texture_coordinates(file, primitive, faces, len(values))
    values, faces = select_used(values, faces)
    rgba, texture, image = None, None, None
    if "material" in primitive:
        rgba, (texture, image) = file.read_material(primitive["material"])
    points = transform_points(values.astype(np.float64), matrix)
    return Piece(points, faces, str(mesh.get("name", "")), rgba, texture, image, uv)


def _read_faces(file: GltfFile, primitive: Any, count: int) -> Faces:
    """Read the corners of the triangles, rows of the vertices, shape (m, 3)."""
    rows: Faces
    if "indices" in primitive:
        rows = file.read_accessor(primitive["indices"]).astype(np.int64).ravel()
        if rows.max(initial=-1) >= count or rows.min(initial=0) < 0:
            raise ValueError(f"a face names vertex {rows.max()} of {count}")
    else:
        rows = np.arange(count, dtype=np.int64)
    mode = primitive.get("mode", _TRIANGLES)
    if mode == _TRIANGLES:
        return rows.reshape(-1, 3)
    faces = np.stack([rows[:-2], rows[1:-1], rows[2:]], axis=1)
    if mode == _FAN:
        faces[:, 0] = rows[0]
    else:
        faces[1::2] = faces[1::2, ::-1]
    return faces


def _read_texture_coordinates(
    file: GltfFile, primitive: Any, faces: Faces, count: int
) -> Points | None:
    """Read the texture coordinates of each corner, shape (m, 3, 2), from the lower left.

    Returns:
        None if there are none, or not one for each vertex.
    """
    if "material" not in primitive or "TEXCOORD_0" not in primitive["attributes"]:
        return None
    points = file.read_accessor(primitive["attributes"]["TEXCOORD_0"])
    if len(points) != count:
        return None
    uv: Points = points[faces].astype(np.float64)
    uv[..., 1] = 1.0 - uv[..., 1]
    return uv


def _read_used_points(file: GltfFile, primitive: Any) -> Points:
    """Read the vertices that triangles use; the corners of the declared box if compressed."""
    number = primitive["attributes"]["POSITION"]
    if file.is_compressed(primitive):
        accessor = file.tree["accessors"][number]
        return _make_box_corners(accessor["min"], accessor["max"])
    values = file.read_accessor(number)
    return select_used(values, _read_faces(file, primitive, len(values)))[0].astype(np.float64)


def _make_box_corners(low: Any, high: Any) -> Points:
    """Return the eight corners of a box, shape (8, 3)."""
    ends = list(zip(low, high, strict=True))
    return np.array([[float(ends[axis][k >> axis & 1]) for axis in range(3)] for k in range(8)])
