"""Find missing visual geometry, transparent materials and missing textures."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...errors import AccessError, PackageNotFound
from ...model.attached import find_attached_links
from ...model.elements import Material, Robot
from ...source.description import Description
from ...source.packages import shorten_path
from ..fix import (
    FixContext,
    Proposal,
    find_attribute,
    is_computed,
    remove_element,
    safe,
    set_attribute,
    unsafe,
)
from ..rule import BOTH, INFO, UNSAFE, WARNING, Problem, rule
from ..shape_changes import copy_shape
from ..unexpanded import is_unexpanded

APPLIES_TO = ("visual", "collision")

_ON_PURPOSE = re.compile(
    r"transparent|invisible|virtual|dummy|fake|marker|hidden|none", re.IGNORECASE
)


@rule(
    INFO,
    default=False,
    effects={
        "rviz": "shows nothing of the link",
        "gz, gazebo-classic, drake, pinocchio": "load the link without a visual",
        "pybullet": "shows the collision geometry",
    },
)
def missing_visual(robot: Robot) -> Iterator[Problem]:
    """A rigid body has collision geometry but no visual geometry.

    The body is invisible, except in tools that show collision geometry. A link with only a
    collision is not reported if it is fixed to one with a visual. Add a ``<visual>``.
    """
    for link in robot.links:
        if not link.collisions or link.visuals:
            continue
        if not any(one.visuals for one, _ in find_attached_links(robot, link)):
            yield Problem(link, f"link '{link.name}' has a collision but no visual; add a <visual>")


@missing_visual.fix(UNSAFE)
def copy_collisions(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the collisions."""
    changes = [copy_shape(shape, "visual") for shape in context.get_link(problem).collisions]
    if None in changes:
        return None
    return unsafe("copy its collisions as visuals", *filter(None, changes))


@rule(
    WARNING,
    effects={
        "rviz": "shows nothing of the link",
        "gz, gazebo-classic, pybullet": "use the alpha of 0",
    },
)
def fully_transparent(robot: Robot) -> Iterator[Problem]:
    """All visual geometry of a link is transparent.

    The fourth number of ``rgba`` is the opacity (alpha); geometry with 0 is invisible. Write 1 for
    opaque. Links and materials whose name shows that it is intended (virtual, dummy, fake, marker,
    invisible, transparent) are ignored.
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
                color = shown[0].element.find_child("color") or shown[0].element
                yield Problem(
                    link,
                    f"visual of link '{link.name}' is invisible (opacity 0); write 1 as the fourth "
                    "number of rgba",
                    at=color.locate_attribute("rgba"),
                )


@fully_transparent.fix(UNSAFE)
def make_opaque(problem: Problem, context: FixContext) -> Proposal | None:
    """Write 1 as the opacity."""
    found = find_attribute(problem, context.robot.element)
    values = (found[0].get(found[1]) or "").split() if found is not None else []
    if found is None or len(values) != 4:
        return None
    text = " ".join([*values[:3], "1"])
    return unsafe(f'write rgba="{text}"', set_attribute(*found, text))


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "accept it at a visual",
    },
)
def empty_material_name(robot: Robot) -> Iterator[Problem]:
    """The name of a material is empty.

    Exporters of CAD programs write ``<material name="">`` with a color. Tools that store materials
    by name show all of them in one color: PyBullet 3.2.7 in the last. Write a name.
    """
    for link in robot.links:
        for visual in link.visuals:
            if visual.material is None or visual.material.name:
                continue
            element = visual.material.element
            if "name" in element.attributes:
                yield Problem(
                    link,
                    f"a material of link '{link.name}' has an empty name; write a unique name",
                    at=element.locate_attribute("name"),
                )


@empty_material_name.fix(UNSAFE)
def name_by_color(problem: Problem, context: FixContext) -> Proposal | None:
    """Name the materials of the link by their colors.

    urdfdom drops the shapes after a material without a ``name``, so the fix restores them.
    """
    found = find_attribute(problem)
    link = context.get_link(problem)
    if found is None and not any(v.material and not v.material.name for v in link.visuals):
        return None
    changes = []
    for visual in link.visuals:
        material = visual.material
        if material is None or material.name or (found and material.element is not found[0]):
            continue
        if material.color is None or any(not 0 <= part <= 1 for part in material.color):
            return None
        if is_computed(material.element.find_child("color") or material.element, "rgba"):
            return None
        name = "rgba_" + "".join(f"{round(part * 255):02x}" for part in material.color)
        known = {m.name: m.color for m in context.robot.materials}
        if known.get(name, material.color) != material.color:
            return None
        changes.append(set_attribute(material.element, "name", name))
    return unsafe("name it after its color", *changes) if changes else None


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
    """No visual uses a material that is defined at the top level.

    It has no effect; often a name was changed in only one place.
    """
    used = {
        visual.material.name
        for link in robot.links
        for visual in link.visuals
        if visual.material is not None
    }
    for material in robot.materials:
        if material.name and material.name not in used:
            yield Problem(material.element, f"no visual uses material '{material.name}'; remove it")


@unused_material.fix(BOTH)
def remove_material(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove it; unsafe in xacro, because another robot or other arguments may use it."""
    make = safe if context.description.expansion is None else unsafe
    return make("remove the material", remove_element(problem.element))


@rule(
    WARNING,
    effects={
        "rviz": "shows the link without the texture",
        "drake": "rejects the file",
    },
)
def missing_texture(robot: Robot, description: Description) -> Iterator[Problem]:
    """The image file of a texture does not exist.

    RViz shows the model without the texture, Drake rejects the file.
    """
    seen: set[str] = set()
    for element in description.document.elements_by_tag.get("texture", ()):
        uri = element.get("filename") or ""
        if not uri or uri in seen or is_unexpanded(uri):
            continue
        seen.add(uri)
        try:
            path = description.resolve(uri)
        except PackageNotFound:
            continue
        except AccessError as error:
            yield Problem(
                element,
                f"texture '{uri}' is not read: {error.message}",
                at=element.locate_attribute("filename"),
                data={"uri": uri, "refusal": error.message},
                effects=[],
            )
            continue
        if not description.workspace.is_file(path):
            yield Problem(
                element,
                f"texture '{uri}' does not exist: no file '{shorten_path(path)}'",
                at=element.locate_attribute("filename"),
                data={"uri": uri},
            )
