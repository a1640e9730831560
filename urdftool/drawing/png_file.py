"""Pixels as the bytes of a PNG file."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import numpy.typing as npt

Image = npt.NDArray[np.uint8]
"""Rows of pixels, each red, green and blue: shape (height, width, 3)."""


def png(image: Image) -> bytes:
    """An image as a PNG file (ISO/IEC 15948), the same bytes wherever zlib is the same.

    Each row is written as its difference to the row above (filter 2), which packs smooth shades.
    """
    height, width = image.shape[:2]
    pixels = image.reshape(height, -1)
    above = np.zeros_like(pixels)
    above[1:] = pixels[:-1]
    kind = np.full((height, 1), 2, np.uint8)
    rows = np.concatenate([kind, pixels - above], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"".join(
        [
            b"\x89PNG\r\n\x1a\n",
            _chunk(b"IHDR", header),
            _chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)),
            _chunk(b"IEND", b""),
        ]
    )


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
