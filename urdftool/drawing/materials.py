"""Resolution of a visual's ``<material>`` to a color or image."""

from __future__ import annotations

from ..model.elements import Material, Robot, Visual

Rgba = tuple[float, float, float, float]

PLAIN: Rgba = (0.76, 0.78, 0.80, 1.0)
"""Color of visuals without a color."""


TINTS: tuple[Rgba, ...] = (
    PLAIN,
    (0.60, 0.69, 0.80, 1.0),
    (0.82, 0.73, 0.60, 1.0),
    (0.64, 0.76, 0.66, 1.0),
    (0.80, 0.65, 0.63, 1.0),
    (0.70, 0.66, 0.80, 1.0),
)
"""Colors that distinguish the links of a robot that defines no colors."""


class Materials:
    """Materials of a robot, by name."""

    def __init__(self, robot: Robot) -> None:
        """Index the definitions; the first definition of a name counts, on any level.

        urdfdom, from which RViz reads materials, does the same.
        """
        self._defined: dict[str, Material] = {}
        for material in (
            *robot.materials,
            *(visual.material for link in robot.links for visual in link.visuals),
        ):
            if material is not None and material.name and (material.color or material.texture):
                self._defined.setdefault(material.name, material)
        shown = [link for link in robot.links if link.visuals]
        plain = not any(self.find_material(visual) for link in shown for visual in link.visuals)
        self._tints = {
            id(visual): TINTS[number % len(TINTS)]
            for number, link in enumerate(shown if plain and len(shown) > 1 else [])
            for visual in link.visuals
        }

    def tint(self, visual: Visual) -> Rgba:
        """Return a color for a visual without one: by link if the robot defines no colors."""
        return self._tints.get(id(visual), PLAIN)

    def find_material(self, visual: Visual) -> Material | None:
        """Return the material with the color or image of a visual; None if it has neither."""
        material = visual.material
        if material is None:
            return None
        found = self._defined.get(material.name, material)
        return found if found.color or found.texture else None


def clamp_color(rgba: Rgba) -> Rgba:
    """Clamp the components of a color to 0 … 1; NaN becomes 1."""
    red, green, blue, alpha = (min(max(part, 0.0), 1.0) if part == part else 1.0 for part in rgba)
    return red, green, blue, alpha
