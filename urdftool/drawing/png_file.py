"""Pixels as the bytes of a PNG file."""

from __future__ import annotations

import io

import numpy as np
import numpy.typing as npt

from ..extras import missing

Image = npt.NDArray[np.uint8]
"""Rows of pixels, each red, green and blue: shape (height, width, 3)."""


def png(image: npt.NDArray[np.uint8], *, level: int = 6) -> bytes:
    """Return an image as a PNG file.

    Args:
        image: Rows of pixels, shape (height, width, 3), or with transparency (height, width, 4).
        level: How well zlib packs it, from 0 to 9.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    try:
        from PIL import Image as Pillow
    except ImportError as error:
        raise missing("PIL", "a picture") from error
    out = io.BytesIO()
    Pillow.fromarray(np.ascontiguousarray(image)).save(out, "PNG", compress_level=level)
    return out.getvalue()
