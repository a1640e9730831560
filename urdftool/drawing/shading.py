"""Shading: a key light with shadows, a fill light, and ambient light from the sky."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .camera import View
from .points import compute_bounds, transform_points
from .raster import Floats, find_front

Colors = npt.NDArray[np.float32]
"""Red, green and blue, in linear light unless stated otherwise."""

GAMMA = 2.2
"""Exponent from displayed to linear colors, about that of sRGB. Chosen, no source."""

_SKY, _EARTH = 0.47, 0.25
"""Light from above and from below. Chosen, no source."""

_KEY, _FILL, _SHINE = 0.60, 0.16, 0.10
"""Light of the main lamp, of the second one, and of the gloss. Chosen, no source."""

_HARDNESS = 28.0
"""Exponent of the gloss. Chosen, no source."""

_BLACK = np.float32(0.006)  # least reflectance; a perfectly black surface would show no shape
_TAPS = ((0.0, 0.0), (-1.1, -0.4), (0.4, -1.1), (1.1, 0.4), (-0.4, 1.1))
"""Offsets in pixels at which the map of shadows is read. Chosen, no source."""


def to_linear(colors: npt.NDArray[np.floating]) -> Colors:
    """Convert colors from files or the screen to linear light."""
    return np.asarray(np.power(np.maximum(colors, 0), GAMMA), dtype=np.float32)


def to_screen(colors: npt.NDArray[np.floating]) -> npt.NDArray[np.uint8]:
    """Convert linear light to eight bits per channel."""
    shown = np.power(np.clip(colors, 0, 1), 1 / GAMMA)
    return np.asarray(shown * 255 + 0.5).astype(np.uint8)


@dataclass(frozen=True)
class Lights:
    """Unit vectors toward the lights, in the world."""

    key: Floats
    fill: Floats


def place_lights(view: View) -> Lights:
    """Place the lights relative to the camera: the key light over its left shoulder."""
    right, toward = view.axes[0], np.cross(view.axes[0], [0.0, 0.0, 1.0])
    key = -0.55 * right + 0.55 * toward + np.array([0.0, 0.0, 1.05])
    fill = 0.9 * right + 0.6 * toward + np.array([0.0, 0.0, 0.35])
    return Lights(key / np.linalg.norm(key), fill / np.linalg.norm(fill))


def shade(albedo: Colors, normals: Colors, to_eye: Colors, lit: Colors, lights: Lights) -> Colors:
    """Compute the light that points of surfaces send to the eye.

    Args:
        albedo: Their colors, shape (n, 3).
        normals: Unit normals on the visible side, shape (n, 3).
        to_eye: Unit vectors to the eye, shape (n, 3).
        lit: Part of the key light that reaches each point, shape (n,).
        lights: The lights.
    """
    key, fill = lights.key.astype(np.float32), lights.fill.astype(np.float32)
    toward = np.maximum(normals @ key, 0) * lit
    sky = 0.5 + 0.5 * normals[:, 2]
    light = _EARTH + (_SKY - _EARTH) * sky + _KEY * toward + _FILL * np.maximum(normals @ fill, 0)
    half = to_eye + key
    half /= np.maximum(np.linalg.norm(half, axis=1, keepdims=True), 1e-6)
    glint = np.einsum("ij,ij->i", normals, half)
    albedo = _BLACK + albedo * (1 - _BLACK)
    shine = _SHINE * np.power(np.maximum(glint, 0), _HARDNESS) * lit
    return np.asarray(albedo * light[:, None] + shine[:, None], dtype=np.float32)


class ShadowMap:
    """Shadow map of a parallel light."""

    def __init__(self, corners: Floats, direction: Floats, resolution: int) -> None:
        """Render triangles, shape (m, 3, 3), from ``direction``, which points to the light."""
        side = np.cross([0.0, 0.0, 1.0], direction)
        length = float(np.linalg.norm(side))
        side = side / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
        self._axes = np.stack([side, np.cross(direction, side), direction])
        seen = transform_points(corners.reshape(-1, 3), self._axes)
        low, high = compute_bounds(seen)
        self.resolution = resolution
        self.texel = max(float((high - low)[:2].max()), 1e-12) / (resolution * 0.85)
        self._corner = (low + high)[:2] / 2 - self.texel * resolution / 2
        self._low, self._range = float(low[2]), max(float(high[2] - low[2]), 1e-12)
        flat = np.empty_like(seen)
        for axis in (0, 1):
            flat[:, axis] = (seen[:, axis] - self._corner[axis]) / self.texel
        flat[:, 2] = self._find_near(seen[:, 2])
        _, self._nearness = find_front(flat.reshape(-1, 3, 3), (resolution, resolution))

    def _find_near(self, along: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
        return 1.0 + (along - self._low) / self._range

    def compute_shadow(self) -> Colors:
        """Return the shadowed part of each block of 2 × 2 samples, as a square map."""
        half = self.resolution // 2
        square = (self._nearness > 0).reshape(half, 2, half, 2)
        return np.asarray(square.mean(axis=(1, 3)), dtype=np.float32)

    def compute_depths(self) -> Colors:
        """Return the first surface's coordinate toward the light by sample; -inf if none."""
        square = self._nearness.reshape(self.resolution, self.resolution)
        along = (square - 1) * np.float32(self._range) + np.float32(self._low)
        return np.asarray(np.where(square > 0, along, -np.inf), dtype=np.float32)

    def place(self, points: Colors) -> Colors:
        """Return columns and rows of points in the map, shape (2, n)."""
        axes = (self._axes[:2] / self.texel).astype(np.float32)
        corner = (self._corner / self.texel).astype(np.float32)
        return np.asarray(axes @ points.T - corner[:, None])

    def compute_light(self, points: Colors, normals: Colors) -> Colors:
        """Compute the part of the light, 0 … 1, that reaches points with unit normals."""
        # offset along the normal to avoid self-shadowing of coarse samples
        lifted = points + normals * np.float32(1.6 * self.texel)
        x, y = self.place(lifted)
        own = self._find_near(lifted @ self._axes[2].astype(np.float32))
        own = (own + 0.6 * self.texel / self._range).astype(np.float32)
        total = np.zeros(len(points), dtype=np.float32)
        last = self.resolution - 1
        for dx, dy in _TAPS:
            column = np.clip((x + np.float32(dx)).astype(np.int64), 0, last)
            row = np.clip((y + np.float32(dy)).astype(np.int64), 0, last)
            total += self._nearness[row * self.resolution + column] <= own
        return np.asarray(total / np.float32(len(_TAPS)))


