"""STL, binary and text: triangles without objects or colors; it declares no unit."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ..errors import MeshError
from .mesh import MeshNote, Piece, Points, Reading
from .stl_header import HEADER_BYTES, TRIANGLE_BYTES, StlHeader, read_stl_header

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
_CHUNK = 500_000  # triangles read at a time; chosen


def read(path: Path) -> Reading:
    """Read the triangles of an STL file; normals and attribute bytes are ignored.

    Bytes after the last triangle of a binary file are ignored with a note, as in RViz and Gazebo.

    Raises:
        MeshError: The file is truncated or is not an STL file.
    """
    header = read_stl_header(path)
    notes: list[MeshNote] = []
    if header.kind == "ascii":
        corners = _read_whole_text(path)
    else:
        _require_whole(path, header, notes)
        corners = read_corners(path, header)
    faces = np.arange(len(corners), dtype=np.int64).reshape(-1, 3)
    return Reading([Piece(corners, faces)], notes)


def read_corners(
    path: Path, header: StlHeader, *, first: int = 0, count: int | None = None
) -> Points:
    """Read the corners of triangles, shape (3 n, 3), in the file's unit.

    Args:
        path: An STL file.
        header: Its header; a binary one must not claim more triangles than the file has.
        first: First triangle to read, for binary files.
        count: Largest number of triangles to read, for binary files; None for all.

    Raises:
        ValueError: A corner of a text file is not three numbers.
    """
    if header.kind == "ascii":
        return np.array(_VERTEX.findall(path.read_bytes()), dtype=np.float64)
    left = (header.triangles or 0) - first
    records = np.fromfile(
        path,
        dtype=_RECORD,
        count=left if count is None else min(count, left),
        offset=HEADER_BYTES + TRIANGLE_BYTES * first,
    )
    corners: Points = records["corners"].reshape(-1, 3).astype(np.float64)
    return corners


def compute_stl_bounds(
    path: str | Path,
) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
    """Compute lower and upper corner of a binary STL file's bounding box, in the file's unit.

    Returns:
        None for a text file, a file without triangles, or a coordinate that is not finite.

    Raises:
        OSError: The file cannot be read.
    """
    file = Path(path)
    header = read_stl_header(file)
    if header.kind != "binary" or not header.triangles:
        return None
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    whole = min(header.triangles, (header.bytes - HEADER_BYTES) // TRIANGLE_BYTES)
    for first in range(0, whole, _CHUNK):
        corners = read_corners(file, header, first=first, count=min(_CHUNK, whole - first))
        if not np.isfinite(corners).all():
            return None
        low, high = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))
    if whole <= 0:
        return None
    (a, b, c), (d, e, f) = low.tolist(), high.tolist()
    return (a, b, c), (d, e, f)


def sample_extent(path: Path, header: StlHeader, count: int) -> tuple[float, float, float] | None:
    """Measure the bounding box of triangles from the beginning, the middle and the end of a file.

    Args:
        path: A binary STL file.
        header: Its header; it must not claim more triangles than the file has.
        count: Triangles of each sample.

    Returns:
        Lengths along x, y, z in the file's unit; None if one is not finite.
    """
    last = max(0, (header.triangles or 0) - count)
    firsts = sorted({0, last // 2, last})
    samples = [read_corners(path, header, first=first, count=count) for first in firsts]
    x, y, z = np.ptp(np.concatenate(samples), axis=0).tolist()
    return (x, y, z) if np.isfinite((x, y, z)).all() else None


def _require_whole(path: Path, header: StlHeader, notes: list[MeshNote]) -> None:
    """Reject a binary file that is shorter than its header claims; add a note to a longer one."""
    claimed, expected = header.triangles, header.expected_bytes
    if claimed is None or expected is None:
        raise MeshError(
            f"the file has {header.bytes} bytes and is no STL file: a binary one has at least "
            f'{HEADER_BYTES}, a text one begins with "solid" and has facets',
            path=path,
        )
    if header.bytes < expected:
        raise MeshError(
            f"the STL file is truncated, or its header is wrong: {claimed} triangles need "
            f"{expected} bytes, it has {header.bytes}; export or fetch it again",
            path=path,
        )
    if header.bytes > expected:
        message = (
            f"{header.bytes - expected} bytes after the {claimed} triangles the header of the STL "
            "file claims are not read."
        )
        notes.append(MeshNote("stl-trailing-bytes", message))


def _read_whole_text(path: Path) -> Points:
    data = path.read_bytes()
    if not re.search(rb"endsolid\b[^\n]*\s*\Z", data[-1024:], re.IGNORECASE):
        raise MeshError(
            'the STL text is truncated: its last line should be "endsolid"; export or fetch it '
            "again",
            path=path,
        )
    rows = _VERTEX.findall(data)
    facets = len(re.findall(rb"\bendfacet\b", data, re.IGNORECASE))
    if len(rows) != 3 * facets:
        raise MeshError(
            f"the STL text has {len(rows)} vertices in {facets} facets; each facet needs three",
            path=path,
        )
    try:
        return np.array(rows, dtype=np.float64).reshape(-1, 3)
    except ValueError as error:
        raise MeshError(
            f"a vertex of the STL text is not three numbers ({error})", path=path
        ) from error
