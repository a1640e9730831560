"""glTF 2.0 (.gltf, .glb): a scene in metres with Y up, by its own standard.

What the consumers of a robot description do, read in their sources: RViz turns the scene by +90°
about X so that Y becomes Z (rviz_rendering since 2025; older releases show it lying), and so do
Drake and Blender. Gazebo (gz-common's ``AssimpLoader``) keeps the file's axes. PyBullet and MuJoCo
do not read glTF. It is turned here, as the standard means it and RViz shows it, unless the user
says that Z is up in the file already (``--gltf-up z``); a note says so.
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
    """The triangles of a glTF scene, one piece for each primitive of each instance.

    Args:
        path: The file.
        gltf_up: The axis of the file that is up; ``y`` is turned so that it becomes Z.
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
    # the parser meets malformed files with whatever its arithmetic raises
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
        whole = not faces.size or faces.max() < len(vertices)  # else refused with its number
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
"""A file, or the image itself."""


def _looks(path: Path) -> tuple[dict[str, Image], BytesIO]:
    """The images of base colours by material, and the file with its materials named by number."""
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
    """Refuse what is no file: a device or a pipe is read without end."""
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
    if buffer is None:  # the binary chunk, after its own head
        content = rest[8:]
    elif buffer.startswith("data:"):
        content = b64decode(buffer.partition(",")[2])
    else:
        content = (path.parent / unquote(buffer)).read_bytes()
    return None, content[start : start + view["byteLength"]]
