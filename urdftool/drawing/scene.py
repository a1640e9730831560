"""Shading of samples: point, normal, color and light of the surface at each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .camera import View
from .raster import Floats, Indices
from .shading import Colors, Lights, ShadowMap, shade, to_linear
from .shapes import Shapes
from .texture import sample_texture

OPAQUE = 0.995
"""Opacity above which a surface counts as opaque."""


@dataclass
class Scene:
    """Triangles with camera and lights.

    Attributes:
        shapes: The shapes that contain the triangles.
        view: The camera.
        lights: The lights.
        shadow: Shadow map of the key light.
        rows: Rows of the triangles in ``shapes``.
        corners: Corners in the camera's axes, from the eye.
        normals: Normals at the corners, in the world.
        size: Columns and rows of samples.
    """

    shapes: Shapes
    view: View
    lights: Lights
    shadow: ShadowMap | None
    rows: Indices
    corners: Floats
    normals: Floats
    size: tuple[int, int]

    def compute_shading(
        self, triangles: Indices, samples: Indices
    ) -> tuple[Colors, Colors, Colors]:
        """Compute light, opacity, and height in the world at samples that triangles cover.

        A ray d from the eye meets the plane of a triangle a b c at barycentric weights proportional
        to d·(b×c), d·(c×a) and d·(a×b); their sum is d·n with n = (b-a)×(c-a).

        Args:
            triangles: Row of the triangle of each sample, shape (n,).
            samples: Indices of the samples, shape (n,).
        """
        used, row = _compact(triangles, len(self.corners))
        a, b, c = (self.corners[used, k] for k in range(3))
        areas = np.stack([_compute_cross(b, c), _compute_cross(c, a), _compute_cross(a, b)], axis=1)
        planes = _compute_cross(b - a, c - a)
        # scaled to stay within single precision
        largest = np.abs(areas).max(axis=(1, 2), initial=0.0)
        largest = np.where(largest > 0, largest, 1.0)[:, None]
        offsets = (np.einsum("ij,ij->i", a, planes)[:, None] / largest).astype(np.float32)[:, 0]
        areas = (areas / largest[..., None]).astype(np.float32)
        planes = (planes / largest).astype(np.float32)
        rays = self._compute_rays(samples)
        weights = np.einsum("nij,nj->ni", areas[row], rays)
        slant = np.einsum("ni,ni->n", planes[row], rays)
        weights = np.clip(weights / np.where(slant == 0, 1, slant)[:, None], 0, 1)
        weights /= np.maximum(weights.sum(axis=1, keepdims=True), np.float32(1e-9))
        # a ray nearly parallel to its plane has an unbounded hit; the corners limit its depth
        depth = -self.corners[used, :, 2].astype(np.float32)
        far = offsets[row] / np.where(slant == 0, 1, slant)
        far = np.clip(far, depth.min(axis=1)[row], depth.max(axis=1)[row])
        normals = np.einsum("ni,nij->nj", weights, self.normals[used].astype(np.float32)[row])
        _normalize(normals)
        normals *= np.where(slant > 0, np.float32(-1), np.float32(1))[:, None]
        axes = self.view.axes.astype(np.float32)
        rays = rays @ axes
        world = rays * far[:, None] + self.view.eye.astype(np.float32)
        to_eye = -rays
        _normalize(to_eye)
        lit = np.ones(len(world), dtype=np.float32)
        if self.shadow is not None:
            lit = self.shadow.compute_light(world, normals)
        colors, opacity = self._compute_colors(self.rows[used], row, weights)
        return shade(colors, normals, to_eye, lit, self.lights), opacity, world[:, 2]

    def _compute_rays(self, samples: Indices) -> Colors:
        """Return rays from the eye through samples, in the camera's axes, with z = -1."""
        width, height = self.size
        rays = np.empty((len(samples), 3), dtype=np.float32)
        line, column = np.divmod(samples, width)
        rays[:, 0] = ((column + 0.5) * (2 / width) - 1) * self.view.reach[0]
        rays[:, 1] = (1 - (line + 0.5) * (2 / height)) * self.view.reach[1]
        rays[:, 2] = -1
        return rays

    def _compute_colors(
        self, used: Indices, row: Indices, weights: Colors
    ) -> tuple[Colors, Colors]:
        """Return colors in linear light and opacities, including images."""
        plain = self.shapes.colors[used]
        colors = to_linear(plain[:, :3])[row]
        images = self.shapes.image[used]
        for number in np.unique(images[images >= 0]):
            some = np.flatnonzero((images == number)[row])
            uv = np.einsum("ni,nij->nj", weights[some], self.shapes.uv[used][row[some]])
            texels = sample_texture(self.shapes.images[number], uv)
            colors[some] *= to_linear(texels[:, :3])
        return colors, plain[:, 3].astype(np.float32)[row]


def _compact(triangles: Indices, count: int) -> tuple[Indices, Indices]:
    """Return the distinct triangles, sorted, and for each sample its index among them."""
    there = np.zeros(count, dtype=bool)
    there[triangles] = True
    number = np.cumsum(there) - 1
    return np.flatnonzero(there), number[triangles]


def _compute_cross(one: Floats, other: Floats) -> Floats:
    """Compute cross products of rows, several times faster than numpy."""
    made = np.empty_like(one)
    for axis, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        made[:, axis] = one[:, i] * other[:, j] - one[:, j] * other[:, i]
    return made


def _normalize(rows: Colors) -> None:
    """Normalize rows in place."""
    length = np.sqrt(np.einsum("ni,ni->n", rows, rows))
    rows /= np.maximum(length, np.float32(1e-9))[:, None]
