"""Filter of the files that an export copies: only meshes, images and their companion files.

A description may be untrusted, and an export is passed on. ``source.access`` decides which files
are read. Their content decides which of those are copied: a mesh has a triangle and the size that
its header implies, and an image has a valid header. A text, a database or an archive with the
suffix of a mesh is not copied.
"""

from __future__ import annotations

import json
import os
import re
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...errors import MeshError
from ...geometry.stl_header import is_lfs_pointer, read_stl_header

_HEAD = 65536
"""Bytes by which the kind of a file is recognized. Chosen, no source."""

_NUMBER = rb"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?"
_POINT = re.compile(rb"(?m)^[ \t]*v(?:[ \t]+" + _NUMBER + rb"){3}")
_FACE = re.compile(rb"(?m)^[ \t]*f(?:[ \t]+-?\d+(?:/-?\d*){0,2}(?:[ \t]*\\\r?\n)?){3}")
_STL_CORNERS = re.compile(rb"(?i)(?:\bvertex(?:\s+" + _NUMBER + rb"){3}\s+){3}")
_PLY_FACES = re.compile(rb"(?m)^element[ \t]+(?:face|tristrips)[ \t]+0*[1-9]")
_MATERIAL = re.compile(rb"(?m)^[ \t]*newmtl[ \t]")
_DAE_MESH = re.compile(r"<(?:\w+:)?(?:triangles|polylist|polygons|tristrips|trifans)\b")
_FBX_MESH = (b"PolygonVertexIndex", b"Vertices")


def explain_uncopied(path: Path, *, is_mesh: bool) -> str:
    """Explain why a file, a mesh or an image, is not copied to an export; return "" if it is."""
    if is_mesh:
        return explain_invalid_mesh(path)
    return "" if is_image(path) else "it is not an image"


def explain_invalid_mesh(path: Path) -> str:
    """Explain why a file is not a mesh of the format of its suffix; return "" if it is one."""
    suffix = path.suffix.lower()
    looks = _MESHES.get(suffix)
    if looks is None:
        return f"'{suffix}' is not a mesh format; supported are {', '.join(s[1:] for s in _MESHES)}"
    if not os.path.isfile(path):  # a device or pipe may never end
        return "it is not a file"
    try:
        if is_lfs_pointer(path):
            return "the file is a Git LFS pointer; fetch the mesh with `git lfs pull`"
        return "" if looks(path) else f"there is no {suffix[1:].upper()} mesh in it"
    except (OSError, MeshError) as error:
        return str(getattr(error, "strerror", None) or error)


def is_image(path: Path) -> bool:
    """Tell whether a file is an image, by its header and, where Pillow reads it, by Pillow."""
    head = _get_head(path)
    looks = next((looks for start, looks in _IMAGES.items() if head.startswith(start)), None)
    if looks is None:
        looks = _is_tga if path.suffix.lower() == ".tga" and path.resolve().suffix else None
    return looks is not None and looks(head, os.path.getsize(path)) and _is_read_by_pillow(path)


def is_companion(path: Path) -> bool:
    """Tell whether a mesh may refer to a file: an image, an OBJ material, or a glTF buffer."""
    suffix = path.suffix.lower()
    if suffix == ".mtl":
        return _MATERIAL.search(_get_head(path)) is not None
    if suffix == ".bin":  # has no signature; a symbolic link could point to any file
        return path.resolve().suffix.lower() == ".bin"
    return is_image(path)


def _get_head(path: Path) -> bytes:
    if not os.path.isfile(path):  # a device or pipe may never end
        return b""
    with open(path, "rb") as stream:
        return stream.read(_HEAD)


def _is_read_by_pillow(path: Path) -> bool:
    """Tell whether Pillow identifies an image; True for formats that it does not read."""
    try:
        from PIL import Image
    except ImportError:
        return True
    try:
        with Image.open(path):
            return True
    except Image.DecompressionBombError:
        return True  # a large image
    except Exception:  # Pillow raises arbitrary exceptions for damaged files
        return _get_head(path).startswith(_WITHOUT_PILLOW)


def _is_stl(path: Path) -> bool:
    facts = read_stl_header(path)
    if facts.kind == "ascii":
        _, _, facets = _get_head(path).lower().partition(b"facet")
        return _STL_CORNERS.search(facets) is not None
    return bool(facts.triangles) and facts.size_agrees


