"""Check materials and the references to them."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Material, Robot
from ...model.read import parse_numbers
from ...model.remarks import describe_undefined
from ...suggestions import find_nearest, suggest_name
from ..fix import (
    FixContext,
    Proposal,
    are_equal_elements,
    find_attribute,
    remove_element,
    safe,
    set_attribute,
    unsafe,
)
from ..rule import BOTH, ERROR, UNSAFE, WARNING, Problem, rule, select_holding
from ..xml.vocabulary_table import find_misspelled_attributes

APPLIES_TO = ("material",)

_Appearance = tuple[tuple[float, ...] | None, str | None]


@rule(
    WARNING,
    effects={
        "urdfdom": "warns; the visual has no color",
        "rviz": "shows the link in red, unless its mesh has its own colors",
        "pybullet": "uses a default color",
        "mujoco": "accepts it without a message",
        "drake": "rejects the file",
    },
)
def undefined_material(robot: Robot) -> Iterator[Problem]:
    """A visual uses a material that is not defined.

    A ``<material>`` with only a name refers to one that is defined with a color or texture at the
    top level or in another visual. If there is none, readers show the visual in a default color or
    reject the file. Usually the file with the colors is not included.
    """
    uses: dict[str, list[Material]] = {}
    defined = {material.name for material in robot.materials if _defines(material)}
    for link in robot.links:
        for visual in link.visuals:
            material = visual.material
            if material is None or not material.name:
                continue
            if _defines(material):
                defined.add(material.name)
            else:
                uses.setdefault(material.name, []).append(material)
    for name, materials in uses.items():
        if name not in defined:
            times = f" ({len(materials)} visuals use it)" if len(materials) > 1 else ""
            first = materials[0]
            yield Problem(
                first.element,
                f"{describe_undefined(name)}{times}"
                + (suggest_name(name, defined) or "; add a <color>"),
                at=first.locate_attribute("name"),
                data={"material": name, "suggestion": find_nearest(name, defined)},
            )


_NAMELESS = {
    "urdfdom, gz, gazebo-classic, pinocchio (at the top level)": (
        "drop it, with an error in the log"
    ),
    "urdfdom, gz, gazebo-classic, pinocchio (in a visual)": (
        "load the link without its visuals and collisions, with an error in the log"
    ),
    "pybullet (in a visual)": "rejects the robot",
    "drake (at the top level)": "rejects the robot",
    "drake (in a visual)": "accepts it",
    "mujoco (at the top level)": "accepts it",
    "mujoco (in a visual, with a color)": "accepts it",
    "mujoco (in a visual, without a color)": "rejects the file: required attribute missing",
}


@rule(
    ERROR,
    effects=_NAMELESS,
)
def nameless_material(robot: Robot) -> Iterator[Problem]:
    """A ``<material>`` has no attribute ``name``.

    At the top level nothing can refer to it. In a visual, urdfdom stops reading the link at this
    element and drops the visual and all collisions of the link, while ``check_urdf`` reports
    success. ``name=""`` is accepted.
    """
    for material in robot.materials:
        if _is_nameless(material):
            yield Problem(
                material.element,
                'a <material> at the top level has no name; write name="…"',
                effects=select_holding(_NAMELESS, "at the top level"),
            )
    for link in robot.links:
        materials = [visual.material for visual in link.visuals if visual.material is not None]
        nameless = [material for material in materials if _is_nameless(material)]
        if nameless:
            what = "a <material>" if len(nameless) == 1 else f"{len(nameless)} <material>s"
            have = "has" if len(nameless) == 1 else "have"
            colored = all(one.element.find_child("color") for one in nameless)
            color = "with a color" if colored else "without a color"
            yield Problem(
                link,
                f"{what} of link '{link.name}' {have} no name, so urdfdom drops the "
                'visuals and the collisions of the link; write name="…"',
                at=nameless[0].element,
                effects=select_holding(_NAMELESS, "in a visual", color),
            )


def _is_nameless(material: Material) -> bool:
    element = material.element
    return "name" not in element.attributes and not find_misspelled_attributes(element)


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio (top level)": (
            "reject the robot: material is not unique"
        ),
        "urdfdom (visual)": "uses the color of the top level",
        "urdfdom (visuals)": "uses the color of the first visual for all of them",
        "drake": "rejects the file",
        "pybullet (top level)": "accepts it",
        "pybullet (visual)": "uses the color of the visual",
        "pybullet (visuals)": "uses the color of the last visual for all of them",
    },
)
def conflicting_material(robot: Robot) -> Iterator[Problem]:
    """Two materials have the same name.

    At the top level urdfdom rejects the robot, even if both are equal; it happens if a file with
    colors is included twice. If visuals define different colors for one name, some readers use the
    first and others the last color; that is a warning.
    """
    first: dict[str, Material] = {}
    for material in robot.materials:
        other = first.setdefault(material.name, material)
        if other is not material and material.name:
            yield Problem(
                material.element,
                f"material '{material.name}' is defined twice at the top level "
                f"(first in line {other.place.line}{_describe_file(other, material)}); remove one",
                at=material.locate_attribute("name"),
                effects=(
                    "urdfdom, gz, gazebo-classic, pinocchio (top level)",
                    "drake",
                    "pybullet (top level)",
                ),
            )
    seen: set[tuple[str, _Appearance]] = set()
    at_top = set(first)
    for link in robot.links:
        for visual in link.visuals:
            material_ = visual.material
            if material_ is None or not material_.name or not _defines(material_):
                continue
            other = first.setdefault(material_.name, material_)
            look = _get_appearance(material_)
            if look == _get_appearance(other) or (material_.name, look) in seen:
                continue
            seen.add((material_.name, look))
            case = "visual" if material_.name in at_top else "visuals"
            effects = [f"urdfdom ({case})", "drake", f"pybullet ({case})"]
            what, there = "color", "that"
            if material_.color is None or other.color is None:
                # PyBullet takes the color of the other
                what = "texture" if material_.color is None else "color"
                there = "the color" if other.color is not None else "the texture"
                effects = ["urdfdom (visual)", "drake"] if case == "visual" else ["drake"]
            where = f"line {other.place.line}{_describe_file(other, material_)}"
            yield Problem(
                link,
                f"{what} of material '{material_.name}' differs from {there} in {where}; write a "
                "unique name",
                at=material_.locate_attribute("name"),
                severity=WARNING,
                effects=effects,
            )


def _describe_file(other: Material, material: Material) -> str:
    same = other.place.path == material.place.path
    return "" if same else f" of {other.place.path}"


def _defines(material: Material) -> bool:
    return any(child.tag in ("color", "texture") for child in material.element.children)


def _get_appearance(material: Material) -> _Appearance:
    color = material.color
    return (None if color is None else tuple(round(c, 4) for c in color)), material.texture


@conflicting_material.fix(BOTH)
def remove_equal_material(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the second of two equal materials.

    It is unsafe in xacro, because another robot or other arguments may have only the second.
    """
    element = problem.element
    if element.tag != "material" or element.parent is not context.robot.element:
        return None
    name = element.get("name")
    firsts = [m.element for m in context.robot.materials if m.name == name]
    if firsts[0] is element or not are_equal_elements(firsts[0], element):
        return None
    if (firsts[0].file.path, firsts[0].start) == (element.file.path, element.start):
        return None  # one element that is included twice
    make = safe if context.description.expansion is None else unsafe
    return make("remove it; the first one is equal", remove_element(element))


