"""PLY, text and binary: triangles and polygons of one object; it declares no unit."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import numpy as np

from ..errors import MeshError
from .limits import check_instances
from .mesh import Piece, Reading

_SIZES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "float", "int32", "uint32", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}


def read(path: Path) -> Reading:
    """Read the faces of a PLY file; vertex colors are ignored.

    Raises:
        MeshError: The file is malformed, has no faces, or its polygons have too many triangles.
    """
    import trimesh

    size = path.stat().st_size
    check_instances(path, size, triangles=_count_triangles(path.read_bytes()))
    try:
        mesh = trimesh.load_mesh(path, file_type="ply", process=False, skip_materials=True)
    # the parser raises arbitrary exceptions for malformed files
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the PLY file cannot be read ({reason}); export or fetch it again", path=path
        ) from error
    faces = getattr(mesh, "faces", None)
    if faces is None or len(faces) == 0:
        raise MeshError("the PLY file has points and no faces; a mesh needs triangles", path=path)
    check_instances(path, size, triangles=len(faces))
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    return Reading([Piece(vertices, np.asarray(faces, dtype=np.int64))], [])


def _count_triangles(data: bytes) -> int:
    """Count the triangles of the polygons before trimesh makes them, which takes much memory.

    Returns:
        0 if the file is malformed, or its faces do not begin with the list of their corners.
    """
    try:
        return sum(max(corners - 2, 0) for corners in _list_corner_counts(data))
    except (ValueError, LookupError):
        return 0


def _list_corner_counts(data: bytes) -> Iterator[int]:
    """Yield the number of corners of each face.

    Raises:
        LookupError, ValueError: The file is malformed.
    """
    head, _, body = data.partition(b"end_header")
    body = body.partition(b"\n")[2]
    lines = [line.split() for line in head.decode("ascii", "replace").splitlines()]
    kind = next((words[1] for words in lines if words[:1] == ["format"]), "")
    start = width = rows = 0
    is_face = False
    properties: list[list[str]] = []
    for words in lines:
        if words[:1] == ["element"] and is_face:
            break
        if words[:1] == ["element"]:
            start += rows * width
            is_face, rows, width = words[1] == "face", int(words[2]), int(kind == "ascii")
        elif words[:1] == ["property"] and is_face:
            properties.append(words[1:])
        elif words[:1] == ["property"] and kind != "ascii":
            width += _SIZES[words[1]]
    if not properties or properties[0][0] != "list":
        return
    if kind == "ascii":
        for line in body.split(b"\n")[start : start + rows]:
            yield int(line.split(None, 1)[0])
        return
    counter, item = _SIZES[properties[0][1]], _SIZES[properties[0][2]]
    order: Literal["little", "big"] = "big" if "big" in kind else "little"
    rest = sum(_SIZES[words[0]] for words in properties[1:])
    for _ in range(rows):
        corners = int.from_bytes(body[start : start + counter], order)
        start += counter + corners * item + rest
        if start > len(body):
            return
        yield corners
