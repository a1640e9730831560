"""Cameras: viewpoint, perspective and framing of a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .points import compute_bounds, compute_extent, shift_points, transform_points
from .raster import Floats

MARGIN = 0.06
"""Part of the picture's width or height that stays empty on each side. Chosen, no source."""


@dataclass(frozen=True)
class View:
    """A camera at a fixed position.

    Attributes:
        axes: Right, up and backward (toward the viewer) in the world, as rows.
        eye: Position [m].
        reach: Half the width and half the height of the view at distance 1.
        size: Width and height of the picture in pixels.
    """

    axes: Floats
    eye: Floats
    reach: tuple[float, float]
    size: tuple[int, int]

    def transform(self, points: Floats) -> Floats:
        """Transform world points [m] to the camera frame; points in front of it have z < 0."""
        return transform_points(shift_points(points, -self.eye), self.axes)

    def project(self, points: Floats) -> Floats:
        """Project world points to the picture: column and row, from the upper left."""
        seen = self.transform(points)
        flat = seen[..., :2] / -seen[..., 2:]
        half = np.array(self.size) / 2
        return np.asarray(half + flat / np.array(self.reach) * half * [1, -1])


@dataclass(frozen=True)
class Camera:
    """A view direction, upright, with perspective.

    Attributes:
        azimuth: Angle of the camera about the vertical [rad]: 0 is in front of the robot (+x), π/2
            on its left (+y).
        elevation: Angle of the camera above the horizon [rad].
        distance: Distance to the target [m]; None to fit all points.
        target: World point at the center of the picture [m]; None for the center of all points.
        field_of_view: Angle spanned by the shorter side of the picture [rad].
    """

    azimuth: float = math.radians(-40.0)
    elevation: float = math.radians(22.0)
    distance: float | None = None
    target: tuple[float, float, float] | None = None
    field_of_view: float = math.radians(32.0)

    @property
    def axes(self) -> Floats:
        """Return right, up and backward (toward the viewer), as rows."""
        ca, sa = math.cos(self.azimuth), math.sin(self.azimuth)
        ce, se = math.cos(self.elevation), math.sin(self.elevation)
        return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])

    def view(self, points: Floats, size: tuple[int, int]) -> View:
        """Position the camera for a picture of points [m], shape (n, 3), n > 0."""
        axes = self.axes
        half = math.tan(self.field_of_view / 2)
        shorter = min(size)
        reach = (half * size[0] / shorter, half * size[1] / shorter)
        if self.target is None and self.distance is None:
            return View(axes, _fit_eye(transform_points(points, axes), reach) @ axes, reach, size)
        low, high = compute_bounds(points)
        target = (low + high) / 2 if self.target is None else np.array(self.target)
        distance = self.distance
        if distance is None:
            around = np.abs((points - target) @ axes.T)
            near = (points - target) @ axes[2]
            room = 1 - 2 * MARGIN
            wide = [around[:, k] / (reach[k] * room) + near for k in (0, 1)]
            distance = max(float(max(wide[0].max(), wide[1].max())), 1e-9)
        return View(axes, target + axes[2] * distance, reach, size)


def _fit_eye(placed: Floats, reach: tuple[float, float]) -> Floats:
    """Compute the nearest eye, in the camera's axes, from which all points are in view.

    A point (r, u, b) is in view of an eye (x, y, z) if |r - x| ≤ t (z - b), with t half the width
    of the view at distance 1; likewise for u. For each side of the picture the outermost point sets
    a bound that is linear in the eye.
    """
    middle, distances = [], []
    back = placed[:, 2]
    for axis in (0, 1):
        slope = reach[axis] * (1 - 2 * MARGIN)
        more = float((placed[:, axis] + slope * back).max())
        less = float((slope * back - placed[:, axis]).max())
        distances.append((more + less) / (2 * slope))
        middle.append((more - less) / 2)
    size = compute_extent(placed)
    ahead = max(*distances, float(back.max()) + max(1e-3 * size, 1e-9))
    return np.array([middle[0], middle[1], ahead])
