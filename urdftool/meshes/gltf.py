"""glTF 2.0 (.gltf, .glb): a scene in metres with Y up, by its own standard.

What the consumers of a robot description do, read in their sources: RViz turns the scene by +90°
about X so that Y becomes Z (rviz_rendering since 2025; older releases show it lying), and so do
Drake and Blender. Gazebo (gz-common's ``AssimpLoader``) keeps the file's axes. PyBullet and MuJoCo
do not read glTF. It is turned here, as the standard means it and RViz shows it, unless the caller
says otherwise; a note says so.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from ..errors import MeshError
from .mesh import Piece, Reading

_UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def read(path: Path, *, upright: bool = True) -> Reading:
    """The triangles of a glTF scene, one piece for each primitive of each instance.

    Args:
        path: The file.
        upright: Turn the scene so that its Y axis becomes Z.
    """
    import trimesh

    try:
        scene = trimesh.load_scene(path, file_type=path.suffix.lower()[1:], process=False)
        textures = _textures(path)
    # the parser meets malformed files with whatever its arithmetic raises
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the glTF file cannot be read ({reason}); export or fetch it again, with its buffers "
            "beside it and without Draco compression",
            path=path,
        ) from error
    turn = _UPRIGHT if upright else np.eye(3)
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
        texture = textures.get(str(getattr(material, "name", "")))
        pieces.append(Piece(vertices, faces, str(name), _rgba(material), texture))
    how = "turned to Z: RViz does, Gazebo does not" if upright else "not turned, as in Gazebo"
    return Reading(pieces, [f"The up axis of a glTF file is Y, {how}."])


def _rgba(material: Any) -> tuple[float, float, float, float] | None:
    factor = getattr(material, "baseColorFactor", None)
    if factor is None:
        return None
    values = np.asarray(factor)
    scale = 255.0 if values.dtype.kind in "iu" else 1.0
    red, green, blue, alpha = (float(value) / scale for value in values[:4])
    return red, green, blue, alpha


def _textures(path: Path) -> dict[str, Path]:
    """Base colour images that are files of their own, by the name of their material."""
    data = path.read_bytes()
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        data = data[20 : 20 + length]
    tree = json.loads(data)
    found = {}
    for material in tree.get("materials", ()):
        base = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
        if base is None:
            continue
        source = tree["textures"][base["index"]].get("source")
        uri = tree["images"][source].get("uri", "") if source is not None else ""
        if uri and not uri.startswith("data:"):
            found[str(material.get("name", ""))] = path.parent / unquote(uri)
    return found
