"""Images as PNG, the image format that every MuJoCo version reads.

MuJoCo rejects a PNG for an ancillary chunk of a wrong length, which libpng and Pillow ignore.
Therefore only chunks that affect the appearance are kept: ``tRNS``, and ``sRGB``, from which MuJoCo
reads the color space.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from zlib import crc32

from ...errors import MeshError
from ...extras import make_missing_error
from ...geometry.image_file import MAX_PIXELS, open_image
from ...storage import DiskCache, cache_folder, cache_key

SIGNATURE = b"\x89PNG\r\n\x1a\n"

COMPRESSION = 4
"""zlib level: 7 % larger files than Pillow's 6 on 19 photographs of robots, in 70 % of the time,
measured."""

_VERSION = 1

_COLOR_TYPES = (0, 2, 3, 4, 6)
"""Gray, RGB, palette, gray with alpha, RGBA: by the specification of PNG."""


def get_png(image: Path | bytes) -> bytes | None:
    """Return an image as a PNG without unneeded chunks; convert other formats.

    Conversions are cached in the user's cache folder.

    Returns:
        The PNG; None if the file is not an image.

    Raises:
        MissingDependency: A conversion is needed, and Pillow is not installed.
    """
    try:
        data = image if isinstance(image, bytes) else image.read_bytes()
    except OSError:
        return None
    return _get_plain(data) or _convert(data)


def _get_plain(data: bytes) -> bytes | None:
    """Return a valid PNG without unneeded chunks; None for other data."""
    if not data.startswith(SIGNATURE):
        return None
    chunks = list(_list_chunks(data))
    if not chunks or chunks[0][0] != b"IHDR" or chunks[-1][0] != b"IEND":
        return None
    header = chunks[0][1]
    if len(header) != 13 or header[9] not in _COLOR_TYPES:
        return None
    if int.from_bytes(header[:4], "big") * int.from_bytes(header[4:8], "big") > MAX_PIXELS:
        return None
    color = header[9]
    parts: dict[bytes, list[bytes]] = {}
    for kind, content in chunks:
        parts.setdefault(kind, []).append(content)
    palette, clear = parts.get(b"PLTE", []), parts.get(b"tRNS", [])
    if len(palette) > 1 or any(len(p) % 3 or not 3 <= len(p) <= 768 for p in palette):
        return None
    if (color == 3) > len(palette):
        return None
    if color in (0, 4):
        palette = []
    most = len(palette[0]) // 3 if palette else 0
    right = {0: (2, 2), 2: (6, 6), 3: (1, most)}.get(color)
    clear = [c for c in clear[:1] if right is not None and right[0] <= len(c) <= right[1]]
    standard = [c for c in parts.get(b"sRGB", [])[:1] if len(c) == 1 and c[0] < 4]
    kept = [(b"IHDR", header)]
    kept += [(b"sRGB", content) for content in standard]
    kept += [(b"PLTE", content) for content in palette]
    kept += [(b"tRNS", content) for content in clear]
    kept += [(b"IDAT", content) for content in parts.get(b"IDAT", [])]
    kept.append((b"IEND", b""))
    return SIGNATURE + b"".join(_get_chunk(kind, content) for kind, content in kept)


def _list_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield the chunks of a PNG up to ``IEND``, or up to the first with a wrong checksum."""
    start, kind = len(SIGNATURE), b""
    while kind != b"IEND":
        length = int.from_bytes(data[start : start + 4], "big")
        kind = data[start + 4 : start + 8]
        end = start + 8 + length
        checksum = crc32(data[start + 4 : end]).to_bytes(4, "big")
        if len(kind) < 4 or checksum != data[end : end + 4]:
            return
        yield kind, data[start + 8 : end]
        start = end + 4


def _get_chunk(kind: bytes, content: bytes) -> bytes:
    checksum = crc32(kind + content).to_bytes(4, "big")
    return len(content).to_bytes(4, "big") + kind + content + checksum


def _convert(data: bytes) -> bytes | None:
    """Convert an image in any format that Pillow reads, or read the result from the cache.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    store = DiskCache(cache_folder("mjcf-textures"))
    key = cache_key(_VERSION, COMPRESSION, [data])
    found = store.get(key)
    if found is not None and found.startswith(SIGNATURE):
        return found
    made = _convert_png_bytes(data)
    if made is not None:
        store.put(key, made)
        store.trim()
    return made


def _convert_png_bytes(data: bytes) -> bytes | None:
    """Convert an image in any format that Pillow reads to PNG; None if it is not an image.

    Raises:
        MissingDependency: Pillow is not installed.
    """
    try:
        opened = open_image(data)
    except ImportError as error:
        raise make_missing_error("PIL", "converting a texture to PNG") from error
    except MeshError:
        return None
    try:
        with opened as picture:
            target = BytesIO()
            see_through = "A" in picture.getbands() or "transparency" in picture.info
            plain = picture.convert("RGBA" if see_through else "RGB")
            plain.info.clear()  # color profiles and other metadata would become chunks
            plain.save(target, "PNG", compress_level=COMPRESSION)
    # Pillow raises arbitrary exceptions for damaged files
    except Exception:
        return None
    return _get_plain(target.getvalue())
