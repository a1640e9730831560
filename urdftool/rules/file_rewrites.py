"""Compute the bytes of mesh files that a fix writes, from those of the original files."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ..diagnostic import FileRewrite
from ..errors import MeshError
from ..geometry.stl_header import HEADER_BYTES, TRIANGLE_BYTES, read_stl_header
from ..workspace import Workspace

BINARY, TURNED, WITHOUT_COLLAPSED = "binary STL", "reversed", "without degenerate triangles"
MIRRORED, HEADED, COPIED = "mirrored, as STL, along ", "with another header", "a copy"

_RECORD = struct.Struct("<12fH")

Record = tuple[Any, ...]
"""Normal, three corners and the attribute of a triangle, in one row."""


def compute_rewritten_bytes(workspace: Workspace, rewrite: FileRewrite) -> bytes:
    """Compute the new content of a file.

    Raises:
        MeshError: The original cannot be read.
        OSError: The original cannot be opened.
    """
    try:
        return _rewrite(workspace.materialize(rewrite.origin), rewrite)
    except (ValueError, OverflowError, struct.error) as error:
        raise MeshError(str(error), path=rewrite.origin) from error


def _rewrite(path: Path, rewrite: FileRewrite) -> bytes:
    if rewrite.how == COPIED:
        return path.read_bytes()
    if rewrite.how == HEADED:
        data = path.read_bytes()
        return re.sub(rb"solid", b"STL: ", data[:80], count=1, flags=re.IGNORECASE) + data[80:]
    if rewrite.how == BINARY:
        return _convert_to_binary(path) if _is_text(path) else _as_stl(path, (1.0, 1.0, 1.0))
    if rewrite.how.startswith(MIRRORED):
        axes = rewrite.how.removeprefix(MIRRORED)
        x, y, z = (-1.0 if axis in axes else 1.0 for axis in "xyz")
        return _as_stl(path, (x, y, z))
    head, records = _read_records(path)
    if rewrite.how == TURNED:
        return head + b"".join(_reverse_triangle(record) for record in records)
    kept = [_RECORD.pack(*record) for record in records if not _is_collapsed(record)]
    return head[:80] + struct.pack("<I", len(kept)) + b"".join(kept)


def _is_text(path: Path) -> bool:
    return path.suffix.lower() == ".stl" and read_stl_header(path).kind == "ascii"


def _convert_to_binary(path: Path) -> bytes:
    """Convert ASCII STL to binary STL with the same triangles."""
    data = path.read_bytes()
    rows = re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data, re.IGNORECASE)
    numbers = [float(word) for row in rows for word in row]
    facets = len(re.findall(rb"\bendfacet\b", data, re.IGNORECASE))
    if len(numbers) != 9 * facets or not re.search(rb"\bendsolid\b", data[-1024:], re.IGNORECASE):
        raise MeshError("the ASCII STL file is incomplete", path=path)
    return _write_triangles(numbers[at : at + 9] for at in range(0, len(numbers), 9))


def _as_stl(path: Path, scale: tuple[float, float, float]) -> bytes:
    """Convert the triangles of any mesh file to STL, in its own frame, scaled by 1 or -1."""
    from ..geometry.load import load_mesh

    mesh = load_mesh(path, scale)
    return _write_triangles(mesh.vertices[mesh.faces].reshape(-1, 9).tolist())


def _write_triangles(triangles: Iterable[list[float]]) -> bytes:
    rows = [_RECORD.pack(*_compute_normal(corners), *corners, 0) for corners in triangles]
    return b"".join((b"\0" * 80, struct.pack("<I", len(rows)), *rows))


def _compute_cross(corners: tuple[float, ...] | list[float]) -> tuple[float, float, float]:
    a, b, c, d, e, f, g, h, i = corners
    d, e, f, g, h, i = d - a, e - b, f - c, g - a, h - b, i - c
    return e * i - f * h, f * g - d * i, d * h - e * g


def _compute_normal(corners: list[float]) -> tuple[float, float, float]:
    x, y, z = _compute_cross(corners)
    length = math.hypot(x, y, z) or 1.0
    return x / length, y / length, z / length


def _read_records(path: Path) -> tuple[bytes, Iterator[Record]]:
    """Read the header and the triangles of a binary STL file."""
    facts = read_stl_header(path)
    if facts.kind != "binary" or not facts.size_agrees:
        raise MeshError("is not a binary STL file", path=path)
    data = path.read_bytes()
    whole = HEADER_BYTES + TRIANGLE_BYTES * (facts.triangles or 0)
    return data[:HEADER_BYTES], _RECORD.iter_unpack(data[HEADER_BYTES:whole])


def _reverse_triangle(record: Record) -> bytes:
    normal, (a, b, c), attribute = record[:3], (record[3:6], record[6:9], record[9:12]), record[12]
    return _RECORD.pack(*(0.0 - value for value in normal), *a, *c, *b, attribute)


def count_collapsed(workspace: Workspace, path: Path) -> int:
    """Count the triangles of a binary STL file with two coinciding corners.

    Raises:
        MeshError: It is not a binary STL file.
        OSError: It cannot be read.
    """
    return sum(map(_is_collapsed, _read_records(workspace.materialize(path))[1]))


def _is_collapsed(record: Record) -> bool:
    """Tell whether two corners of a triangle coincide, so that removing it leaves no hole."""
    a, b, c = record[3:6], record[6:9], record[9:12]
    return a == b or b == c or c == a
