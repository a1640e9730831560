"""The color or image of a visual: of its material, of one of that name, of Gazebo's blocks."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal

from .elements import Link, Material, Robot, Visual
from .gazebo_colors import COLORS
from .settings import get_number

UNCOLORED = {"mjcf": (0.5, 0.5, 0.5, 1.0)}
"""What a reader finds as color of a visual without one, by format; MuJoCo's XML reference."""


class Materials:
    """The materials of a robot's visuals, by name.

    The first definition of a name counts, on any level, as in urdfdom, by which RViz and Gazebo
    read a URDF.
    """

    def __init__(self, robot: Robot) -> None:
        """Index the definitions: materials with a name, and a color or an image."""
        visuals = (visual.material for link in robot.links for visual in link.visuals)
        self._defined: dict[str, Material] = {}
        for material in (*robot.materials, *visuals):
            if material is not None and material.name and (material.color or material.texture):
                self._defined.setdefault(material.name, material)
        self._is_urdf = robot.format == "urdf"

    def find_defined(self, own: Material | None) -> Material | None:
        """Return the definition of a visual's material; None if it has no color and no image."""
        if own is None or not own.name:
            return own if own is not None and (own.color or own.texture) else None
        if not self._is_urdf and (own.color or own.texture):
            return own
        return self._defined.get(own.name)


def resolve_material(robot: Robot, own: Material | None) -> Material | None:
    """Return the material with the color or image of a visual; None if it has neither."""
    return robot.memo.get("materials", lambda: Materials(robot)).find_defined(own)


def resolve_materials(robot: Robot) -> Robot:
    """Return a robot whose visuals hold the color and image that their material's name defines."""

    def define(visual: Visual) -> Visual:
        own, defined = visual.material, resolve_material(robot, visual.material)
        if own is None or defined is None or defined is own:
            return visual
        own = replace(own, color=defined.color, texture=defined.texture)
        return replace(visual, material=own)

    links = [replace(link, visuals=[define(v) for v in link.visuals]) for link in robot.links]
    return replace(robot, links=links)


def find_shown_material(robot: Robot, link: Link, visual: Visual) -> Material | None:
    """Return the color or image of a visual: of its material, as in RViz, else of Gazebo."""
    found = resolve_material(robot, visual.material)
    return find_gazebo_material(link, visual) if found is None else found


def find_gazebo_material(link: Link, visual: Visual) -> Material | None:
    """Return the color that blocks of a URDF give a visual in Gazebo; None without one."""
    named, shown = COLORS.get(link.gazebo_material), visual.appearance
    rgb = shown["diffuse"].content if "diffuse" in shown else named and named.diffuse
    if not isinstance(rgb, tuple):
        return None
    alpha = 1.0 if named is None else named.alpha
    transparency = get_number(shown, "transparency")
    if transparency is not None:
        alpha = compute_complement(transparency)
    return Material(visual.provenance, color=(rgb[0], rgb[1], rgb[2], alpha))


def compute_complement(share: float) -> float:
    """Return the transparency of an alpha or the reverse, without binary rounding digits."""
    return float(Decimal(1) - Decimal(repr(share)))
