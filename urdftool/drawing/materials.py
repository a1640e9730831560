"""Colors of visuals that have none."""

from __future__ import annotations

from ..model.elements import Robot, Visual
from ..model.materials import resolve_material

Rgba = tuple[float, float, float, float]

PLAIN: Rgba = (0.76, 0.78, 0.80, 1.0)
"""Color of visuals without a color. Chosen, no source."""


TINTS: tuple[Rgba, ...] = (
    PLAIN,
    (0.60, 0.69, 0.80, 1.0),
    (0.82, 0.73, 0.60, 1.0),
    (0.64, 0.76, 0.66, 1.0),
    (0.80, 0.65, 0.63, 1.0),
    (0.70, 0.66, 0.80, 1.0),
)
"""Colors that distinguish the links of a robot that defines no colors."""


class Tints:
    """Colors of visuals without one: by link if the robot defines no colors."""

    def __init__(self, robot: Robot) -> None:
        """Choose a tint for each link with visuals."""
        shown = [link for link in robot.links if link.visuals]
        visuals = [visual for link in shown for visual in link.visuals]
        plain = not any(resolve_material(robot, visual.material) for visual in visuals)
        self._tints = {
            id(visual): TINTS[number % len(TINTS)]
            for number, link in enumerate(shown if plain and len(shown) > 1 else [])
            for visual in link.visuals
        }

    def get_tint(self, visual: Visual) -> Rgba:
        """Return the color of a visual without one."""
        return self._tints.get(id(visual), PLAIN)


def clamp_color(rgba: Rgba) -> Rgba:
    """Clamp the components of a color to 0 … 1; NaN becomes 1."""
    red, green, blue, alpha = (min(max(part, 0.0), 1.0) if part == part else 1.0 for part in rgba)
    return red, green, blue, alpha
