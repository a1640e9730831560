"""Conversions of meshes, kept for the next export of the same file."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from hashlib import sha256
from pathlib import Path

from ...parallel import cores, in_order, map_tasks
from ...source.description import GltfUp
from .convert import Converted, Piece, conversion

_VERSION = 7
_BIG = 400_000


Job = tuple[Path, bool, GltfUp]
"""A file, whether it collides, and the axis of a glTF file that is up."""


def convert_all(jobs: Sequence[Job]) -> list[Converted | str]:
    """``conversion`` of each, from the cache or side by side."""
    keys = [_key(*job) for job in jobs]
    found: list[Converted | str | None] = [
        None if key is None else _read(key, job[0]) for key, job in zip(keys, jobs, strict=True)
    ]
    todo = [index for index, known in enumerate(found) if known is None]
    for index, made in zip(todo, _run([jobs[index] for index in todo]), strict=True):
        found[index] = made
        key = keys[index]
        if key is not None and isinstance(made, Converted):
            _write(key, made, jobs[index][0])
    return [made for made in found if made is not None]


def _run(jobs: Sequence[Job]) -> list[Converted | str]:
    size = sum(path.stat().st_size for path, *_ in jobs if os.path.isfile(path))
    workers = 1 if size < _BIG else cores()
    return list(in_order(map_tasks(_convert, jobs, workers=workers)))


def _convert(job: Job) -> Converted | str:
    return conversion(*job)


def _key(path: Path, collides: bool, gltf_up: GltfUp) -> str | None:
    """What the conversion depends on; None where that is more than can be told cheaply."""
    if path.suffix.lower() == ".gltf":
        return None  # its buffers are other files
    try:
        data = path.read_bytes()
        up = gltf_up if path.suffix.lower() == ".glb" else ""
        digest = sha256(f"{_VERSION} {collides} {path.suffix.lower()} {up}".encode() + data)
        for library in _libraries(data) if path.suffix.lower() == ".obj" else ():
            digest.update((path.parent / library).read_bytes())
    except (OSError, ValueError):
        return None
    return digest.hexdigest()


def _libraries(data: bytes) -> Iterable[str]:
    for line in data.split(b"\n"):
        if line.startswith(b"mtllib "):
            yield line[7:].strip().decode("utf-8", "replace")


def _folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(base) / "urdftool" / "mjcf-meshes"


def _read(key: str, path: Path) -> Converted | None:
    try:
        with open(_folder() / key, "rb") as stream:
            head = json.loads(stream.readline())
            pieces = []
            for facts in head["pieces"]:
                data = None if facts["bytes"] is None else stream.read(facts["bytes"])
                if data is not None and len(data) != facts["bytes"]:
                    return None
                rgba = None if facts["rgba"] is None else tuple(facts["rgba"])
                texture: Path | bytes | None = None
                if facts["texture"] is not None:
                    texture = path.parent / facts["texture"]
                if facts["image"] is not None:
                    texture = stream.read(facts["image"])
                    if len(texture) != facts["image"]:
                        return None
                pieces.append(Piece(data, rgba, texture, facts["shell"]))
            return Converted(pieces, head["hull"], head["notes"], head["thick"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _write(key: str, made: Converted, path: Path) -> None:
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
    folder = _folder()
    neighbour = folder / f".{key}.{os.getpid()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with open(neighbour, "wb") as stream:
            stream.write(json.dumps(head).encode() + b"\n")
            for piece in made.pieces:
                stream.write(piece.data or b"")
                stream.write(piece.texture if isinstance(piece.texture, bytes) else b"")
        os.replace(neighbour, folder / key)
    except OSError:
        neighbour.unlink(missing_ok=True)
