"""Smaller images: files, and images inside GLB files."""

from __future__ import annotations

import io
import json
import struct
from typing import Any, NamedTuple

from ..errors import MeshError
from ..extras import require
from ..geometry.image_file import open_image

_HEAD = struct.Struct("<4sIIII")
_BINARY = b"BIN\0"
_WRITTEN = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "TIFF")


class Shrunk(NamedTuple):
    """An image of fewer pixels.

    Attributes:
        data: The file.
        before: Width and height of the source [pixels].
        after: Width and height [pixels].
    """

    data: bytes
    before: tuple[int, int]
    after: tuple[int, int]


def shrink_image(data: bytes, limit: int) -> Shrunk | None:
    """Scale an image down to a limit [pixels], in its file format and with its aspect ratio.

    Returns:
        The image; None if it is small enough, or is not an image that Pillow reads and writes.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    require("--max-texture", "PIL")
    from PIL import Image

    try:
        image = open_image(data)
        kind, before = str(image.format), image.size
        if max(before) <= limit or kind not in _WRITTEN:
            return None
        scale = limit / max(before)
        after = max(1, round(before[0] * scale)), max(1, round(before[1] * scale))
        if image.mode == "P":
            image = image.convert("RGBA" if "transparency" in image.info else "RGB")
        small = image.resize(after, Image.Resampling.LANCZOS)
        stream = io.BytesIO()
        small.save(stream, kind, **({"quality": 90} if kind in ("JPEG", "WEBP") else {}))
    except (MeshError, OSError, ValueError, SyntaxError):
        return None
    return Shrunk(stream.getvalue(), before, after)


def explain_unshrunk(data: bytes, limit: int) -> str:
    """Return why an image not scaled down is larger than a limit [pixels]; empty if it is not."""
    try:
        image = open_image(data)
    except MeshError as error:
        return error.message
    if max(image.size) <= limit:
        return ""
    return f"{image.width} × {image.height} pixels of a {image.format} cannot be scaled down"


def shrink_glb_images(data: bytes, limit: int) -> Shrunk | None:
    """Scale the images inside a GLB file down to a limit [pixels]; all else stays as it is.

    Returns:
        The file, with the size of its largest image; None if no image is larger, or the file is
        damaged.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    try:
        document, blob = _split(data)
        spans = [
            (int(view.get("byteOffset", 0)), int(view["byteLength"]), int(view.get("buffer", 0)))
            for view in document.get("bufferViews", ())
        ]
        numbers = [image.get("bufferView") for image in document.get("images", ())]
        found: dict[int, Shrunk] = {}
        for number in {n for n in numbers if n is not None}:
            start, length, buffer = spans[number]
            small = shrink_image(blob[start : start + length], limit) if buffer == 0 else None
            if small is not None:
                found[number] = small
        if not found or len({buffer for _, _, buffer in spans}) > 1:
            return None
        contents = [
            found[n].data if n in found else blob[start : start + length]
            for n, (start, length, _) in enumerate(spans)
        ]
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, struct.error):
        return None
    largest = max(found.values(), key=lambda one: (one.before, one.after))
    return Shrunk(_join(document, contents), largest.before, largest.after)


def _split(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON and the binary chunk of a GLB file."""
    magic, version, _, length, _ = _HEAD.unpack_from(data)
    if magic != b"glTF" or version != 2:
        raise ValueError("not a GLB file of version 2")
    document = json.loads(data[_HEAD.size : _HEAD.size + length])
    start = _HEAD.size + length
    size, kind = struct.unpack_from("<I4s", data, start)
    if kind != _BINARY:
        raise ValueError("no binary chunk")
    return document, data[start + 8 : start + 8 + size]


def _join(document: dict[str, Any], contents: list[bytes]) -> bytes:
    """Return a GLB file whose buffer views have new contents."""
    blob = bytearray()
    views = []
    for view, content in zip(document["bufferViews"], contents, strict=True):
        views.append({**view, "byteOffset": len(blob), "byteLength": len(content)})
        blob += content + b"\0" * (-len(content) % 4)
    buffers = [{**document["buffers"][0], "byteLength": len(blob)}, *document["buffers"][1:]]
    changed = {**document, "bufferViews": views, "buffers": buffers}
    text = json.dumps(changed, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(blob), _BINARY) + bytes(blob)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
