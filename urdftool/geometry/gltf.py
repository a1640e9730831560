"""glTF 2.0 (.gltf, .glb): a scene in meters with Y up, as its standard defines.

How the consumers of a robot description read it, according to their sources: RViz (rviz_rendering
since 2025), Drake and Blender rotate the scene by +90° about X so that Y becomes Z. Older releases
of RViz and Gazebo (gz-common's ``AssimpLoader``) keep the file's axes. PyBullet and MuJoCo do not
read glTF. This reader rotates it, as the standard requires, unless the user declares that Z is up
(``--gltf-up z``); a note reports either.
"""

from __future__ import annotations

import json
import os
import struct
from base64 import b64decode
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

from ..errors import MeshError
from .mesh import MeshNote, Piece, Reading

if TYPE_CHECKING:
    from ..source.description import GltfUp

_UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])

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
        MeshError: The file is malformed, or a buffer or an image is missing.
    """
    import trimesh

    try:
        looks, stream = _looks(path)
        scene = trimesh.load_scene(
            stream,
            file_type=path.suffix.lower()[1:],
            process=False,
            resolver=trimesh.resolvers.FilePathResolver(str(path)),
        )
    # the parser raises arbitrary exceptions for malformed files
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the glTF file cannot be read ({reason}); export or fetch it again, with its buffers "
            "beside it and without Draco compression",
            path=path,
        ) from error
    turn = _UPRIGHT if gltf_up == "y" else np.eye(3)
    pieces = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        geometry = scene.geometry[name]
        if not isinstance(geometry, trimesh.Trimesh):
            continue
        linear = turn @ matrix[:3, :3]
        vertices = np.asarray(geometry.vertices, dtype=np.float64) @ linear.T + turn @ matrix[:3, 3]
        faces = np.array(geometry.faces, dtype=np.int64)
        if np.linalg.det(linear) < 0:
            faces = faces[:, ::-1].copy()
        material = getattr(geometry.visual, "material", None)
        texture, image = looks.get(str(getattr(material, "name", "")), (None, None))
        points = getattr(geometry.visual, "uv", None)
        uv = None
        whole = not faces.size or faces.max() < len(vertices)  # load.py rejects others
        if points is not None and len(points) == len(vertices) and whole:
            uv = np.asarray(points, dtype=np.float64)[faces]
        pieces.append(Piece(vertices, faces, str(name), _rgba(material), texture, image, uv))
    return Reading(pieces, [MeshNote("gltf-axes", _NOTES[gltf_up])])


def _rgba(material: Any) -> tuple[float, float, float, float] | None:
    factor = getattr(material, "baseColorFactor", None)
    if factor is None:
        return None
    values = np.asarray(factor)
    scale = 255.0 if values.dtype.kind in "iu" else 1.0
    red, green, blue, alpha = (float(value) / scale for value in values[:4])
    return red, green, blue, alpha


Image = tuple[Path | None, bytes | None]
"""Path of an image file, or the content of an embedded image."""


def _looks(path: Path) -> tuple[dict[str, Image], BytesIO]:
    """Return the base color images by material, and the file with materials renamed to indices."""
    data = path.read_bytes()
    binary = data[:4] == b"glTF"
    rest = b""
    if binary:
        (length,) = struct.unpack_from("<I", data, 12)
        rest = data[20 + length :]
    tree = json.loads(data[20 : 20 + length] if binary else data)
    _check_files(tree, path)
    looks: dict[str, Image] = {}
    for number, material in enumerate(tree.get("materials", ())):
        material["name"] = str(number)
        base = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
        source = tree["textures"][base["index"]].get("source") if base is not None else None
        if source is not None:
            looks[str(number)] = _image(tree, tree["images"][source], path, rest)
    text = json.dumps(tree).encode()
    if not binary:
        return looks, BytesIO(text)
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    return looks, BytesIO(head + text + rest)


def _check_files(tree: dict[str, Any], path: Path) -> None:
    """Raise ValueError if a referenced file is missing, a device or a pipe."""
    for thing in (*tree.get("buffers", ()), *tree.get("images", ())):
        uri = str(thing.get("uri", "data:"))
        if not uri.startswith("data:") and not os.path.isfile(path.parent / unquote(uri)):
            raise ValueError(f"there is no file '{uri}' beside it")


def _image(tree: dict[str, Any], image: dict[str, Any], path: Path, rest: bytes) -> Image:
    uri = str(image.get("uri", ""))
    if uri.startswith("data:"):
        return None, b64decode(uri.partition(",")[2])
    if uri:
        return path.parent / unquote(uri), None
    view = tree["bufferViews"][image["bufferView"]]
    start = view.get("byteOffset", 0)
    buffer = tree["buffers"][view["buffer"]].get("uri")
    if buffer is None:  # the binary chunk, after its header
        content = rest[8:]
    elif buffer.startswith("data:"):
        content = b64decode(buffer.partition(",")[2])
    else:
        content = (path.parent / unquote(buffer)).read_bytes()
    return None, content[start : start + view["byteLength"]]
