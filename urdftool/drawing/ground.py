"""Background of a picture: a light backdrop, and a floor with a grid and soft shadows."""

from __future__ import annotations

import numpy as np

from .camera import View
from .raster import Floats
from .shading import Colors, ShadowMap, blur, choose_spacing, sample_map, to_linear

BACKDROP = ((0.985, 0.987, 0.99), (0.87, 0.885, 0.905))
"""Colors of the backdrop at its upper and lower edge, as displayed."""

_FLOOR = (0.80, 0.815, 0.835)
_LINE = (0.66, 0.68, 0.71)
_SHADE, _CONTACT = 0.50, 0.45
_SOFT, _NEAR = 0.010, 0.016  # relative to the width of the map
_CONTACT_MAP = 256
_FAR = 3.0


def make_background(size: tuple[int, int], color: tuple[float, float, float] | None) -> Colors:
    """Return one color or a vertical gradient in linear light, shape (height, width, 3)."""
    width, height = size
    if color is not None:
        return np.array(np.broadcast_to(to_linear(np.array(color)), (height, width, 3)))
    top, bottom = (np.array(edge) for edge in BACKDROP)
    part = np.linspace(0, 1, height)[:, None, None]
    return np.array(np.broadcast_to(to_linear(top + (bottom - top) * part), (height, width, 3)))


class Ground:
    """A level floor under a robot scaled to size 1 about the origin.

    Attributes:
        height: Height of the floor.
    """

    def __init__(
        self, height: float, corners: Floats, shadow: ShadowMap | None, scale: float
    ) -> None:
        """Create a floor under triangles, shape (m, 3, 3).

        Args:
            height: Height of the floor.
            corners: The triangles.
            shadow: Shadow map of the key light.
            scale: Length of one unit [m], for the grid.
        """
        self.height = height
        self._grid = choose_spacing(scale) / scale
        self._shadow = shadow
        self._soft = None
        if shadow is not None:
            covered = shadow.compute_shadow()
            self._soft = blur(covered, _SOFT * len(covered))
        self._touch = self._map_contact(corners)

    def _map_contact(self, corners: Floats) -> tuple[ShadowMap, Colors] | None:
        """Map the triangles close to the floor from below; None if there are none."""
        reach = 0.10
        low = corners[corners[..., 2].min(axis=1) < self.height + reach]
        if not len(low):
            return None
        seen = ShadowMap(low, np.array([0.0, 0.0, -1.0]), _CONTACT_MAP)
        gap = np.clip((-seen.compute_depths() - self.height) / reach, 0, 1)
        return seen, blur(np.square(1 - gap), _NEAR * _CONTACT_MAP)

    def paint(self, pixels: Colors, view: View) -> None:
        """Paint the visible floor onto a backdrop of pixels in linear light."""
        if view.eye[2] <= self.height:
            return
        width, height = view.size
        x = ((np.arange(width) + 0.5) / width * 2 - 1) * view.reach[0]
        y = (1 - (np.arange(height) + 0.5) / height * 2) * view.reach[1]
        right, up, back = view.axes
        # the camera is upright, so each row of pixels has one slope
        falls = np.flatnonzero(y * up[2] - back[2] < -1e-6)
        along = (self.height - view.eye[2]) / (y[falls] * up[2] - back[2])
        forward = view.eye[:2] + along[:, None] * (y[falls, None] * up[:2] - back[:2])
        at = (forward[:, None] + (along[:, None] * x)[..., None] * right[:2]).astype(np.float32)
        there = np.einsum("ijk,ijk->ij", at, at) < _FAR**2
        rows, columns = np.nonzero(there)
        if not len(rows):
            return
        points = at[there]
        strength = np.clip((_FAR - np.hypot(points[:, 0], points[:, 1])) / 2.4, 0, 1)
        strength = strength * strength * (3 - 2 * strength)
        # extent of a pixel on the floor, larger at grazing angles
        lean = np.maximum((back[2] - y[falls] * up[2]) / np.sqrt(1 + y[falls] ** 2), 0.05)
        span = (2 * view.reach[1] / height * along / np.sqrt(lean)).astype(np.float32)[rows]
        line = self._draw_lines(points, span)[:, None]
        floor = to_linear(np.array(_FLOOR))
        color = floor + (to_linear(np.array(_LINE)) - floor) * line
        dark = self._compute_shadow(points) * np.minimum(strength * 2, 1)
        here = pixels[falls[rows], columns]
        here += (color - here) * (strength * np.float32(0.85))[:, None]
        pixels[falls[rows], columns] = here * (1 - dark)[:, None]

    def _draw_lines(self, points: Colors, span: Colors) -> Colors:
        width = np.float32(self._grid)
        near = np.abs(points - np.round(points / width) * width)
        near = np.minimum(near[:, 0], near[:, 1])
        thick = 0.006 * width
        # fade lines that are thinner than a pixel
        cover = np.clip((thick + span / 2 - near) / span, 0, 1)
        cover *= np.minimum(2 * thick / span + 0.35, 1)
        return np.asarray(cover * np.clip(1.5 - span * 6 / width, 0, 1), dtype=np.float32)

    def _compute_shadow(self, points: Colors) -> Colors:
        level = np.full((len(points), 1), self.height, np.float32)
        on_floor = np.concatenate([points, level], axis=1)
        clear = np.ones(len(points), dtype=np.float32)
        if self._soft is not None and self._shadow is not None:
            clear *= 1 - _SHADE * sample_map(
                self._soft, self._shadow.place(on_floor) * np.float32(0.5)
            )
        if self._touch is not None:
            clear *= 1 - _CONTACT * sample_map(self._touch[1], self._touch[0].place(on_floor))
        return 1 - clear
