"""What is behind the robot: a light backdrop, and a floor with a grid and soft shadows."""

from __future__ import annotations

import numpy as np

from .camera import View
from .light import Colors, Lights, ShadowMap, blurred, sampled, spacing, to_linear
from .raster import Floats

BACKDROP = ((0.985, 0.987, 0.99), (0.87, 0.885, 0.905))
"""Colours of the backdrop at its upper and lower edge, as a screen shows them."""

_FLOOR = (0.80, 0.815, 0.835)
_LINE = (0.66, 0.68, 0.71)
_SHADE, _CONTACT = 0.50, 0.45
_SOFT, _NEAR = 9.0, 14.0
_CONTACT_MAP = 512


def backdrop(size: tuple[int, int], color: tuple[float, float, float] | None) -> Colors:
    """Rows of pixels in linear light: one colour, or from light to less light."""
    width, height = size
    if color is not None:
        return np.array(np.broadcast_to(to_linear(np.array(color)), (height, width, 3)))
    top, bottom = (np.array(edge) for edge in BACKDROP)
    part = np.linspace(0, 1, height)[:, None, None]
    return np.array(np.broadcast_to(to_linear(top + (bottom - top) * part), (height, width, 3)))


class Ground:
    """A level floor.

    Attributes:
        height: Of it [m].
    """

    def __init__(
        self, height: float, corners: Floats, shadow: ShadowMap | None, lights: Lights
    ) -> None:
        """A floor under triangles [m], shape (m, 3, 3), that throw the shadow."""
        self.height = height
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        self._middle = (low + high)[:2] / 2
        self._size = max(float((high - low).max()), 1e-9)
        self._shadow, self._lights = shadow, lights
        self._soft = None if shadow is None else blurred(shadow.covered, _SOFT)
        self._touch = self._contact(corners)

    def _contact(self, corners: Floats) -> tuple[ShadowMap, Colors] | None:
        """What is close to the floor, seen from below."""
        reach = 0.10 * self._size
        low = corners[..., 2].min(axis=1) < self.height + reach
        if not low.any():
            return None
        seen = ShadowMap(corners[low], np.array([0.0, 0.0, -1.0]), _CONTACT_MAP)
        gap = np.maximum(seen.depths() * -1 - self.height, 0) / reach
        close = np.where(seen.covered > 0, np.clip(1 - gap, 0, 1) ** 2, 0).astype(np.float32)
        return seen, blurred(close, _NEAR * _CONTACT_MAP / 1024)

    def paint(self, pixels: Colors, view: View) -> None:
        """Draw it onto a backdrop, rows of pixels in linear light, as far as it is ahead."""
        if view.eye[2] <= self.height:
            return
        width, height = view.size
        across = ((np.arange(width) + 0.5) / width * 2 - 1) * view.reach[0]
        upward = (1 - (np.arange(height) + 0.5) / height * 2) * view.reach[1]
        rays = (
            across[None, :, None] * view.axes[0]
            + upward[:, None, None] * view.axes[1]
            - view.axes[2]
        )
        falls = rays[..., 2] < -1e-6
        along = (self.height - view.eye[2]) / np.where(falls, rays[..., 2], -1.0)
        at = view.eye[:2] + rays[..., :2] * along[..., None]
        distance = np.linalg.norm(at - self._middle, axis=2) / self._size
        there = falls & (distance < 3.0)
        rows, columns = np.nonzero(there)
        if not len(rows):
            return
        strength = np.clip((3.0 - distance[there]) / 2.4, 0, 1)
        strength = (strength * strength * (3 - 2 * strength))[:, None].astype(np.float32)
        points = at[there]
        # how much floor a pixel spans, by its height over the horizon
        span = 2 * view.reach[1] / height * along[there] * np.linalg.norm(rays[there], axis=1)
        lean = np.maximum(-rays[there][:, 2] / np.linalg.norm(rays[there], axis=1), 0.05)
        line = self._lines(points, span / np.sqrt(lean))[:, None]
        floor = to_linear(np.array(_FLOOR))
        color = floor + (to_linear(np.array(_LINE)) - floor) * line
        dark = self._darkness(points)[:, None]
        pixels[rows, columns] += (color - pixels[rows, columns]) * strength * 0.85
        pixels[rows, columns] *= 1 - dark * np.minimum(strength * 2, 1)

    def _lines(self, points: Floats, span: Floats) -> Colors:
        width = spacing(self._size)
        near = np.abs(points / width - np.round(points / width)) * width
        thick = 0.006 * width
        # a line thinner than a pixel is fainter instead
        cover = np.clip((thick + span[:, None] / 2 - near) / span[:, None], 0, 1)
        cover *= np.minimum(2 * thick / span[:, None] + 0.35, 1)
        fine = np.clip(1.5 - span * 6 / width, 0, 1)
        return np.asarray(cover.max(axis=1) * fine, dtype=np.float32)

    def _darkness(self, points: Floats) -> Colors:
        level = np.full((len(points), 1), self.height)
        on_floor = np.concatenate([points, level], axis=1)
        clear = np.ones(len(points), dtype=np.float32)
        if self._soft is not None and self._shadow is not None:
            clear *= 1 - _SHADE * sampled(self._soft, self._shadow.place(on_floor))
        if self._touch is not None:
            clear *= 1 - _CONTACT * sampled(self._touch[1], self._touch[0].place(on_floor))
        return 1 - clear