def _is_obj(path: Path) -> bool:
    data = path.read_bytes()
    return _POINT.search(data) is not None and _FACE.search(data) is not None


def _is_dae(path: Path) -> bool:
    data = path.read_bytes()
    text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8", "replace")
    return "<COLLADA" in text[:_HEAD] and _DAE_MESH.search(text) is not None


def _is_ply(path: Path) -> bool:
    head = _get_head(path)
    return head.startswith((b"ply\n", b"ply\r")) and _PLY_FACES.search(head) is not None


def _is_gltf(path: Path) -> bool:
    return _has_primitive(path.read_bytes())


def _is_glb(path: Path) -> bool:
    data = path.read_bytes()
    if len(data) < 20:
        return False
    magic, _, size, length, kind = struct.unpack_from("<4sII I4s", data)
    is_whole = magic == b"glTF" and size == len(data) and kind == b"JSON"
    return is_whole and _has_primitive(data[20 : 20 + length])


def _has_primitive(data: bytes) -> bool:
    """Tell whether a glTF document has a mesh with positions."""
    try:
        document: Any = json.loads(data)
        meshes = document["meshes"]
        return isinstance(document["asset"]["version"], str) and any(
            "POSITION" in primitive["attributes"]
            for mesh in meshes
            for primitive in mesh["primitives"]
        )
    except (ValueError, LookupError, TypeError, RecursionError):
        return False


def _is_fbx(path: Path) -> bool:
    data = path.read_bytes()
    starts = (b"Kaydara FBX Binary  \0", b"; FBX")
    return data.startswith(starts) and all(word in data for word in _FBX_MESH)


def _is_3ds(path: Path) -> bool:
    data = path.read_bytes()
    has_size = data[:2] == b"MM" and int.from_bytes(data[2:6], "little") == len(data)
    return has_size and b"\x20\x41" in data  # a list of faces


_MESHES: dict[str, Callable[[Path], bool]] = {
    ".stl": _is_stl,
    ".obj": _is_obj,
    ".dae": _is_dae,
    ".ply": _is_ply,
    ".gltf": _is_gltf,
    ".glb": _is_glb,
    ".fbx": _is_fbx,
    ".3ds": _is_3ds,
}


def _has_content(head: bytes, size: int) -> bool:
    return size > 12


def _is_png(head: bytes, size: int) -> bool:
    return (
        size >= 33
        and head[12:16] == b"IHDR"
        and all(0 < side <= 1 << 24 for side in struct.unpack_from(">II", head, 16))
    )


def _is_jpeg(head: bytes, size: int) -> bool:
    return size > 100 and head[3] >= 0xC0


def _is_bmp(head: bytes, size: int) -> bool:
    if size < 30:
        return False
    start, length = struct.unpack_from("<II", head, 10)
    return 26 <= start < size and length in (12, 40, 52, 56, 64, 108, 124)


def _is_tiff(head: bytes, size: int) -> bool:
    order = "<I" if head[:2] == b"II" else ">I"
    return size > 8 and 8 <= struct.unpack_from(order, head, 4)[0] < size


def _is_webp(head: bytes, size: int) -> bool:
    return head[8:12] == b"WEBP" and size >= struct.unpack_from("<I", head, 4)[0]


def _is_tga(head: bytes, size: int) -> bool:
    """Tell whether the head is a Truevision header, a format without a signature."""
    if size < 18 or head[1] not in (0, 1) or head[2] not in (1, 2, 3, 9, 10, 11):
        return False
    width, height = struct.unpack_from("<HH", head, 12)
    if not width or not height or head[16] not in (8, 15, 16, 24, 32):
        return False
    return head[2] > 3 or size >= 18 + width * height * ((head[16] + 7) // 8)


_WITHOUT_PILLOW = (b"#?RADIANCE", b"\x76\x2f\x31\x01", b"\xabKTX")
_IMAGES: dict[bytes | tuple[bytes, ...], Callable[[bytes, int], bool]] = {
    b"\x89PNG\r\n\x1a\n": _is_png,
    b"\xff\xd8\xff": _is_jpeg,
    (b"GIF87a", b"GIF89a"): _has_content,
    b"BM": _is_bmp,
    (b"II*\0", b"MM\0*"): _is_tiff,
    b"RIFF": _is_webp,
    (b"DDS ", b"8BPS", *_WITHOUT_PILLOW): _has_content,
}
