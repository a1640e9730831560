"""Mesh files in another format: binary STL, OBJ with materials, and GLB with textures."""

from __future__ import annotations

import json
import struct
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ..drawing.normals import compute_corner_normals
from ..geometry.color import convert_to_linear
from ..geometry.mesh import Array, Faces, Mesh, Part, Points
from ..source.description import GltfUp

MeshFormat = Literal["stl", "obj", "glb", "dae"]

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
GRAY = (0.7, 0.7, 0.7, 1.0)
"""Color of parts without one. Chosen, no source."""
_FLOAT, _UINT32 = 5126, 5125
"""Types of components in glTF 2.0, section 3.6.2.2: 32-bit floats, unsigned integers."""

_ARRAY, _ELEMENTS = 34962, 34963
"""Targets of buffer views in glTF 2.0, section 5.11: vertices, indices."""

_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class MaterialNames:
    """Names of the companions of an OBJ file.

    Attributes:
        library: Name of the MTL file; empty for a mesh without colors and images.
        images: Names of the images, by the number of the part; parts without an image are missing.
    """

    library: str
    images: dict[int, str]


def read_image(part: Part, companions: Collection[Path]) -> bytes | None:
    """Return the image of a part's material; None if it has none or the file is not collected.

    Args:
        part: Part of a mesh.
        companions: Real paths of the images that the bundle may contain.
    """
    if part.uv is None:
        return None
    if part.image is not None:
        return part.image
    try:
        if part.texture is None or part.texture.resolve() not in companions:
            return None
        return part.texture.read_bytes()
    except OSError:
        return None


def get_image_suffix(data: bytes) -> str:
    """Return the suffix of an image file, by its first bytes."""
    return ".png" if data.startswith(_PNG) else ".jpg"


def encode_stl(mesh: Mesh) -> bytes:
    """Encode a mesh as binary STL."""
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    records = np.zeros(len(corners), dtype=_RECORD)
    records["normal"] = normals / np.where(lengths > 0, lengths, 1.0)
    records["corners"] = corners
    head = b"mesh bundled by urdftool".ljust(80, b"\0")
    return head + struct.pack("<I", len(corners)) + records.tobytes()


def encode_obj(mesh: Mesh, names: MaterialNames, shading: Array | None = None) -> bytes:
    """Encode a mesh as OBJ without groups, since MuJoCo reads the first object only.

    Args:
        mesh: The mesh.
        names: Names of the companions.
        shading: Unit normal at each corner, shape (m, 3, 3); None computes them.
    """
    if shading is None:
        shading = compute_corner_normals(mesh.vertices, mesh.faces)
    normals, normal_of = number_rows(shading)
    lines = ["# Mesh bundled by urdftool"]
    if names.library:
        lines.append(f"mtllib {names.library}")
    lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in (mesh.vertices + 0.0).tolist()]
    lines += [f"vn {x:.4f} {y:.4f} {z:.4f}" for x, y, z in (normals + 0.0).tolist()]
    first = 1
    for number, part in enumerate(mesh.parts):
        if names.library:
            lines.append(f"usemtl material_{number}")
        faces = (mesh.get_part_faces(part) + 1).tolist()
        rows = (normal_of[part.first : part.first + part.count] + 1).tolist()
        if number in names.images and part.uv is not None:
            points, texel_of = number_rows(part.uv)
            lines += [f"vt {u:.6g} {v:.6g}" for u, v in (points + 0.0).tolist()]
            texels = (texel_of + first).tolist()
            first += len(points)
            lines += [
                f"f {a}/{ta}/{na} {b}/{tb}/{nb} {c}/{tc}/{nc}"
                for (a, b, c), (ta, tb, tc), (na, nb, nc) in zip(faces, texels, rows, strict=True)
            ]
        else:
            lines += [
                f"f {a}//{na} {b}//{nb} {c}//{nc}"
                for (a, b, c), (na, nb, nc) in zip(faces, rows, strict=True)
            ]
    return ("\n".join(lines) + "\n").encode()


def encode_mtl(mesh: Mesh, names: MaterialNames) -> bytes:
    """Encode the materials of an OBJ file."""
    lines = ["# Materials bundled by urdftool"]
    for number, part in enumerate(mesh.parts):
        red, green, blue, opacity = part.rgba or GRAY
        lines += [f"newmtl material_{number}", f"Kd {red:.6g} {green:.6g} {blue:.6g}"]
        lines += [f"d {opacity:.6g}"]
        if number in names.images:
            lines.append(f"map_Kd {names.images[number]}")
    return ("\n".join(lines) + "\n").encode()


def encode_glb(
    mesh: Mesh, gltf_up: GltfUp, companions: Collection[Path], shading: Array | None = None
) -> bytes:
    """Encode a mesh as binary glTF with its images.

    Args:
        mesh: The mesh.
        gltf_up: Up axis of the file: ``y`` as in the standard, or ``z``.
        companions: Real paths of the images that the bundle may contain.
        shading: Unit normal at each corner, shape (m, 3, 3); None computes them.
    """
    buffer = _Buffer()
    normals = shading
    if normals is None:
        normals = compute_corner_normals(mesh.vertices, mesh.faces)
    primitives = []
    for part in mesh.parts:
        rows = slice(part.first, part.first + part.count)
        image = read_image(part, companions)
        uv = part.uv if image is not None else None
        primitives.append(
            _encode_part(buffer, mesh.vertices, mesh.faces[rows], normals[rows], uv, gltf_up)
        )
        if part.rgba is not None or image is not None:
            primitives[-1]["material"] = buffer.add_material(part, image)
    return buffer.encode({"primitives": primitives})


