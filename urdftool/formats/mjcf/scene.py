"""A scene: the robot above a floor with a light."""

from __future__ import annotations

import math

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Vector
from ...model.numbers import number_text
from ..common.naming import UniqueNames
from ..common.shape_box import ShapeBoxes
from ..common.standing import Ground, measure_ground
from ..written import Written
from .document import serialize
from .home import Home
from .plan import Plan
from .structure import Structure

FLUSH = 1e-3
"""Depth [m] to which a fixed robot may reach below a floor that stays at z = 0."""


def create_scene_file(plan: Plan, text: bytes, written: Written) -> bytes:
    """Create ``scene.xml``, which includes the model.

    The floor is at z = 0. If a fixed robot reaches below it, at home or with every joint at zero,
    the floor is at its lowest point, which is reported.
    """
    structure, home, boxes = plan.structure, plan.home, plan.boxes
    ground = measure_ground(structure, boxes, home.positions, home.pose)
    low = 0.0 if structure.free else _get_lowest(structure, home, boxes, ground)
    center, extent = _get_around(ground, home)
    main = written.main
    deep = etree.XMLParser(huge_tree=True)  # libxml2 limits nesting to 256 levels by default
    names = UniqueNames(
        element.get("name", "") for element in etree.fromstring(text, deep).iter("*")
    )
    plane, pattern = names.take("floor"), names.take("groundplane")
    root = etree.Element("mujoco", model=f"{plan.name} scene")
    etree.SubElement(root, "include", file=main)
    statistic = etree.SubElement(root, "statistic")
    statistic.set("center", " ".join(number_text(round(value, 2)) for value in center))
    statistic.set("extent", number_text(round(extent, 2)))
    visual = etree.SubElement(root, "visual")
    etree.SubElement(
        visual, "headlight", diffuse="0.6 0.6 0.6", ambient="0.3 0.3 0.3", specular="0 0 0"
    )
    etree.SubElement(visual, "rgba", haze="0.15 0.25 0.35 1")
    etree.SubElement(visual, "global", azimuth="120", elevation="-20")
    asset = etree.SubElement(root, "asset")
    etree.SubElement(
        asset, "texture", type="skybox", builtin="gradient", rgb1="0.3 0.5 0.7", rgb2="0 0 0",
        width="512", height="3072",
    )  # fmt: skip
    etree.SubElement(
        asset, "texture", type="2d", name=pattern, builtin="checker", mark="edge",
        rgb1="0.2 0.3 0.4", rgb2="0.1 0.2 0.3", markrgb="0.8 0.8 0.8", width="300", height="300",
    )  # fmt: skip
    etree.SubElement(
        asset, "material", name=pattern, texture=pattern, texuniform="true",
        texrepeat="5 5", reflectance="0.2",
    )  # fmt: skip
    world = etree.SubElement(root, "worldbody")
    etree.SubElement(world, "light", pos="0 0 3.5", dir="0 0 -1", type="directional")
    floor = etree.SubElement(world, "geom", name=plane, type="plane", size="0 0 0.05")
    if low < -FLUSH:
        low = math.floor(low * 1e4) / 1e4 if low > -1e9 else low
        floor.set("pos", f"0 0 {number_text(low)}")
        written.report_loss(
            "floor",
            "the robot with a fixed base reaches below the height of its root; the floor of the "
            "scene is at "
            f"z = {low:g} m",
            structure.robot.place,
            severity=Severity.INFO,
        )
    floor.set("material", pattern)
    return serialize(root)


def _get_lowest(
    structure: Structure, home: Home, boxes: ShapeBoxes, ground: Ground | None
) -> float:
    """Return the lowest point [m] of a fixed robot, at home and with every joint at zero."""
    if ground is None or not any(link.collisions for link in structure.robot.links):
        return 0.0
    start = measure_ground(structure, boxes, structure.locked, home.start)
    grounds = (ground, start) if not home.floating else (ground,)
    return min(low.low for low in grounds if low is not None)


def _get_around(ground: Ground | None, home: Home) -> tuple[Vector, float]:
    """Return the center and the size [m] of the view."""
    if ground is None:
        return home.pose.translation, 1.0
    low, high = ground.box
    a, b, c = ((x + y) / 2 for x, y in zip(low, high, strict=True))
    return (a, b, c), max(math.dist(low, high) / 2, 0.1)
