"""Images as PNG, the one image format that every MuJoCo reads."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path


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
