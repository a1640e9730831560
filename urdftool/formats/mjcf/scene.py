"""A scene: the robot above a floor under a light."""

from __future__ import annotations

import math

import numpy as np
from lxml import etree

from ..numbers import number_text
from .document import serialise
from .extent import shape_points
from .structure import Structure


def scene_file(structure: Structure, model: str, main: str) -> bytes:
    """``scene.xml``, which includes the model.

    The floor lies under the lowest point that collides with every joint at zero, at most at the
    height of the root.
    """
    low, center, extent = _reach(structure)
    root = etree.Element("mujoco", model=f"{model} scene")
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
        asset, "texture", type="2d", name="groundplane", builtin="checker", mark="edge",
        rgb1="0.2 0.3 0.4", rgb2="0.1 0.2 0.3", markrgb="0.8 0.8 0.8", width="300", height="300",
    )  # fmt: skip
    etree.SubElement(
        asset, "material", name="groundplane", texture="groundplane", texuniform="true",
        texrepeat="5 5", reflectance="0.2",
    )  # fmt: skip
    world = etree.SubElement(root, "worldbody")
    etree.SubElement(world, "light", pos="0 0 3.5", dir="0 0 -1", type="directional")
    floor = etree.SubElement(world, "geom", name="floor", type="plane", size="0 0 0.05")
    if low < -1e-6:
        floor.set("pos", f"0 0 {number_text(math.floor(low * 1e4) / 1e4)}")
    floor.set("material", "groundplane")
    return serialise(root)


def _reach(structure: Structure) -> tuple[float, tuple[float, float, float], float]:
    """Lowest colliding point [m], and the middle and size [m] of all there is, at zero."""
    low = 0.0
    corners = []
    for link in structure.robot.links:
        pose = structure.pose_at_zero(link.name)
        turn, shift = np.array(pose.rotation), np.array(pose.translation)
        corners.append(shift[None, :])
        for shape in link.collisions or link.visuals:
            points = shape_points(structure.robot, shape)
            if points is None:
                continue
            placed = points @ turn.T + shift
            corners += [placed.min(axis=0)[None, :], placed.max(axis=0)[None, :]]
            if link.collisions:
                low = min(low, float(placed[:, 2].min()))
    points = np.concatenate(corners)
    least, most = points.min(axis=0), points.max(axis=0)
    middle = (least + most) / 2
    extent = max(float(np.linalg.norm(most - least)) / 2, 0.1)
    return low, (float(middle[0]), float(middle[1]), float(middle[2])), extent
