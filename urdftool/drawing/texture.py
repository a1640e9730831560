"""Images on surfaces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..errors import MeshError
from ..geometry.image_file import open_image
from .raster import Floats

Texels = npt.NDArray[np.uint8]
"""Red, green, blue and opacity, lowest row first: shape (height, width, 4)."""

LARGEST = 2048
"""Width and height in pixels to which larger images are reduced."""


def read_texture(source: Path | bytes) -> Texels:
    """Read an image file, or the content of one.

    Raises:
        MeshError: The file does not exist or is not an image.
    """
    image = open_image(source)
    try:
        with image:
            image.draft("RGB", (LARGEST, LARGEST))
            if max(image.size) > LARGEST:
                image.thumbnail((LARGEST, LARGEST))
            pixels = np.asarray(image.convert("RGBA"))
    # image readers raise arbitrary exceptions for damaged files
    except Exception as error:
        path = None if isinstance(source, bytes) else source
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(f"the image cannot be read ({reason})", path=path) from error
    return np.ascontiguousarray(pixels[::-1])


def sample_texture(texels: Texels, uv: Floats) -> Floats:
    """Sample an image bilinearly at texture coordinates; it repeats beyond its edges.

    Returns:
        Red, green, blue and opacity in 0 … 1, shape (n, 4).
    """
    height, width = texels.shape[:2]
    finite = np.where(np.isfinite(uv), uv, 0.0)
    x = (finite[:, 0] % 1.0) * width - 0.5
    y = (finite[:, 1] % 1.0) * height - 0.5
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    right, up = (x - column)[:, None], (y - row)[:, None]
    here, after = column % width, (column + 1) % width
    low, high = row % height, (row + 1) % height
    flat = texels.reshape(-1, 4)
    lower = flat[low * width + here] * (1 - right) + flat[low * width + after] * right
    upper = flat[high * width + here] * (1 - right) + flat[high * width + after] * right
    return np.asarray((lower * (1 - up) + upper * up) / 255.0)
