"""Disk cache of mesh conversions."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ...geometry.mesh import MeshNote
from ...parallel import count_cores, map_tasks, yield_in_order
from ...source.access import require_companion
from ...source.description import GltfUp
from ...storage import DiskCache, cache_folder, cache_key, join_parts, split_parts
from .convert import Converted, Piece, call_conversion

_VERSION = 9
"""Number in the keys of the cache; a change of what is stored requires another. By definition."""

_BIG = 400_000
"""Bytes of meshes above which several processes convert them. Chosen, no source."""


Job = tuple[Path, bool, GltfUp]
"""A file, whether it is collision geometry, and the up axis of a glTF file."""


def convert_all(jobs: Sequence[Job]) -> list[Converted | str]:
    """Convert the mesh of each job, or return it from the cache; in parallel."""
    keys = [_get_key(*job) for job in jobs]
    cache = DiskCache(cache_folder("mjcf-meshes"))
    found: list[Converted | str | None] = [
        None if key is None else _decode(cache.get(key), job[0])
        for key, job in zip(keys, jobs, strict=True)
    ]
    todo = [index for index, known in enumerate(found) if known is None]
    for index, made in zip(todo, _run([jobs[index] for index in todo]), strict=True):
        found[index] = made
        key = keys[index]
        if key is not None and isinstance(made, Converted):
            cache.put(key, _encode(made, jobs[index][0]))
    if todo:
        cache.trim()
    return [made for made in found if made is not None]


def _run(jobs: Sequence[Job]) -> list[Converted | str]:
    size = sum(path.stat().st_size for path, *_ in jobs if os.path.isfile(path))
    workers = 1 if size < _BIG else count_cores()
    return list(yield_in_order(map_tasks(_convert, jobs, workers=workers)))


def _convert(job: Job) -> Converted | str:
    return call_conversion(*job)


def _get_key(path: Path, collides: bool, gltf_up: GltfUp) -> str | None:
    """Return the key of a conversion; None if it depends on more than can be read cheaply."""
    suffix = path.suffix.lower()
    if suffix == ".gltf" or not path.is_file():
        return None  # its buffers are separate files
    try:
        inputs = [path.read_bytes()]
        if suffix == ".obj":
            others = dict.fromkeys(path.parent / name for name in _list_libraries(inputs[0]))
            inputs += [require_companion(path, o).read_bytes() for o in others if o.is_file()]
    except (OSError, ValueError):
        return None
    return cache_key(_VERSION, [collides, suffix, gltf_up if suffix == ".glb" else ""], inputs)


def _list_libraries(data: bytes) -> Iterable[str]:
    for line in data.split(b"\n"):
        if line.startswith(b"mtllib "):
            yield line[7:].strip().decode("utf-8", "replace")


def _decode(entry: bytes | None, path: Path) -> Converted | None:
    """Decode the conversion of a file from a cache entry; return None if the entry is not valid."""
    if entry is None:
        return None
    try:
        head, parts = split_parts(entry)
        pieces = [_decode_piece(table, parts, path.parent) for table in head["pieces"]]
        notes = [MeshNote(str(code), str(text), bool(lossy)) for code, text, lossy in head["notes"]]
        hull = None if head["hull"] is None else float(head["hull"])
        return Converted(pieces, hull, notes, bool(head["thick"]))
    except (ValueError, KeyError, TypeError, IndexError, OverflowError):
        return None


def _decode_piece(table: dict[str, Any], parts: list[bytes], folder: Path) -> Piece:
    """Decode a piece, and remove its bytes from the list."""
    data = parts.pop(0) if table["bytes"] else None
    rgba = None
    if table["rgba"] is not None:
        red, green, blue, alpha = map(float, table["rgba"])
        rgba = red, green, blue, alpha
    texture: Path | bytes | None = None
    if table["image"]:
        texture = parts.pop(0)
    elif table["texture"] is not None:
        texture = folder / table["texture"]
    return Piece(data, rgba, texture, bool(table["shell"]))


def _encode(made: Converted, path: Path) -> bytes:
    """Encode a conversion as a cache entry."""
    pieces, parts = [], []
    for piece in made.pieces:
        texture = piece.texture
        table = {
            "bytes": piece.data is not None,
            "rgba": piece.rgba,
            "image": isinstance(texture, bytes),
            "texture": os.path.relpath(texture, path.parent) if isinstance(texture, Path) else None,
            "shell": piece.shell,
        }
        pieces.append(table)
        parts += [part for part in (piece.data, texture) if isinstance(part, bytes)]
    head = {"hull": made.hull, "notes": made.notes, "thick": made.thick, "pieces": pieces}
    return join_parts(head, parts)
