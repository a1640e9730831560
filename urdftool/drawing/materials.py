"""Which colour or image a visual's ``<material>`` means."""

from __future__ import annotations

from ..model.elements import Material, Robot, Visual

Rgba = tuple[float, float, float, float]

PLAIN: Rgba = (0.76, 0.78, 0.80, 1.0)
"""What has no colour of its own."""


class Materials:
    """The materials of a robot, by name."""

    def __init__(self, robot: Robot) -> None:
        """Index the definitions: of one name the first counts, wherever it stands.

        So does urdfdom, from which RViz has its materials.
        """
        self._defined: dict[str, Material] = {}
        for material in (
            *robot.materials,
            *(visual.material for link in robot.links for visual in link.visuals),
        ):
            if material is not None and material.name and (material.color or material.texture):
                self._defined.setdefault(material.name, material)

    def of(self, visual: Visual) -> Material | None:
        """The material with the colour or image of a visual; None where it has neither."""
        material = visual.material
        if material is None:
            return None
        found = self._defined.get(material.name, material)
        return found if found.color or found.texture else None


def clean(rgba: Rgba) -> Rgba:
    """A colour whose parts are in 0 … 1, and white where one is no number."""
    red, green, blue, alpha = (min(max(part, 0.0), 1.0) if part == part else 1.0 for part in rgba)
    return red, green, blue, alpha


def from_linear(rgba: Rgba) -> Rgba:
    """A colour of linear light as a screen has it; its opacity as it is."""
    red, green, blue, alpha = clean(rgba)
    return red ** (1 / 2.2), green ** (1 / 2.2), blue ** (1 / 2.2), alpha
