"""Encoding of pictures as PNG files."""

from __future__ import annotations

import io

import numpy as np
import numpy.typing as npt

from ..extras import make_missing_error

Image = npt.NDArray[np.uint8]
"""Pixels: red, green and blue, shape (height, width, 3)."""


def encode_png(image: npt.NDArray[np.uint8], *, level: int = 6) -> bytes:
    """Encode a picture as a PNG file.

    Args:
        image: Pixels, shape (height, width, 3), or with opacity (height, width, 4).
        level: Compression level of zlib, from 0 to 9.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    try:
        from PIL import Image as Pillow
    except ImportError as error:
        raise make_missing_error("PIL", "a picture") from error
    out = io.BytesIO()
    Pillow.fromarray(np.ascontiguousarray(image)).save(out, "PNG", compress_level=level)
    return out.getvalue()
