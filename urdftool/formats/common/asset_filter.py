"""Filter of the files that an export copies: only meshes, images and their companion files.

A description may be untrusted, and an export is passed on. A mesh or texture path such as
``/home/me/.ssh/id_rsa``, or a symbolic link to it, must not be copied. Therefore the content of
each file is checked before it is copied.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

from ...errors import MeshError
from ...geometry.stl_header import is_lfs_pointer, read_stl_header

_HEAD = 65536
_TGA_KINDS = (1, 2, 3, 9, 10, 11)
_STARTS = (
    *(b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"GIF8", b"BM", b"II*\0", b"MM\0*", b"DDS "),
    *(b"#?RADIANCE", b"\x76\x2f\x31\x01", b"\xabKTX", b"8BPS"),
)
_POINT = re.compile(rb"(?m)^\s*v[ \t]+[-+.\d]")
_FACE = re.compile(rb"(?m)^\s*f[ \t]+[-\d]")
_MATERIAL = re.compile(rb"(?m)^\s*newmtl\s")


def explain_invalid_mesh(path: Path) -> str:
    """Explain why a file is not a mesh of the format of its suffix; return "" if it is one."""
    suffix = path.suffix.lower()
    looks = _MESHES.get(suffix)
    if looks is None:
        return f"'{suffix}' is not a mesh format; supported are {', '.join(s[1:] for s in _MESHES)}"
    try:
        if is_lfs_pointer(path):
            return "the file is a Git LFS pointer; fetch the mesh with `git lfs pull`"
        return "" if looks(path) else f"there is no {suffix[1:].upper()} mesh in it"
    except (OSError, MeshError) as error:
        return str(getattr(error, "strerror", None) or error)


def is_image(path: Path) -> bool:
    """Tell whether a file is an image, by its first bytes."""
    head = _get_head(path)
    return head.startswith(_STARTS) or head[8:12] == b"WEBP" or _is_tga(path, head)


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


def _is_tga(path: Path, head: bytes) -> bool:
    """Tell whether the head is a Truevision header, a format without a signature."""
    if path.suffix.lower() != ".tga" or len(head) < 18:
        return False
    return head[1] in (0, 1) and head[2] in _TGA_KINDS and head[16] in (8, 15, 16, 24, 32)


def _is_stl(path: Path) -> bool:
    facts = read_stl_header(path)
    if facts.kind == "ascii":
        return b"facet" in _get_head(path).lower()
    return facts.expected_bytes is not None and facts.bytes >= facts.expected_bytes


def _is_obj(path: Path) -> bool:
    data = path.read_bytes()
    return _POINT.search(data) is not None and (b"\nf " in data or _FACE.search(data) is not None)


def _make_prefix_test(*words: bytes) -> Callable[[Path], bool]:
    return lambda path: _get_head(path).startswith(words)


def _has(*words: bytes) -> Callable[[Path], bool]:
    return lambda path: any(word in _get_head(path) for word in words)


_MESHES: dict[str, Callable[[Path], bool]] = {
    ".stl": _is_stl,
    ".obj": _is_obj,
    ".dae": _has(b"<COLLADA", "<COLLADA".encode("utf-16-le"), "<COLLADA".encode("utf-16-be")),
    ".ply": _make_prefix_test(b"ply"),
    ".gltf": _has(b'"asset"'),
    ".glb": _make_prefix_test(b"glTF"),
    ".fbx": _make_prefix_test(b"Kaydara FBX Binary", b"; FBX"),
    ".3ds": _make_prefix_test(b"MM"),
}
