"""Shapes at poses to pixels, with numpy alone.

Libraries that do this were measured and left: VTK (565 MB installed) and MuJoCo want a GL library
of the system where there is no screen, Numba brings 208 MB and compiles for seconds; this draws a
robot of 50,000 triangles in a fraction of a second and the same bytes on every machine.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..model.pose import Pose
from .camera import Camera, View
from .clip import clipped
from .ground import Ground, backdrop
from .light import Colors, Lights, ShadowMap, lights_of, shade, to_linear, to_screen
from .png_file import Image, png
from .raster import Floats, Indices, covered, front
from .shapes import Shapes
from .texture import looked_up

__all__ = ["SIZE", "draw", "png"]

SIZE = (1280, 960)
"""Width and height of a picture in pixels."""

FINER = 2
"""Samples along each side of a pixel."""

LAYERS = 12
"""See-through surfaces one behind the other that are drawn; those in front count."""

_OPAQUE = 0.995


@dataclass
class _Scene:
    """Triangles in the world, and how they are seen.

    Attributes:
        rows: Their rows in ``shapes``.
        corners: Their corners in the camera's axes, from the eye [m].
        normals: Their normals at the corners, in the world.
    """

    shapes: Shapes
    view: View
    lights: Lights
    shadow: ShadowMap | None
    rows: Indices
    corners: Floats
    normals: Floats
    size: tuple[int, int]

    def shaded(self, triangles: Indices, samples: Indices) -> tuple[Colors, Colors, Floats]:
        """Light, opacity, and heights [m] in the world at samples that triangles cover."""
        view = self.view
        rays = self._rays(samples)
        a, b, c = (self.corners[triangles, k] for k in range(3))
        weights = np.stack(
            [
                np.einsum("ij,ij->i", rays, np.cross(one, other))
                for one, other in ((b, c), (c, a), (a, b))
            ],
            axis=1,
        )
        total = weights.sum(axis=1, keepdims=True)
        weights = weights / np.where(total == 0, 1.0, total)
        weights = np.clip(weights, 0, 1)
        weights /= np.maximum(weights.sum(axis=1, keepdims=True), 1e-9)
        points = weights[:, :1] * a + weights[:, 1:2] * b + weights[:, 2:] * c
        normals = np.einsum("ni,nij->nj", weights, self.normals[triangles])
        away = np.einsum("ij,ij->i", np.cross(b - a, c - a), rays) > 0
        normals[away] *= -1
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
        world = points @ view.axes + view.eye
        to_eye = -points @ view.axes
        to_eye /= np.maximum(np.linalg.norm(to_eye, axis=1, keepdims=True), 1e-12)
        lit = np.ones(len(points), dtype=np.float32)
        if self.shadow is not None:
            lit = self.shadow.lit(world, normals)
        rows = self.rows[triangles]
        colors = self._colors(rows, weights)
        light = shade(
            to_linear(colors[:, :3]),
            normals.astype(np.float32),
            to_eye.astype(np.float32),
            lit,
            self.lights,
        )
        return light, colors[:, 3].astype(np.float32), world[:, 2]

    def _rays(self, samples: Indices) -> Floats:
        width, height = self.size
        x = (samples % width + 0.5) / width * 2 - 1
        y = 1 - (samples // width + 0.5) / height * 2
        across, upward = x * self.view.reach[0], y * self.view.reach[1]
        return np.stack([across, upward, np.full(len(samples), -1.0)], axis=1)

    def _colors(self, rows: Indices, weights: Floats) -> Floats:
        colors = self.shapes.colors[rows]
        images = self.shapes.image[rows]
        for number in np.unique(images[images >= 0]):
            some = np.flatnonzero(images == number)
            uv = np.einsum("ni,nij->nj", weights[some], self.shapes.uv[rows[some]])
            texels = looked_up(self.shapes.images[number], uv)
            colors[some] = colors[some] * np.concatenate(
                [texels[:, :3], np.ones((len(some), 1))], axis=1
            )
        return colors


def draw(
    shapes: Shapes,
    poses: Mapping[str, Pose],
    *,
    camera: Camera | View | None = None,
    size: tuple[int, int] = SIZE,
    ground: bool | float = True,
    background: tuple[float, float, float] | None = None,
) -> Image:
    """A picture of shapes, the same pixels each time.

    Args:
        shapes: From :func:`robot_shapes`.
        poses: Where each link is in the world [m], by name; links without one are not drawn.
        camera: Where it is taken from; a ``View`` stands still from picture to picture, a
            ``Camera`` looks at what is there.
        size: Width and height in pixels; that of a ``View`` comes first.
        ground: Whether there is a floor under the lowest point, or the height of it [m].
        background: Red, green and blue in 0 … 1 behind it all; None for a light backdrop.

    Returns:
        Rows of pixels, shape (height, width, 3).
    """
    corners, normals, there = shapes.posed(poses)
    rows = np.flatnonzero(there)
    corners, normals = corners[rows], normals[rows]
    view = view_of(corners, camera, size)
    lights = lights_of(view)
    pixels = backdrop(view.size, background)
    if not len(rows):
        return to_screen(pixels)
    solid = shapes.colors[rows, 3] >= _OPAQUE
    thrower = corners[shapes.colors[rows, 3] > 0.5]
    shadow = ShadowMap(thrower, lights.key) if len(thrower) else None
    floor = _floor(ground, corners, shadow, lights)
    if floor is not None:
        floor.paint(pixels, view)
    fine = (view.size[0] * FINER, view.size[1] * FINER)
    scene = _Scene(shapes, view, lights, shadow, rows, view.seen(corners), normals, fine)
    light, opacity = _solid(scene, np.flatnonzero(solid), floor)
    image = _meshed(light, view.size), _meshed(opacity[:, None], view.size)
    pixels = image[0] + pixels * (1 - image[1])
    return to_screen(pixels)


def view_of(corners: Floats, camera: Camera | View | None, size: tuple[int, int]) -> View:
    """A camera in its place for triangles [m] in the world, shape (m, 3, 3)."""
    if isinstance(camera, View):
        return camera
    points = corners.reshape(-1, 3)
    if not len(points):
        points = np.array([[-0.5, -0.5, 0.0], [0.5, 0.5, 1.0]])
    return (camera or Camera()).view(points, size)


def _floor(
    ground: bool | float, corners: Floats, shadow: ShadowMap | None, lights: Lights
) -> Ground | None:
    if ground is False:
        return None
    height = float(corners[..., 2].min()) if ground is True else float(ground)
    return Ground(height, corners, shadow, lights)


def _solid(scene: _Scene, solid: Indices, floor: Ground | None) -> tuple[Colors, Colors]:
    """Light and opacity at each sample: what is not see-through, and then what is before it."""
    count = scene.size[0] * scene.size[1]
    light, opacity = np.zeros((count, 3), np.float32), np.zeros(count, np.float32)
    flat, owner = clipped(scene.corners[solid], scene.view.reach, scene.size)
    first, nearness = front(flat, scene.size)
    samples = np.flatnonzero(first >= 0)
    triangles = solid[owner[first[samples]]]
    _put(scene, samples, triangles, floor, light, opacity)
    clear = np.setdiff1d(np.arange(len(scene.rows)), solid, assume_unique=True)
    if len(clear):
        flat, owner = clipped(scene.corners[clear], scene.view.reach, scene.size)
        parts = [
            (found.sample[ahead], found.nearness[ahead], clear[owner[found.triangle[ahead]]])
            for found in covered(flat, scene.size)
            for ahead in [found.nearness > nearness[found.sample]]
        ]
        if parts:
            _layers(scene, parts, floor, light, opacity)
    return light, opacity


def _layers(
    scene: _Scene,
    parts: list[tuple[Indices, npt.NDArray[np.float32], Indices]],
    floor: Ground | None,
    light: Colors,
    opacity: Colors,
) -> None:
    sample, near, triangle = (np.concatenate(some) for some in zip(*parts, strict=True))
    order = np.lexsort((triangle, -near, sample))
    sample, triangle = sample[order], triangle[order]
    begins = np.r_[True, sample[1:] != sample[:-1]]
    starts = np.flatnonzero(begins)
    rank = np.arange(len(sample)) - np.repeat(starts, np.diff(np.r_[starts, len(sample)]))
    for layer in range(min(LAYERS, int(rank.max(initial=-1)) + 1) - 1, -1, -1):
        some = np.flatnonzero(rank == layer)
        _put(scene, sample[some], triangle[some], floor, light, opacity)


def _put(
    scene: _Scene,
    samples: Indices,
    triangles: Indices,
    floor: Ground | None,
    light: Colors,
    opacity: Colors,
) -> None:
    """Lay triangles over samples, as far as they are not under the floor."""
    if not len(samples):
        return
    color, alpha, heights = scene.shaded(triangles, samples)
    if floor is not None and scene.view.eye[2] > floor.height:
        span = 1e-4 * float(np.ptp(scene.corners.reshape(-1, 3), axis=0).max())
        alpha = np.where(heights < floor.height - span, 0, alpha).astype(np.float32)
    alpha = np.where(alpha >= _OPAQUE, np.float32(1), alpha)
    light[samples] = light[samples] * (1 - alpha[:, None]) + color * alpha[:, None]
    opacity[samples] = opacity[samples] * (1 - alpha) + alpha


def _meshed(samples: Colors, size: tuple[int, int]) -> Colors:
    """The mean of the samples of each pixel."""
    width, height = size
    cut = samples.reshape(height, FINER, width, FINER, samples.shape[1])
    return np.asarray(cut.mean(axis=(1, 3)))
