"""Triangles to pixels, without a screen or a graphics card: a depth buffer in arrays."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import numpy.typing as npt

from ..meshes.mesh import Points

Image = npt.NDArray[np.float64]
"""Rows of pixels, each red, green and blue in 0 … 1."""

FINER = 2
"""Samples along each side of a pixel."""

_AT_ONCE = 3_000_000
_LIGHT = np.array([0.35, -0.55, 0.76])
_AMBIENT = 0.35


def view_axes(azimuth: float, elevation: float) -> Points:
    """Right, up and towards the viewer, as rows, for a camera at two angles [rad] with z up."""
    ca, sa = np.cos(azimuth), np.sin(azimuth)
    ce, se = np.cos(elevation), np.sin(elevation)
    return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])


def render(
    corners: Points,
    colors: Points,
    axes: Points,
    window: tuple[float, float, float],
    size: tuple[int, int],
) -> Image:
    """Triangles as seen from far away, each in its colour, lit from the upper right.

    Args:
        corners: Triangles [m], shape (m, 3, 3).
        colors: Red, green and blue of each, shape (m, 3).
        axes: From :func:`view_axes`.
        window: Middle of the picture along right and up [m], and the width of a pixel [m].
        size: Width and height in pixels.
    """
    width, height = size[0] * FINER, size[1] * FINER
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals @ axes.T / np.where(lengths > 0, lengths, 1.0)
    normals *= np.where(normals[:, 2:] < 0, -1.0, 1.0)  # both sides are seen
    shade = _AMBIENT + (1 - _AMBIENT) * np.clip(normals @ (_LIGHT / np.linalg.norm(_LIGHT)), 0, 1)
    lit = colors * shade[:, None]
    seen = corners @ axes.T
    seen[..., 0] = (seen[..., 0] - window[0]) / window[2] * FINER + width / 2
    seen[..., 1] = height / 2 - (seen[..., 1] - window[1]) / window[2] * FINER
    owner, filled = _nearest(seen, width, height)
    pixels = np.ones((height * width, 3))
    pixels[filled] = lit[owner[filled]]
    image = pixels.reshape(height // FINER, FINER, width // FINER, FINER, 3)
    return np.asarray(image.mean(axis=(1, 3)))


def _nearest(
    seen: Points, width: int, height: int
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
    """For each pixel the triangle in front, and whether there is one."""
    depth = np.full(width * height, -np.inf)
    owner = np.zeros(width * height, dtype=np.int64)
    low = np.clip(np.floor(seen[..., :2].min(axis=1)).astype(np.int64), 0, [width, height])
    high = np.clip(np.ceil(seen[..., :2].max(axis=1)).astype(np.int64) + 1, 0, [width, height])
    spans = np.maximum(high - low, 0)
    counts = spans[:, 0] * spans[:, 1]
    ends = np.cumsum(counts)
    begin = 0
    while begin < len(seen):
        done = ends[begin - 1] if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + _AT_ONCE)))
        _draw(seen, low, spans, counts, slice(begin, stop), width, depth, owner)
        begin = stop
    return owner, np.isfinite(depth)


def _draw(
    seen: Points,
    low: npt.NDArray[np.int64],
    spans: npt.NDArray[np.int64],
    counts: npt.NDArray[np.int64],
    some: slice,
    width: int,
    depth: Points,
    owner: npt.NDArray[np.int64],
) -> None:
    index = np.repeat(np.arange(len(seen))[some], counts[some])
    if not len(index):
        return
    number = np.arange(len(index)) - np.repeat(np.cumsum(counts[some]) - counts[some], counts[some])
    x = low[index, 0] + number % spans[index, 0]
    y = low[index, 1] + number // spans[index, 0]
    a, b, c = seen[index, 0], seen[index, 1], seen[index, 2]
    px, py = x + 0.5, y + 0.5
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    safe = np.where(area == 0, 1.0, area)
    v = ((px - a[:, 0]) * (c[:, 1] - a[:, 1]) - (py - a[:, 1]) * (c[:, 0] - a[:, 0])) / safe
    w = ((b[:, 0] - a[:, 0]) * (py - a[:, 1]) - (b[:, 1] - a[:, 1]) * (px - a[:, 0])) / safe
    inside = (v >= 0) & (w >= 0) & (v + w <= 1) & (area != 0)
    pixel = (y * width + x)[inside]
    z = (a[:, 2] + v * (b[:, 2] - a[:, 2]) + w * (c[:, 2] - a[:, 2]))[inside]
    front = index[inside]
    order = np.lexsort((z, pixel))
    pixel, z, front = pixel[order], z[order], front[order]
    last = np.r_[pixel[1:] != pixel[:-1], True]
    pixel, z, front = pixel[last], z[last], front[last]
    nearer = z > depth[pixel]
    depth[pixel[nearer]] = z[nearer]
    owner[pixel[nearer]] = front[nearer]


def png(image: Image) -> bytes:
    """An image as a PNG file (ISO/IEC 15948): eight bits a channel, no filter."""
    pixels = np.clip(np.round(image * 255), 0, 255).astype(np.uint8)
    height, width = pixels.shape[:2]
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"".join(
        [
            b"\x89PNG\r\n\x1a\n",
            _chunk(b"IHDR", header),
            _chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)),
            _chunk(b"IEND", b""),
        ]
    )


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
