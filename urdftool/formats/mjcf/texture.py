"""Images as PNG, the one image format that every MuJoCo reads."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def is_png(image: Path) -> bool:
    """Whether a file is a PNG by its first bytes, whatever its name says."""
    try:
        with open(image, "rb") as stream:
            return stream.read(8) == SIGNATURE and len(stream.read(64)) == 64
    except OSError:
        return False


def png_bytes(image: Path) -> bytes | None:
    """An image in any format that Pillow reads as a PNG; None without Pillow or for no image."""
    try:
        from PIL import Image
    except ImportError:
        return None
    try:
        with Image.open(image) as picture:
            target = BytesIO()
            picture.convert("RGBA").save(target, "PNG")
    except (OSError, ValueError):
        return None
    return target.getvalue()
