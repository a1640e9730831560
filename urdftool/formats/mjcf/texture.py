"""Images as PNG, the one image format that every MuJoCo reads."""

from __future__ import annotations

import zlib
from io import BytesIO
from pathlib import Path

from ...extras import missing

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def png(image: Path | bytes) -> Path | bytes | None:
    """An image as a PNG: itself, or converted; None without Pillow or for no image."""
    return image if _is_png(image) else _png_bytes(image)


def _is_png(image: Path | bytes) -> bool:
    """Whether it is a PNG by its bytes, whatever its name says, with sums that are right."""
    try:
        data = image if isinstance(image, bytes) else image.read_bytes()
    except OSError:
        return False
    if not data.startswith(SIGNATURE):
        return False
    start, kind = len(SIGNATURE), b""
    while kind != b"IEND":
        length = int.from_bytes(data[start : start + 4], "big")
        kind = data[start + 4 : start + 8]
        end = start + 8 + length
        checksum = zlib.crc32(data[start + 4 : end]).to_bytes(4, "big")
        if len(kind) < 4 or checksum != data[end : end + 4]:
            return False
        start = end + 4
    return True


def _png_bytes(image: Path | bytes) -> bytes | None:
    """Convert an image in any format that Pillow reads to PNG; None if it is not an image.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    try:
        from PIL import Image
    except ImportError as error:
        raise missing("PIL", "converting a texture to PNG") from error
    try:
        with Image.open(BytesIO(image) if isinstance(image, bytes) else image) as picture:
            target = BytesIO()
            picture.convert("RGBA").save(target, "PNG")
    # image readers meet damaged files with whatever their arithmetic raises
    except Exception:
        return None
    return target.getvalue()
