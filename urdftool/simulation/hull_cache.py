"""Convex hulls and outermost points of mesh files, cached on disk by the content of the file.

Both are small, and reading the files is most of the time of a short simulation.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ..geometry.mesh import Faces, Points
from ..storage import DiskCache, cache_key

Cloud = tuple[Points, Faces]
"""Points (n, 3) and triangles (m, 3) of them; m may be zero."""

_VERSION = 2
"""Version of the results; increase it if the same file gives other results."""


class HullCache:
    """Cache of hulls and points in a folder."""

    def __init__(self, folder: str | Path | None) -> None:
        """Set the folder; None caches nothing."""
        self._store = DiskCache(folder)

    def get_or_compute(
        self, path: Path, facts: Sequence[object], make: Callable[[], list[Cloud]]
    ) -> list[Cloud]:
        """Return the cached result for the bytes of a file, or compute and cache it.

        Args:
            path: Mesh file; ``make`` reports one that cannot be read.
            facts: Other values that the result depends on.
            make: Computes the result from the file.
        """
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
    head = json.dumps([[len(points), len(faces)] for points, faces in clouds]).encode()
    arrays = [
        np.ascontiguousarray(a, k) for cloud in clouds for a, k in zip(cloud, _KINDS, strict=True)
    ]
    return b"".join([head, b"\n", *(array.tobytes() for array in arrays)])


def _decode(data: bytes) -> list[Cloud] | None:
    """Decode bytes that this version encoded; None for others."""
    head, _, body = data.partition(b"\n")
    clouds, at = [], 0
    try:
        for counts in json.loads(head):
            arrays = []
            for count, kind in zip(counts, _KINDS, strict=True):
                arrays.append(np.frombuffer(body, kind, 3 * count, at).reshape(count, 3).copy())
                at += arrays[-1].nbytes
            clouds.append((arrays[0], arrays[1]))
    except (ValueError, TypeError):
        return None
    return clouds if at == len(body) else None


_KINDS = ("<f8", "<i8")