def describe_losses(mesh: Mesh, target: MeshFormat) -> tuple[str, ...]:
    """Describe what a format does not hold of a mesh, and what was not read of it."""
    losses = [note.message for note in mesh.notes if note.lossy]
    if target == "stl" and any(part.rgba or part.uv is not None for part in mesh.parts):
        losses.append("STL has no colors and no textures")
    return tuple(losses)


def _encode_part(
    buffer: _Buffer,
    vertices: Points,
    faces: Faces,
    normals: Array,
    uv: Points | None,
    gltf_up: GltfUp,
) -> dict[str, Any]:
    """Add a part to the buffer; return its primitive."""
    columns = [vertices[faces].reshape(-1, 3), normals.reshape(-1, 3)]
    if gltf_up == "y":
        columns = [np.stack([c[:, 0], c[:, 2], -c[:, 1]], axis=1) for c in columns]
    if uv is not None:
        flat = uv.reshape(-1, 2)
        columns.append(np.stack([flat[:, 0], 1.0 - flat[:, 1]], axis=1))
    rows, numbers = np.unique(
        np.concatenate(columns, axis=1).astype("<f4"), axis=0, return_inverse=True
    )
    attributes = {
        "POSITION": buffer.add_array(rows[:, :3], bounds=True),
        "NORMAL": buffer.add_array(rows[:, 3:6]),
    }
    if uv is not None:
        attributes["TEXCOORD_0"] = buffer.add_array(rows[:, 6:])
    return {"attributes": attributes, "indices": buffer.add_indices(numbers)}


class _Buffer:
    """Binary chunk and lists of a glTF file."""

    def __init__(self) -> None:
        self._blob = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._materials: list[dict[str, Any]] = []
        self._images: list[dict[str, Any]] = []
        self._known_images: dict[bytes, int] = {}

    def add_array(self, rows: Any, *, bounds: bool = False) -> int:
        """Add vectors; return the number of the accessor."""
        data = np.ascontiguousarray(np.where(np.isfinite(rows), rows, 0.0), dtype="<f4")
        kind = "VEC3" if data.shape[1] == 3 else "VEC2"
        accessor: dict[str, Any] = {"componentType": _FLOAT, "count": len(data), "type": kind}
        if bounds:
            accessor["min"] = [float(value) for value in data.min(axis=0)]
            accessor["max"] = [float(value) for value in data.max(axis=0)]
        return self._add_accessor(accessor, data.tobytes(), _ARRAY)

    def add_indices(self, numbers: Any) -> int:
        """Add indices; return the number of the accessor."""
        data = np.ascontiguousarray(numbers, dtype="<u4").reshape(-1)
        accessor = {"componentType": _UINT32, "count": len(data), "type": "SCALAR"}
        return self._add_accessor(accessor, data.tobytes(), _ELEMENTS)

    def add_material(self, part: Part, image: bytes | None) -> int:
        """Add the material of a part; return its number."""
        rgba = part.rgba or GRAY
        surface: dict[str, Any] = {
            "baseColorFactor": [*map(convert_to_linear, rgba[:3]), float(rgba[3])],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        }
        if image is not None:
            if image not in self._known_images:
                kind = "image/png" if image.startswith(_PNG) else "image/jpeg"
                view = self._add_view(image)
                self._known_images[image] = len(self._images)
                self._images.append({"bufferView": view, "mimeType": kind})
            surface["baseColorTexture"] = {"index": self._known_images[image]}
            surface["baseColorFactor"] = [1.0, 1.0, 1.0, float(rgba[3])]
        material: dict[str, Any] = {"pbrMetallicRoughness": surface, "doubleSided": True}
        if rgba[3] < 1:
            material["alphaMode"] = "BLEND"
        self._materials.append(material)
        return len(self._materials) - 1

    def encode(self, mesh: dict[str, Any]) -> bytes:
        """Return the GLB file of a mesh."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "urdftool"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [mesh],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._blob)}],
        }
        if self._materials:
            document["materials"] = self._materials
        if self._images:
            document["images"] = self._images
            document["textures"] = [{"source": number} for number in range(len(self._images))]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self._blob), b"BIN\0") + bytes(self._blob)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def _add_accessor(self, accessor: dict[str, Any], data: bytes, target: int) -> int:
        self._accessors.append({"bufferView": self._add_view(data, target), **accessor})
        return len(self._accessors) - 1

    def _add_view(self, data: bytes, target: int = 0) -> int:
        view = {"buffer": 0, "byteOffset": len(self._blob), "byteLength": len(data)}
        self._views.append({**view, "target": target} if target else view)
        self._blob += data + b"\0" * (-len(data) % 4)
        return len(self._views) - 1


def number_rows(values: Array) -> tuple[Array, Faces]:
    """Return the distinct rows of the last axis, and the number of each row by face and corner."""
    flat = np.round(values.reshape(-1, values.shape[-1]), 6)
    rows, numbers = np.unique(flat, axis=0, return_inverse=True)
    return rows, numbers.reshape(values.shape[:-1]).astype(np.int64)
