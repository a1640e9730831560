"""Opening of image files with Pillow, within limits of format and size."""

from __future__ import annotations

import os
import warnings
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import MeshError

if TYPE_CHECKING:
    from PIL import Image

MAX_PIXELS = 8192 * 8192
"""Number of pixels of the largest image, which take 256 MiB. Chosen; robots have up to 4096²."""

FORMATS = (
    *("PNG", "JPEG", "BMP", "DIB", "TGA", "TIFF", "WEBP", "GIF", "DDS", "PPM", "JPEG2000"),
    *("ICO", "PCX", "SGI"),
)
"""Formats that are read; Pillow runs another program for some others, such as EPS."""


def open_image(source: Path | bytes) -> Image.Image:
    """Open an image file, or the content of one; its pixels are decoded later.

    Raises:
        MeshError: It is not an image file, or has more than :data:`MAX_PIXELS`.
        ImportError: Pillow is not installed.
    """
    from PIL import Image

    path: Path | None = None
    content: Path | BytesIO
    if isinstance(source, bytes):
        content = BytesIO(source)
    else:
        path = content = source
        if is_special(path):
            raise MeshError("is not a file; a texture requires an image file", path=path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # the limit is below
            image = Image.open(content, formats=FORMATS)
    except FileNotFoundError as error:
        raise MeshError("image file does not exist", path=path) from error
    # image readers raise arbitrary exceptions for damaged files
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(f"the image cannot be read ({reason})", path=path) from error
    if image.width * image.height > MAX_PIXELS:
        raise MeshError(
            f"the image cannot be read: {image.width} × {image.height} pixels exceed the limit of "
            f"{MAX_PIXELS}; scale it down",
            path=path,
        )
    return image


def is_special(path: Path) -> bool:
    """Tell whether a path leads to a folder, a device or a pipe, of which reading may not end."""
    return os.path.exists(path) and not os.path.isfile(path)
