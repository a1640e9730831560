"""Conversion of materials: Gazebo's material if there is one, else URDF's color or texture."""

from __future__ import annotations

from lxml import etree

from ...model.appearance import APPEARANCE, convert_color, convert_material
from ...model.block_elements import list_part_elements
from ...model.elements import Link, Material, Visual
from ...model.gazebo_colors import COLORS, PICTURED
from ...model.materials import resolve_material
from ...model.numbers import format_numbers_text
from ...model.settings import Settings, get_text
from ...source.document import Element
from .copied_elements import copy_raw_element
from .extensions import write_settings
from .translation import Translation
from .xml import Node, add, get_or_create

_OF_MATERIALS = tuple(
    row._replace(path=row.path.removeprefix("material/"))
    for row in APPEARANCE
    if row.path.startswith("material/")
)
_OF_VISUALS = tuple(row for row in APPEARANCE if not row.path.startswith("material/"))

SCRIPTS = "file://media/materials/scripts/gazebo.material"


def add_material(node: Node, t: Translation, link: Link, part: Visual) -> None:
    """Add the material of a visual, and its transparency."""
    blocks = [e for e in list_part_elements(t.robot, link) if e.tag == "material"]
    if blocks and _from_gazebo(node, t, link, part, blocks[-1]):
        return
    _report_script(t, link, part)
    own = resolve_material(t.robot, part.material)
    texture = "" if own is None else _find_texture(t, link, own)
    settings = _get_settings(t, link, part, has_texture=bool(texture))
    if settings or texture:
        write_settings(get_or_create(node, "material"), settings, _OF_MATERIALS)
    if own is not None and texture:
        _add_texture(get_or_create(node, "material"), t, link, own, texture)
    write_settings(node, settings, _OF_VISUALS)


def _get_settings(t: Translation, link: Link, part: Visual, *, has_texture: bool) -> Settings:
    """Return what the target shows of a visual: its color, or white for a texture."""
    own = resolve_material(t.robot, part.material)
    if t.robot.format == "sdf":
        return part.appearance
    if own is None or (own.color is None and not has_texture):
        return {}
    if own.color is not None and not all(0 <= value <= 1 for value in own.color):
        text = f"color {format_numbers_text(own.color)} of link '{link.name}' is not exported"
        t.report_loss("material", f"{text}; SDF takes numbers from 0 to 1", own, link)
        return {}
    shown = convert_material(own)
    return {name: value for name, value in shown.items() if name != "metalness"}


def _find_texture(t: Translation, link: Link, own: Material) -> str:
    """Return the texture of a material; empty if it has none, or its file is not exported."""
    if not own.texture or t.meshes.found.get(own.texture) is not None:
        return own.texture or ""
    why = t.meshes.refused.get(own.texture, "it is missing")
    text = f"texture '{own.texture}' of material '{own.name}' is not exported: {why}"
    t.report_loss("texture", text, own, link)
    return ""


def _report_script(t: Translation, link: Link, part: Visual) -> None:
    if part.script and t.robot.format == "sdf":  # scripts in blocks are copied
        text = f"script '{part.script}' of a visual of link '{link.name}' is not exported"
        t.report_loss("material", text, part, link)


def _add_texture(made: Node, t: Translation, link: Link, own: Material, filename: str) -> None:
    if not t.options.classic:
        metal = get_or_create(made, "pbr/metal")
        metal.insert(0, etree.Element("albedo_map"))
        metal[0].text = t.meshes.get_texture(filename)
        if metal.find("metalness") is None:
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


def _from_gazebo(node: Node, t: Translation, link: Link, part: Visual, block: Element) -> bool:
    """Add the material of a ``<gazebo>`` block; return False if the target does not know it."""
    if block.children:
        made = add(node, "material")
        for child in block.children:
            copy_raw_element(made, t, child, link)
        return True
    name = get_text(block)
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
            t.report_loss("material", f"{text}; the URDF color is kept", block, link)
        return False
    if first and name not in PICTURED and part.material is not None:
        text = f"link '{link.name}' has the color of '{name}' instead of its URDF color"
        t.report_note("material", f"{text}; gz cannot run the script of that name", block, link)
    if first and name in PICTURED:
        text = f"material '{name}' of link '{link.name}' has an image; only its color is exported"
        t.report_loss("material", text, block, link)
    settings = convert_color(part, color)
    write_settings(get_or_create(node, "material"), settings, _OF_MATERIALS)
    write_settings(node, settings, _OF_VISUALS)
    return True
