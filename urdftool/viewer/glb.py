"""Encoding of a textured mesh as binary glTF (glTF 2.0 specification)."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

_FLOAT, _UINT32 = 5126, 5125
_ARRAY, _ELEMENTS = 34962, 34963


def encode_glb(
    vertices: npt.NDArray[np.float32],
    faces: npt.NDArray[np.uint32],
    normals: npt.NDArray[np.float64],
    uv: npt.NDArray[np.float64],
    image: bytes,
    rgba: tuple[float, float, float, float],
    *,
    clear: bool,
) -> bytes:
    """Encode one mesh with one image as a GLB file.

    Args:
        vertices: Points [m], shape (n, 3); axes are unchanged.
        faces: Indices into ``vertices``, shape (m, 3).
        normals: Unit normals, shape (n, 3).
        uv: Texture coordinates of the points from the image's lower left corner, shape (n, 2).
        image: The image as a PNG file.
        rgba: Factors of the image's channels.
        clear: Whether the mesh is transparent.
    """
    down = np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1)  # glTF counts v from the top
    pieces = [
        np.ascontiguousarray(vertices, dtype="<f4").tobytes(),
        np.ascontiguousarray(normals, dtype="<f4").tobytes(),
        np.ascontiguousarray(np.where(np.isfinite(down), down, 0.0), dtype="<f4").tobytes(),
        np.ascontiguousarray(faces, dtype="<u4").tobytes(),
        image,
    ]
    views, blob = [], b""
    for number, piece in enumerate(pieces):
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(blob), "byteLength": len(piece)}
        if number < 4:
            view["target"] = _ELEMENTS if number == 3 else _ARRAY
        views.append(view)
        blob += piece + b"\0" * (-len(piece) % 4)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
                        "indices": 3,
                        "material": 0,
                    }
                ]
            }
        ],
        "materials": [
            {
                "pbrMetallicRoughness": {
                    "baseColorTexture": {"index": 0},
                    "baseColorFactor": [float(part) for part in rgba],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 1.0,
                },
                "alphaMode": "BLEND" if clear else "OPAQUE",
                "doubleSided": True,
            }
        ],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 10497, "wrapT": 10497}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": _FLOAT,
                "count": len(vertices),
                "type": "VEC3",
                "min": [float(v) for v in vertices.min(axis=0)],
                "max": [float(v) for v in vertices.max(axis=0)],
            },
            {"bufferView": 1, "componentType": _FLOAT, "count": len(vertices), "type": "VEC3"},
            {"bufferView": 2, "componentType": _FLOAT, "count": len(vertices), "type": "VEC2"},
            {"bufferView": 3, "componentType": _UINT32, "count": faces.size, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": len(blob)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(blob), b"BIN\0") + blob
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
