"""Light, ground and viewpoint, cheap enough for browsers without a graphics card."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..model.elements import Vector

if TYPE_CHECKING:
    import viser

VIEW = math.radians(40.0)
"""Vertical field of view [rad]."""

SHEET = 0.55
"""Part of a phone's height, from below, that the controls cover. Chosen, no source."""

AZIMUTH, ELEVATION = math.radians(-40.0), math.radians(22.0)

CELLS = 6
"""Number of ground cells from the center to the edge. Chosen, no source."""

LINE, MIDDLE = (205, 209, 214), (150, 155, 162)
"""Colors of the lines on the ground, and of those through its center. Chosen, no source."""


def add_lights(scene: viser.SceneApi) -> None:
    """Add one light from above the viewer's left, and a bright sky over a darker ground.

    viser's image-based light takes five times as long to render on a CPU.
    """
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=False)
    scene.add_light_hemisphere(
        "/light/sky", sky_color=(255, 255, 255), ground_color=(150, 150, 155), intensity=2.0
    )
    scene.add_light_directional(
        "/light/sun", color=(255, 255, 255), intensity=2.0, position=(2.0, -4.0, 6.0)
    )


def compute_viewpoint(
    low: Vector, high: Vector, aspect: float = 1.6, covered: float = 0.0
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Compute a viewpoint that shows a bounding box.

    Args:
        low: Lower corner [m].
        high: Upper corner [m].
        aspect: Width over height of the window.
        covered: Part of its height, from below, that the controls cover.

    Returns:
        Position of the camera and the point it looks at [m].
    """
    ca, sa = math.cos(AZIMUTH), math.sin(AZIMUTH)
    ce, se = math.cos(ELEVATION), math.sin(ELEVATION)
    towards, up = np.array([ce * ca, ce * sa, se]), np.array([-se * ca, -se * sa, ce])
    radius = max(float(np.linalg.norm(np.subtract(high, low))) / 2, 1e-6)
    reach = math.tan(VIEW / 2)
    away = 1.08 * radius / math.sin(math.atan(reach * min(aspect, 1.0 - covered)))
    middle = np.add(low, high) / 2 - up * (covered * reach * away)
    return middle + towards * away, middle


def lay_ground(scene: viser.SceneApi, size: float, height: float, shown: bool) -> float:
    """Draw a grid around the origin, in cells of 1, 2 or 5 times a power of ten.

    Returns:
        Width of a cell [m].
    """
    cell = choose_cell(size)
    ticks = np.arange(-CELLS, CELLS + 1) * cell
    edge = CELLS * cell
    lines = [[[x, -edge, 0.0], [x, edge, 0.0]] for x in ticks]
    lines += [[[-edge, y, 0.0], [edge, y, 0.0]] for y in ticks]
    points = np.array(lines)
    colors = np.full(points.shape, LINE, dtype=np.uint8)
    colors[[CELLS, 3 * CELLS + 1]] = MIDDLE
    scene.add_line_segments(
        "/ground", points, colors, thickness=1.0, thickness_units="screen",
        position=(0.0, 0.0, height), visible=shown,
    )  # fmt: skip
    return cell


def choose_cell(size: float) -> float:
    """Return a round number between a seventh and a third of a robot's size [m]."""
    largest = max(size, 1e-6) / 3
    power = 10.0 ** math.floor(math.log10(largest))
    return float(power * max(step for step in (1, 2, 5) if step * power <= largest * 1.0000001))
