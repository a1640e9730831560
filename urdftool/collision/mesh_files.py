"""Pieces as mesh files: reproducible binary STL and OBJ, marked as written by urdftool."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from ..errors import OutputError
from ..output import check_links
from ..storage import write_files
from .piece import Piece

MARK = b"collision geometry by urdftool"

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def encode_mesh(pieces: Sequence[Piece], suffix: str) -> bytes:
    """Encode pieces as a mesh file ``.stl`` or ``.obj``, in meters; each is an object of an OBJ."""
    return _encode_obj(pieces) if suffix == ".obj" else _encode_stl(pieces)


def _encode_stl(pieces: Sequence[Piece]) -> bytes:
    corners = np.concatenate([piece.corners for piece in pieces])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    records = np.zeros(len(corners), dtype=_RECORD)
    records["normal"] = normals / np.where(lengths > 0, lengths, 1.0)
    records["corners"] = corners
    head = MARK.ljust(80, b"\0")
    return head + len(corners).to_bytes(4, "little") + records.tobytes()


def _encode_obj(pieces: Sequence[Piece]) -> bytes:
    lines = [f"# {MARK.decode()}"]
    first = 1
    for index, piece in enumerate(pieces):
        lines.append(f"o piece_{index}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in (piece.vertices + 0.0).tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (piece.faces + first).tolist()]
        first += len(piece.vertices)
    return ("\n".join(lines) + "\n").encode()


def write_all(
    files: Mapping[Path, bytes], *, overwrite: bool = False, inputs: Iterable[str | Path] = ()
) -> None:
    """Write the files of a collision geometry: all or none.

    The last file refers to the others.

    Raises:
        OutputError: A file cannot be written; existing files are unchanged.
    """
    read = {os.path.realpath(name) for name in inputs}
    for path in files:
        if os.path.realpath(path) in read:
            raise OutputError("is an input; write the output to another file", path=path)
        check_links(path)
        _check(path, overwrite)
    write_files(files)


def _check(path: Path, overwrite: bool) -> None:
    if path.is_dir():
        raise OutputError("is a folder, not a file", path=path)
    if path.exists() and not os.access(path, os.W_OK):
        raise OutputError("may not be written (it is read-only)", path=path)
    if overwrite or path.suffix.lower() not in (".stl", ".obj") or not path.is_file():
        return
    with open(path, "rb") as stream:
        if MARK not in stream.read(80):
            raise OutputError(
                "is there and was not written by urdftool; keep it with another --mesh-dir, or "
                "replace it with --overwrite",
                path=path,
            )