@rule(
    ERROR,
    effects={
        "urdfdom": "drops the color, with an error in the log",
        "gz, gazebo-classic": "show the link in black (sdformat 12.3)",
        "mujoco, pybullet": "take it as written",
        "drake": "rejects the file",
    },
)
def invalid_color(robot: Robot) -> Iterator[Problem]:
    """A color has a component outside 0 to 1.

    ``rgba`` is red, green, blue and opacity, each from 0 to 1. urdfdom rejects components from 0
    to 255 as malformed and drops the material; other readers show a very bright color.
    """
    for material in _get_materials(robot):
        color = material.element.find_child("color")
        text = None if color is None else color.get("rgba")
        if color is None or text is None:
            continue
        wrong, right = _check_color(text)
        if wrong:
            of = f" of material '{material.name}'" if material.name else ""
            yield Problem(
                material.element,
                f"color '{text}'{of} {wrong}",
                at=color.locate_attribute("rgba"),
                data={"write": right},
            )


def _get_materials(robot: Robot) -> Iterator[Material]:
    yield from robot.materials
    for link in robot.links:
        for visual in link.visuals:
            if visual.material is not None:
                yield visual.material


def _check_color(text: str) -> tuple[str, str]:
    """Return what is wrong with an ``rgba``, and what to write; both empty if it is valid."""
    values = parse_numbers(text, 4)
    if values is None:
        return "", ""  # other rules report values that are not four numbers
    if max(values) > 1 and all(value == int(value) and 0 <= value <= 255 for value in values):
        opacity = 1.0 if values[3] <= 1 and values[3] else values[3] / 255
        scaled = (*(value / 255 for value in values[:3]), opacity)
        shown = " ".join(f"{value:.3g}" for value in scaled)
        right = " ".join(f"{value:.4g}" for value in scaled)
        return f"is on a scale of 0 to 255; write '{shown}'", right
    if max(values) > 1 or min(values) < 0:
        right = " ".join(f"{min(1.0, max(0.0, value)):.6g}" for value in values)
        return f"has a component outside 0 to 1; write '{right}'", right
    return "", ""


@invalid_color.fix(UNSAFE)
def write_valid_color(problem: Problem, context: FixContext) -> Proposal | None:
    """Scale the components to 0 to 1, or write the nearest values in that range."""
    found = find_attribute(problem)
    if found is None:
        return None
    text = problem.data["write"]
    return unsafe(f'write rgba="{text}"', set_attribute(*found, text))
