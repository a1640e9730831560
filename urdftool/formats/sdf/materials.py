"""Conversion of materials: Gazebo's material if there is one, else URDF's color or texture."""

from __future__ import annotations

from decimal import Decimal

from ...model.elements import Link, Material, Robot, Visual
from ...model.gazebo_colors import COLORS, PICTURED, Color
from ...model.settings import get_text
from ...source.document import Element
from ..common.numbers import format_numbers_text, number_text
from .extensions import block_elements
from .raw_sdf import copy_raw_element
from .translation import Translation
from .xml import Node, add

SCRIPTS = "file://media/materials/scripts/gazebo.material"


def add_material(node: Node, t: Translation, link: Link, part: Visual) -> None:
    """Add the material of a visual."""
    said = [e for e in block_elements(t.robot, link) if e.tag == "material"]
    if said and _from_gazebo(node, t, link, part, said[-1]):
        return
    own = resolve_material(t.robot, part.material)
    if own is None:
        return
    color = own.color
    there = bool(own.texture) and t.meshes.found.get(own.texture or "") is not None
    if own.texture and not there:
        why = t.meshes.refused.get(own.texture, "it is missing")
        text = f"texture '{own.texture}' of material '{own.name}' is not exported: {why}"
        t.report_loss("texture", text, own, link)
    if color is None and not there:
        return
    rgba = color or (1.0, 1.0, 1.0, 1.0)
    made = add(node, "material")
    add(made, "ambient", format_numbers_text(rgba))
    add(made, "diffuse", format_numbers_text(rgba))
    if rgba[3] < 1.0:
        _set_transparency(node, rgba[3])
    if own.texture and there:
        _add_texture(made, t, link, own, own.texture)


def resolve_material(robot: Robot, own: Material | None) -> Material | None:
    """Return the material of a visual: its own if it has a color or texture, else by name."""
    if own is None or own.color is not None or own.texture is not None:
        return own
    for other in (*robot.materials, *(v.material for link in robot.links for v in link.visuals)):
        if other is not None and other.name == own.name and (other.color or other.texture):
            return other
    return None


def _add_texture(made: Node, t: Translation, link: Link, own: Material, filename: str) -> None:
    if not t.options.classic:
        metal = add(add(made, "pbr"), "metal")
        add(metal, "albedo_map", t.meshes.get_texture(filename))
        add(metal, "metalness", "0")
        return
    found = t.meshes.get_script(filename)
    if found is None:
        text = f"texture '{filename}' requires an Ogre script next to the model; it is not exported"
        hint = "write a folder, or give --uri model"
        t.report_loss("texture", text, own, link, hint=hint)
        return
    name, folders = found
    script = add(made, "script")
    for folder in folders:
        add(script, "uri", folder)
    add(script, "name", name)


def _from_gazebo(node: Node, t: Translation, link: Link, part: Visual, said: Element) -> bool:
    """Add the material of a ``<gazebo>`` block; return False if the target does not know it."""
    if said.children:
        made = add(node, "material")
        for child in said.children:
            copy_raw_element(made, t, child, link)
        return True
    name = get_text(said)
    if not name:
        return False
    if t.options.classic:
        script = add(add(node, "material"), "script")
        add(script, "uri", SCRIPTS)
        add(script, "name", name)
        return True
    color = COLORS.get(name)
    first = link.visuals[0] is part  # report once for each link
    if color is None:
        if first:
            text = f"material '{name}' of link '{link.name}' is a script, which gz cannot run"
            t.report_loss("material", f"{text}; the URDF color is kept", said, link)
        return False
    if first and name not in PICTURED and part.material is not None:
        text = f"link '{link.name}' has the color of '{name}' instead of its URDF color"
        t.report_note("material", f"{text}; gz cannot run the script of that name", said, link)
    if first and name in PICTURED:
        text = f"material '{name}' of link '{link.name}' has an image; only its color is exported"
        t.report_loss("material", text, said, link)
    _add_colored(node, color)
    return True


def _add_colored(node: Node, color: Color) -> None:
    made = add(node, "material")
    for tag in ("ambient", "diffuse", "specular"):
        add(made, tag, format_numbers_text((*getattr(color, tag), color.alpha)))
    if any(color.emissive):
        add(made, "emissive", format_numbers_text((*color.emissive, 1.0)))
    if color.alpha < 1.0:
        _set_transparency(node, color.alpha)


def _set_transparency(node: Node, alpha: float) -> None:
    """Set the complement of alpha, in decimal to avoid binary rounding digits."""
    add(node, "transparency", number_text(float(Decimal(1) - Decimal(repr(alpha)))))
