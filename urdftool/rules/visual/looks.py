"""What is seen, or not."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from ...errors import PackageNotFound
from ...model.attached import attached_links
from ...model.elements import Material, Robot
from ...source.description import Description
from ...source.packages import shown_path
from ..rule import INFO, WARNING, Problem, rule
from ..unexpanded import is_unexpanded

APPLIES_TO = ("visual", "collision")

_ON_PURPOSE = re.compile(r"transparent|invisible|virtual|dummy|hidden|none", re.IGNORECASE)


@rule(
    INFO,
    default=False,
    effects={
        "rviz": "shows nothing of the link",
        "gz, gazebo-classic, drake, pinocchio": "load the link without a visual",
        "pybullet": "shows the collision",
    },
)
def missing_visual(robot: Robot) -> Iterator[Problem]:
    """A rigid body has a collision and no visual.

    It is there and cannot be seen, except where collisions are shown. A link that only collides is
    not reported where it is fixed to one with a visual.
    """
    for link in robot.links:
        if not link.collisions or link.visuals:
            continue
        if not any(one.visuals for one, _ in attached_links(robot, link)):
            yield Problem(link, f"link '{link.name}' has a collision and no visual")


@rule(
    WARNING,
    effects={
        "rviz": "shows nothing of the link",
        "gz, gazebo-classic, pybullet": "take the alpha of 0",
    },
)
def fully_transparent(robot: Robot) -> Iterator[Problem]:
    """All that is seen of a link is transparent.

    The fourth number of a colour is its opacity, and 0 is glass that cannot be seen. Links and
    materials whose name says that it is meant (virtual, invisible, transparent) are let pass.
    """
    colors = {material.name: material for material in robot.materials if material.color}
    for link in robot.links:
        if _ON_PURPOSE.search(link.name):
            continue
        shown: list[Material] = []
        for visual in link.visuals:
            material = visual.material
            if material is not None and material.color is None:
                material = colors.get(material.name)
            if material is None or material.color is None or material.color[3] > 0:
                break
            if _ON_PURPOSE.search(material.name):
                break
            shown.append(material)
        else:
            if shown:
                color = shown[0].element.child("color") or shown[0].element
                yield Problem(
                    link,
                    f"link '{link.name}' has an opacity of 0; write 1 as the fourth number",
                    at=color.attribute_place("rgba"),
                )


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "accept it at a visual",
    },
)
def empty_material_name(robot: Robot) -> Iterator[Problem]:
    """The name of a material is empty.

    Exporters of CAD programs write ``<material name="">`` with a colour. Tools that keep materials
    by name show all of them in the first colour.
    """
    for link in robot.links:
        for visual in link.visuals:
            if visual.material is None or visual.material.name:
                continue
            element = visual.material.element
            if "name" in element.attributes:
                yield Problem(
                    link,
                    f"a material of link '{link.name}' has an empty name; give it one",
                    at=element.attribute_place("name"),
                )


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "load the same robot without it"
        ),
    },
)
def unused_material(robot: Robot) -> Iterator[Problem]:
    """A material at the top level is used by no visual.

    It does no harm; often a name was changed in one place.
    """
    used = {
        visual.material.name
        for link in robot.links
        for visual in link.visuals
        if visual.material is not None
    }
    for material in robot.materials:
        if material.name and material.name not in used:
            yield Problem(material.element, f"material '{material.name}' is used nowhere")


@rule(
    WARNING,
    effects={
        "rviz": "shows the link without the picture",
        "drake": "rejects the file",
    },
)
def missing_texture(robot: Robot, description: Description) -> Iterator[Problem]:
    """The picture of a texture is not there.

    The model is shown in grey or white, as if it had no texture.
    """
    told: set[str] = set()
    for element in robot.element.walk():
        uri = element.get("filename") or ""
        if element.tag != "texture" or not uri or uri in told or is_unexpanded(uri):
            continue
        told.add(uri)
        try:
            path = description.resolve(uri)
        except PackageNotFound:
            continue
        if not os.path.isfile(path):
            yield Problem(
                element,
                f"texture '{uri}' is not there: no file '{shown_path(path)}'",
                at=element.attribute_place("filename"),
            )
