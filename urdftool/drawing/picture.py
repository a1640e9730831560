"""Rendering of shapes at poses, with numpy alone.

Libraries were rejected for their size: VTK takes 565 MB on disk and requires EGL or OSMesa, Numba
takes 208 MB. This renderer draws 36,000 textured triangles at 640 × 480 in 0.4 s of CPU time.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from ..model.pose import Pose
from .camera import Camera, View
from .clip import compute_near_plane, project_triangles
from .png_file import Image
from .points import compute_bounds, shift_points
from .raster import Floats, Indices, find_front, list_covered
from .scene import OPAQUE, Scene
from .shading import (
    Colors,
    ShadowMap,
    blur,
    choose_spacing,
    place_lights,
    sample_map,
    to_linear,
    to_screen,
)
from .shapes import Shapes

__all__ = ["SIZE", "draw"]

SIZE = (1280, 960)
"""Default width and height of a picture in pixels."""

FINER = 2
"""Samples along each side of a pixel. Chosen, no source."""

LAYERS = 12
"""Largest number of transparent surfaces drawn at one sample, the nearest first. Chosen, no
source."""

_CASTS = 0.5
"""Opacity above which a surface casts a shadow. Chosen, no source."""

_AT_ONCE = 20_000
"""Samples shaded at a time, which bounds memory."""

_BEFORE = np.float32(1.0005)  # a transparent surface that coincides with an opaque one is visible


def draw(
    shapes: Shapes,
    poses: Mapping[str, Pose],
    *,
    camera: Camera | View | None = None,
    size: tuple[int, int] = SIZE,
    ground: bool | float = True,
    background: tuple[float, float, float] | None = None,
) -> Image:
    """Render a picture of shapes, reproducible pixel by pixel.

    Args:
        shapes: From :func:`read_robot_shapes`.
        poses: Poses of the links in the world [m], by name; links without one are not drawn.
        camera: The viewpoint; a ``View`` is used as it is, a ``Camera`` is fitted to the shapes.
        size: Width and height in pixels; ignored if ``camera`` is a ``View``.
        ground: Whether there is a floor under the lowest point, or its height [m].
        background: Red, green and blue in 0 … 1; None for a light gradient.

    Returns:
        Pixels, shape (height, width, 3).
    """
    corners, normals, there = shapes.transform(poses)
    rows = np.flatnonzero(there)
    corners = corners[rows]
    view = view_of(corners, camera, size)
    pixels = make_background(view.size, background)
    if not len(rows):
        return to_screen(pixels)
    corners, view, middle, scale = _normalize_size(corners, view)
    lights = place_lights(view)
    thrower = corners[shapes.colors[rows, 3] > _CASTS]
    resolution = min(max(max(view.size) * 9 // 8, 768), 1536) // 2 * 2
    shadow = ShadowMap(thrower, lights.key, resolution) if len(thrower) else None
    floor = None
    if ground is not False:
        lowest = float(corners[..., 2].min())
        height = lowest if ground is True else (float(ground) - middle) / scale
        floor = Ground(height, corners, shadow, scale)
        floor.paint(pixels, view)
    fine = (view.size[0] * FINER, view.size[1] * FINER)
    scene = Scene(shapes, view, lights, shadow, rows, view.transform(corners), normals[rows], fine)
    light, opacity = _compute_samples(scene, shapes.colors[rows, 3] >= OPAQUE, floor)
    over = _average_pixels(opacity[:, None], view.size)
    return to_screen(_average_pixels(light, view.size) + pixels * (1 - over))


def _normalize_size(corners: Floats, view: View) -> tuple[Floats, View, float, float]:
    """Move triangles and camera to the origin and scale them to size 1, for single precision.

    Returns:
        Triangles, camera, height of the origin [m] and length of the unit [m].
    """
    low, high = compute_bounds(corners.reshape(-1, 3))
    middle = low + (high - low) / 2
    scale = float((high - low).max()) or 1.0
    moved = View(view.axes, (view.eye - middle) / scale, view.reach, view.size)
    return shift_points(corners, -middle) / scale, moved, float(middle[2]), scale


def view_of(corners: Floats, camera: Camera | View | None, size: tuple[int, int]) -> View:
    """Position a camera for triangles [m] in the world, shape (m, 3, 3)."""
    if isinstance(camera, View):
        return camera
    points = corners.reshape(-1, 3)
    if not len(points):
        points = np.array([[-0.5, -0.5, 0.0], [0.5, 0.5, 1.0]])
    return (camera or Camera()).view(points, size)


def _compute_samples(
    scene: Scene, opaque: npt.NDArray[np.bool_], floor: Ground | None
) -> tuple[Colors, Colors]:
    """Compute light and opacity of each sample; transparent surfaces are blended on top."""
    count = scene.size[0] * scene.size[1]
    light, opacity = np.zeros((count, 3), np.float32), np.zeros(count, np.float32)
    solid, clear = np.flatnonzero(opaque), np.flatnonzero(~opaque)
    plane = compute_near_plane(scene.corners)
    flat, owner = project_triangles(scene.corners[solid], scene.view.reach, scene.size, plane)
    first, nearness = find_front(flat, scene.size)
    samples = np.flatnonzero(first >= 0)
    _put(scene, samples, solid[owner[first[samples]]], floor, light, opacity)
    if len(clear):
        flat, owner = project_triangles(scene.corners[clear], scene.view.reach, scene.size, plane)
        parts = [
            (found.sample[ahead], found.nearness[ahead], clear[owner[found.triangle[ahead]]])
            for found in list_covered(flat, scene.size)
            for ahead in [found.nearness * _BEFORE > nearness[found.sample]]
        ]
        if parts:
            _blend_layers(scene, parts, floor, light, opacity)
    return light, opacity


def _blend_layers(
    scene: Scene,
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
    scene: Scene,
    samples: Indices,
    triangles: Indices,
    floor: Ground | None,
    light: Colors,
    opacity: Colors,
) -> None:
    """Blend triangles onto samples, except below the floor."""
    for begin in range(0, len(samples), _AT_ONCE):
        some = slice(begin, begin + _AT_ONCE)
        _put_some(scene, samples[some], triangles[some], floor, light, opacity)


def _put_some(
    scene: Scene,
    samples: Indices,
    triangles: Indices,
    floor: Ground | None,
    light: Colors,
    opacity: Colors,
) -> None:
    color, alpha, heights = scene.compute_shading(triangles, samples)
    if floor is not None and scene.view.eye[2] > floor.height:
        alpha = np.where(heights < floor.height - 1e-4, np.float32(0), alpha)
    alpha = np.where(alpha >= OPAQUE, np.float32(1), alpha)
    light[samples] = light[samples] * (1 - alpha[:, None]) + color * alpha[:, None]
    opacity[samples] = opacity[samples] * (1 - alpha) + alpha


def _average_pixels(samples: Colors, size: tuple[int, int]) -> Colors:
    """Average the samples of each pixel."""
    width, height = size
    cut = samples.reshape(height, FINER, width, FINER, samples.shape[1])
    total = sum(cut[:, y, :, x] for y in range(FINER) for x in range(FINER))
    return np.asarray(total / np.float32(FINER**2))


BACKDROP = ((0.985, 0.987, 0.99), (0.87, 0.885, 0.905))
"""Colors of the backdrop at its upper and lower edge, as displayed. Chosen, no source."""

_FLOOR = (0.80, 0.815, 0.835)
"""Color of the floor, as displayed. Chosen, no source."""

_LINE = (0.66, 0.68, 0.71)
"""Color of the lines on the floor, as displayed. Chosen, no source."""

_SHADE, _CONTACT = 0.50, 0.45
"""Share of light that a shadow, and a contact, takes from the floor. Chosen, no source."""

_SOFT, _NEAR = 0.010, 0.016  # relative to the width of the map; chosen
_CONTACT_MAP = 256
"""Pixels along each side of the map of contacts. Chosen, no source."""

_FAR = 3.0
"""Radius of the floor, relative to that of the scene. Chosen, no source."""


def make_background(size: tuple[int, int], color: tuple[float, float, float] | None) -> Colors:
    """Return one color or a vertical gradient in linear light, shape (height, width, 3)."""
    width, height = size
    if color is not None:
        return np.array(np.broadcast_to(to_linear(np.array(color)), (height, width, 3)))
    top, bottom = (np.array(edge) for edge in BACKDROP)
    part = np.linspace(0, 1, height)[:, None, None]
    return np.array(np.broadcast_to(to_linear(top + (bottom - top) * part), (height, width, 3)))


class Ground:
    """A level floor under a robot scaled to size 1 about the origin."""

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
