"""Pictures kept on disk by what they show, so that none that takes long is drawn twice."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
import numpy.typing as npt

from ..storage import DiskCache, cache_folder, cache_key
from .png_file import Image, encode_png
from .shapes import Shapes

_REVISION = 1
"""Increment it when the same shapes give another picture."""

_SLOW = 0.3  # time [s] to draw a picture from which it is kept
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
"""First bytes of a PNG file."""

_MOST = 200_000_000  # size of the cache [bytes]


def draw_or_read(shapes: Shapes, facts: object, draw: Callable[[], Image]) -> bytes:
    """Draw a picture, or read it from the cache if the same one was drawn before.

    Args:
        shapes: What it shows.
        facts: Everything else that determines it: poses, camera, size; JSON-serializable.
        draw: Draws the picture.

    Returns:
        A PNG file.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    cache = DiskCache(cache_folder("pictures"))
    key = _compute_key(shapes, facts)
    found = cache.get(key)
    if found is not None and found.startswith(_SIGNATURE):
        return found
    begin = perf_counter()
    data = encode_png(draw())
    if perf_counter() - begin > _SLOW:
        cache.put(key, data)
        cache.trim(most=_MOST)
    return data


def read_size(data: bytes) -> tuple[int, int]:
    """Read width and height [pixels] of a PNG file from its header."""
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


def _compute_key(shapes: Shapes, facts: object) -> str:
    arrays: list[npt.NDArray[np.generic]] = [
        shapes.corners, shapes.normals, shapes.colors, shapes.uv, shapes.image, shapes.link,
        *shapes.images,
    ]  # fmt: skip
    table = [facts, list(shapes.links), [list(array.shape) for array in arrays]]
    return cache_key(_REVISION, table, [np.ascontiguousarray(a).tobytes() for a in arrays])
