"""Disk cache of mesh conversions."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from io import BytesIO
from pathlib import Path

from ...geometry.mesh import MeshNote
from ...parallel import count_cores, map_tasks, yield_in_order
from ...source.description import GltfUp
from ...storage import DiskCache, cache_folder, cache_key
from .convert import Converted, Piece, call_conversion

_VERSION = 8
_BIG = 400_000


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
    if suffix == ".gltf":
        return None  # its buffers are separate files
    try:
        inputs = [path.read_bytes()]
        if suffix == ".obj":
            inputs += [(path.parent / name).read_bytes() for name in _list_libraries(inputs[0])]
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
    stream = BytesIO(entry)
    try:
        head = json.loads(stream.readline())
        pieces = []
        for facts in head["pieces"]:
            data = None if facts["bytes"] is None else stream.read(facts["bytes"])
            rgba = None if facts["rgba"] is None else tuple(facts["rgba"])
            texture: Path | bytes | None = None
            if facts["texture"] is not None:
                texture = path.parent / facts["texture"]
            if facts["image"] is not None:
                texture = stream.read(facts["image"])
            pieces.append(Piece(data, rgba, texture, facts["shell"]))
        notes = [MeshNote(*note) for note in head["notes"]]
        return Converted(pieces, head["hull"], notes, head["thick"])
    except (ValueError, KeyError, TypeError):
        return None


def _encode(made: Converted, path: Path) -> bytes:
    """Encode a conversion as a cache entry."""
    head = {
        "hull": made.hull,
        "notes": made.notes,
        "thick": made.thick,
        "pieces": [
            {
                "bytes": None if piece.data is None else len(piece.data),
                "rgba": piece.rgba,
                "texture": os.path.relpath(piece.texture, path.parent)
                if isinstance(piece.texture, Path)
                else None,
                "image": len(piece.texture) if isinstance(piece.texture, bytes) else None,
                "shell": piece.shell,
            }
            for piece in made.pieces
        ],
    }
    parts = [json.dumps(head).encode() + b"\n"]
    for piece in made.pieces:
        parts += [piece.data or b"", piece.texture if isinstance(piece.texture, bytes) else b""]
    return b"".join(parts)
