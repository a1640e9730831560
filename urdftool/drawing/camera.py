"""Where a picture is taken from."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .points import bounds, extent, shifted, turned
from .raster import Floats

MARGIN = 0.06
"""Part of the picture's width or height that stays free at either side."""


@dataclass(frozen=True)
class View:
    """A camera in its place.

    Attributes:
        axes: Right, up and towards the viewer in the world, as rows.
        eye: Where it is [m].
        reach: Half the width and half the height of what is seen at a distance of one.
        size: Width and height of the picture in pixels.
    """

    axes: Floats
    eye: Floats
    reach: tuple[float, float]
    size: tuple[int, int]

    def seen(self, points: Floats) -> Floats:
        """Points [m] of the world in the camera's axes, from the eye; what is ahead has z < 0."""
        return turned(shifted(points, -self.eye), self.axes)

    def pixels(self, points: Floats) -> Floats:
        """Where points of the world are in the picture: column and row, from the upper left."""
        seen = self.seen(points)
        flat = seen[..., :2] / -seen[..., 2:]
        half = np.array(self.size) / 2
        return np.asarray(half + flat / np.array(self.reach) * half * [1, -1])


@dataclass(frozen=True)
class Camera:
    """A direction to look from, upright, with perspective.

    Attributes:
        azimuth: Where it stands about the vertical [rad]: 0 is in front, where x points, and
            π/2 to the left of the robot, where y points.
        elevation: How high it stands over the horizon [rad].
        distance: From what it looks at [m]; None for where all of it just fits.
        target: What it looks at [m], in the world; None for the middle of all that is seen.
        field_of_view: The angle that the shorter side of the picture spans [rad].
    """

    azimuth: float = math.radians(-40.0)
    elevation: float = math.radians(22.0)
    distance: float | None = None
    target: tuple[float, float, float] | None = None
    field_of_view: float = math.radians(32.0)

    @property
    def axes(self) -> Floats:
        """Right, up and towards the viewer, as rows."""
        ca, sa = math.cos(self.azimuth), math.sin(self.azimuth)
        ce, se = math.cos(self.elevation), math.sin(self.elevation)
        return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])

    def view(self, points: Floats, size: tuple[int, int]) -> View:
        """The camera in its place for a picture of points [m], shape (n, 3), n > 0."""
        axes = self.axes
        half = math.tan(self.field_of_view / 2)
        shorter = min(size)
        reach = (half * size[0] / shorter, half * size[1] / shorter)
        if self.target is None and self.distance is None:
            return View(axes, _fitted(turned(points, axes), reach) @ axes, reach, size)
        low, high = bounds(points)
        target = (low + high) / 2 if self.target is None else np.array(self.target)
        distance = self.distance
        if distance is None:
            around = np.abs((points - target) @ axes.T)
            near = (points - target) @ axes[2]
            room = 1 - 2 * MARGIN
            wide = [around[:, k] / (reach[k] * room) + near for k in (0, 1)]
            distance = max(float(max(wide[0].max(), wide[1].max())), 1e-9)
        return View(axes, target + axes[2] * distance, reach, size)


def _fitted(placed: Floats, reach: tuple[float, float]) -> Floats:
    """The nearest eye, in the camera's axes, that has all points in its sight.

    A point (r, u, b) is in sight of an eye (x, y, z) where |r - x| ≤ t (z - b), and so upwards:
    of each side of the picture the outermost point sets a bound that is linear in the eye.
    """
    middle, apart = [], []
    back = placed[:, 2]
    for axis in (0, 1):
        slope = reach[axis] * (1 - 2 * MARGIN)
        more = float((placed[:, axis] + slope * back).max())
        less = float((slope * back - placed[:, axis]).max())
        apart.append((more + less) / (2 * slope))
        middle.append((more - less) / 2)
    size = extent(placed)
    ahead = max(*apart, float(back.max()) + max(1e-3 * size, 1e-9))
    return np.array([middle[0], middle[1], ahead])
