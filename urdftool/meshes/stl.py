"""STL, binary and text: triangles without objects or colours, in no unit (URDF takes metres)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ..errors import MeshError
from .facts import HEADER_BYTES, StlFacts, stl_facts
from .mesh import MeshNote, Piece, Points, Reading

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read(path: Path) -> Reading:
    """The triangles of an STL file; normals and attribute bytes are not used.

    A binary file with bytes after its last triangle is read, with a note, as RViz and Gazebo do.
    """
    facts = stl_facts(path)
    notes: list[MeshNote] = []
    corners = _text_corners(path) if facts.kind == "ascii" else _binary_corners(path, facts, notes)
    faces = np.arange(len(corners), dtype=np.int64).reshape(-1, 3)
    return Reading([Piece(corners, faces)], notes)


def _binary_corners(path: Path, facts: StlFacts, notes: list[MeshNote]) -> Points:
    claimed, expected = facts.triangles, facts.expected_bytes
    if claimed is None or expected is None:
        raise MeshError(
            f"the file has {facts.bytes} bytes and is no STL file: a binary one has at least "
            f'{HEADER_BYTES}, a text one begins with "solid" and has facets',
            path=path,
        )
    if facts.bytes < expected:
        raise MeshError(
            f"the STL file is truncated, or its header is wrong: {claimed} triangles need "
            f"{expected} bytes, it has {facts.bytes}; export or fetch it again",
            path=path,
        )
    if facts.bytes > expected:
        message = (
            f"{facts.bytes - expected} bytes after the {claimed} triangles the header of the STL "
            "file claims are not read."
        )
        notes.append(MeshNote("stl-trailing-bytes", message))
    # the count is trusted only now that the file is known to be long enough for it
    records = np.fromfile(path, dtype=_RECORD, count=claimed, offset=HEADER_BYTES)
    return records["corners"].reshape(-1, 3).astype(np.float64)


def _text_corners(path: Path) -> Points:
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
        return np.array(rows, dtype=bytes).astype(np.float64).reshape(-1, 3)
    except ValueError as error:
        raise MeshError(
            f"a vertex of the STL text is not three numbers ({error})", path=path
        ) from error