def blur(values: Colors, radius: float) -> Colors:
    """Smooth a square of values by three box filters, which approximate a Gaussian."""
    reach = max(1, round(radius))
    for axis in (0, 1, 0, 1, 0, 1):
        padding = [(0, 0), (0, 0)]
        padding[axis] = (reach + 1, reach)
        total = np.cumsum(np.pad(values, padding), axis=axis, dtype=np.float64)
        ahead = np.take(total, range(2 * reach + 1, total.shape[axis]), axis=axis)
        behind = np.take(total, range(total.shape[axis] - 2 * reach - 1), axis=axis)
        values = ((ahead - behind) / (2 * reach + 1)).astype(np.float32)
    return values


def sample_map(values: Colors, at: Colors) -> Colors:
    """Sample a map at columns and rows, shape (2, n), bilinearly; 0 outside."""
    height, width = values.shape
    x, y = at[0] - 0.5, at[1] - 0.5
    inside = (x >= 0) & (y >= 0) & (x < width - 1) & (y < height - 1)
    x, y = np.where(inside, x, 0.0), np.where(inside, y, 0.0)
    column, row = x.astype(np.int64), y.astype(np.int64)
    right, down = (x - column).astype(np.float32), (y - row).astype(np.float32)
    flat, here = values.reshape(-1), row * width + column
    upper = flat[here] * (1 - right) + flat[here + 1] * right
    here = np.minimum(here + width, len(flat) - 2)
    lower = flat[here] * (1 - right) + flat[here + 1] * right
    return np.asarray(np.where(inside, upper * (1 - down) + lower * down, 0), dtype=np.float32)


def choose_spacing(size: float) -> float:
    """Return the grid width for an object of a size [m]: 1, 2 or 5 times a power of ten."""
    rough = max(size, 1e-12) / 4
    power = 10.0 ** math.floor(math.log10(rough))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= rough * 1.0000001)
