"""Convex hulls and outermost points of mesh files, cached on disk by the content of the file.

Both are small, and reading the files is most of the time of a short simulation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from ..geometry.mesh import Faces, Points
from ..geometry.plain_form import decode_triangles, encode_triangles
from ..storage import DiskCache, cache_key, join_parts, split_parts

Cloud = tuple[Points, Faces]
"""Points (n, 3) and triangles (m, 3) of them; m may be zero."""

_VERSION = 3
"""Version of the results; increase it if the same file gives other results."""


class HullCache:
    """Cache of hulls and points in a folder."""

    def __init__(self, folder: str | Path | None) -> None:
        """Set the folder; None caches nothing."""
        self._store = DiskCache(folder)

    def get_or_compute(
        self, path: Path, facts: Sequence[object], make: Callable[[], list[Cloud]]
    ) -> list[Cloud]:
        """Return the cached result for the bytes of a file, or compute and cache it."""
        key = None if self._store.folder is None else _get_key(path, facts)
        if key is None:
            return make()
        known = self._store.get(key)
        clouds = None if known is None else _decode(known)
        if clouds is None:
            clouds = make()
            self._store.put(key, _get_encoded(clouds))
            self._store.trim()
        return clouds


def _get_key(path: Path, facts: Sequence[object]) -> str | None:
    suffix = path.suffix.lower()
    if suffix == ".gltf" or not path.is_file():
        return None  # buffers of glTF are in other files, and a pipe may not end
    try:
        return cache_key(_VERSION, [suffix, *facts], [path.read_bytes()])
    except OSError:
        return None


def _get_encoded(clouds: list[Cloud]) -> bytes:
    return join_parts(None, [part for cloud in clouds for part in encode_triangles(*cloud)])


def _decode(data: bytes) -> list[Cloud] | None:
    """Decode bytes that this version encoded; None for others."""
    try:
        _, parts = split_parts(data)
        return [
            decode_triangles(points, faces)
            for points, faces in zip(parts[::2], parts[1::2], strict=True)
        ]
    except ValueError:
        return None
