"""Surfaces as meshes for three.js: one per color, with vertices split at sharp edges."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..drawing.png_file import encode_png

if TYPE_CHECKING:
    from ..drawing.shapes import Shapes


@dataclass(frozen=True, eq=False)
class RenderMesh:
    """Triangles of one link with one color or one image, in the link's frame.

    Attributes:
        vertices: Points [m], shape (n, 3). Points on a sharp edge occur once per side, so that the
            renderer's averaged vertex normals are smooth only on smooth surfaces.
        faces: Indices into ``vertices``, shape (m, 3).
        rgb: Red, green and blue in 0 … 255.
        opacity: Opacity in 0 … 1.
        glb: The same as binary glTF if it is textured, or None.
    """

    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.uint32]
    rgb: tuple[int, int, int]
    opacity: float
    glb: bytes | None = None


def list_render_meshes(shapes: Shapes) -> Iterator[tuple[str, RenderMesh]]:
    """Yield the surfaces of each link, with its name."""
    bounds = np.searchsorted(shapes.link, np.arange(len(shapes.links) + 1))
    images: dict[int, bytes] = {}
    for row, link in enumerate(shapes.links):
        some = slice(int(bounds[row]), int(bounds[row + 1]))
        if some.start == some.stop:
            continue
        keys = np.column_stack([np.round(shapes.colors[some] * 255), shapes.image[some]])
        kinds, which = np.unique(keys, axis=0, return_inverse=True)
        which = which.reshape(-1)
        for number, kind in enumerate(kinds):
            rows = np.flatnonzero(which == number) + some.start
            yield link, _look(shapes, rows, kind, images)


def compute_link_boxes(shapes: Shapes) -> dict[str, tuple[npt.NDArray[np.float64], ...]]:
    """Return lower and upper corner of each link with triangles, in its own frame [m]."""
    bounds = np.searchsorted(shapes.link, np.arange(len(shapes.links) + 1))
    found: dict[str, tuple[npt.NDArray[np.float64], ...]] = {}
    for row, link in enumerate(shapes.links):
        points = shapes.corners[bounds[row] : bounds[row + 1]].reshape(-1, 3)
        if len(points):
            low, high = points.min(axis=0), points.max(axis=0)
            if link in found:  # links with the same name
                low, high = np.minimum(low, found[link][0]), np.maximum(high, found[link][1])
            found[link] = (low, high)
    return found


def _look(
    shapes: Shapes,
    rows: npt.NDArray[np.intp],
    kind: npt.NDArray[np.float64],
    images: dict[int, bytes],
) -> RenderMesh:
    red, green, blue, alpha, image = kind
    corners = shapes.corners[rows].reshape(-1, 3).astype(np.float32)
    normals = shapes.normals[rows].reshape(-1, 3)
    uv = shapes.uv[rows].reshape(-1, 2)
    columns = [corners.view(np.int32), np.round(normals * 50).astype(np.int32)]
    if image >= 0:
        columns.append(np.ascontiguousarray(uv.astype(np.float32)).view(np.int32))
    first, inverse = _find_distinct(np.concatenate(columns, axis=1))
    vertices = corners[first]
    faces = inverse.reshape(-1, 3).astype(np.uint32)
    rgb, opacity = (int(red), int(green), int(blue)), float(alpha) / 255
    packed = None
    if image >= 0:
        number = int(image)
        if number not in images:
            images[number] = encode_png(
                shapes.images[number][::-1], level=1
            )  # texels are bottom-up
        clear = opacity < 1.0 or bool((shapes.images[number][..., 3] < 255).any())
        rgba = (red / 255, green / 255, blue / 255, opacity)
        packed = encode_glb(
            vertices, faces, normals[first], uv[first], images[number], rgba, clear=clear
        )
    return RenderMesh(vertices, faces, rgb, opacity, packed)


def _find_distinct(
    rows: npt.NDArray[np.int32],
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Find the distinct rows by a 64-bit hash.

    Returns:
        Index of the first row of each group, and the group of each row.
    """
    factors = np.random.default_rng(8733).integers(1, 2**62, rows.shape[1]) * 2 + 1
    with np.errstate(over="ignore"):
        keys = (rows.astype(np.int64) * factors).sum(axis=1)
        keys ^= keys >> 29
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    return first, inverse.reshape(-1)


_FLOAT, _UINT32 = 5126, 5125
"""Types of components, as glTF numbers them."""

_ARRAY, _ELEMENTS = 34962, 34963
"""Targets of buffers, as glTF numbers them."""


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
