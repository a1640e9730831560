"""Comparison of collision masks, contact surfaces and visual materials."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ....compare.check import Check
from ....errors import UrdftoolError
from ....model.elements import Collision, Link, Material, Visual
from ....model.gazebo_colors import COLORS
from ....model.settings import OF_LINKS, get_text
from ....source.document import Element
from .blocks import get_expected_surface, get_settings_facts, list_elements
from .excuses import BLOCKS
from .facts import EXACT, Facts, compare_facts, get_facts, get_value
from .mechanism import Shape
from .shapes import get_matched

if TYPE_CHECKING:
    from .compare import Pair

MASKS = (
    "surface/contact/collide_bitmask",
    "surface/contact/category_bitmask",
    "surface/contact/collide_without_contact",
    "surface/contact/collide_without_contact_bitmask",
)
IMAGES = ("material/pbr/metal/albedo_map", "material/script/name", "material/script/uri")
"""Paths of files, which the row of colors compares by content."""


def compare_contact(pair: Pair) -> Check:
    """Compare collision masks and self-collision flags."""
    check = Check("contact", "masks of collisions, self_collide of links and model", 0.0)
    for source, made in get_matched(pair, "collisions"):
        link = pair.robot.link[source.link]
        expected, found = _get_expected(pair, link, source), _make_collision_facts(made)
        about = f"collision '{made.part.get('name')}' of '{source.link}'"
        known = pair.excuses.declared.has_for(BLOCKS, source.link)
        compare_facts(
            check, about, _make_only(found, MASKS), _make_only(expected, MASKS), known=known
        )
    for link, element in list_own_links(pair):
        flags = get_settings_facts(link.settings, [r for r in OF_LINKS if r.name == "self_collide"])
        found = _make_only(get_facts(element), ("self_collide",))
        known = pair.excuses.declared.has_for(BLOCKS, link.name)
        compare_facts(check, f"link '{link.name}'", found, flags, known=known)
    return check


def compare_surface(pair: Pair) -> Check:
    """Compare friction, stiffness and other contact properties of collisions."""
    what = "friction, stiffness, damping, bounce, number of contacts"
    check = Check("surface", what, EXACT)
    for source, made in get_matched(pair, "collisions"):
        link = pair.robot.link[source.link]
        expected = _get_expected(pair, link, source)
        about = f"collision '{made.part.get('name')}' of '{source.link}'"
        known = pair.excuses.declared.has_for(BLOCKS, source.link)
        found = _make_without(_make_collision_facts(made), MASKS)
        compare_facts(check, about, found, _make_without(expected, MASKS), known=known)
    return check


def compare_looks(pair: Pair) -> Check:
    """Compare material colors, transparency and other properties of visuals."""
    check = Check("looks", "ambient, diffuse, specular, emissive, transparency", EXACT)
    for source, made in get_matched(pair, "visuals"):
        link = pair.robot.link[source.link]
        about = f"visual '{made.part.get('name')}' of '{source.link}'"
        known = (
            pair.excuses.declared.has_for(BLOCKS, source.link) or source.link in pair.excuses.colors
        )
        found = get_facts(made.part, without=("geometry", "pose"))
        expected = _look(pair, link, source)
        compare_facts(
            check, about, _make_without(found, IMAGES), _make_without(expected, IMAGES), known=known
        )
    return check


def list_own_links(pair: Pair) -> Iterator[tuple[Link, ET.Element]]:
    """Yield the links that are still links in the file, with their elements."""
    elements = {e.get("name"): e for e in pair.where.model.findall("link")}
    for link in pair.robot.links:
        element = elements.get(pair.link(link.name))
        if element is not None:
            yield link, element


def _get_expected(pair: Pair, link: Link, shape: Shape) -> Facts:
    assert isinstance(shape.part, Collision)
    return get_expected_surface(pair.robot, link, shape.part)


def _make_collision_facts(made: Shape) -> Facts:
    return get_facts(made.part, without=("geometry", "pose"))


def _look(pair: Pair, link: Link, shape: Shape) -> Facts:
    """Return the expected properties of a visual, other than its shape."""
    facts: Facts = {}
    blocks = [e for e in list_elements(pair.robot, link) if e.tag == "material"]
    facts.update(_get_material(pair, blocks[-1:], shape))
    for element in list_elements(pair.robot, link):
        if element.tag == "laserRetro" and not pair.options.classic:
            facts["laser_retro"] = get_value(get_text(element))
        elif element.tag == "visual":
            facts.update(get_facts(element))
    return facts


def _get_material(pair: Pair, blocks: list[Element], shape: Shape) -> Facts:
    """Return the material from ``<gazebo>``, else from URDF."""
    visual = shape.part
    assert isinstance(visual, Visual)
    for block in blocks:
        facts = {f"material/{path}": value for path, value in get_facts(block).items()}
        if block.children:
            return facts
        name = get_text(block)
        color = COLORS.get(name)
        if pair.options.classic and name:
            return {}
        if color is not None:
            facts = {
                f"material/{tag}": (*getattr(color, tag), color.alpha)
                for tag in ("ambient", "diffuse", "specular")
            }
            if any(color.emissive):
                facts["material/emissive"] = (*color.emissive, 1.0)
            return facts | ({"transparency": (1 - color.alpha,)} if color.alpha < 1 else {})
    own = _get_defined(pair, visual.material)
    if own is None:
        return {}
    seen = bool(own.texture) and _is_there(pair, own.texture or "")
    if own.color is None and not seen:
        return {}
    rgba = own.color or (1.0, 1.0, 1.0, 1.0)
    facts = {"material/ambient": rgba, "material/diffuse": rgba}
    if rgba[3] < 1:
        facts["transparency"] = (1 - rgba[3],)
    if seen and not pair.options.classic:
        facts["material/pbr/metal/metalness"] = (0.0,)
    return facts


def _get_defined(pair: Pair, own: Material | None) -> Material | None:
    """Return the first material of a name with a color or an image."""
    if own is None:
        return None
    named = [v.material for link in pair.robot.links for v in link.visuals]
    for one in (own, *pair.robot.materials, *named):
        if one is not None and one.name == own.name and (one.color or one.texture):
            return one
    return None


def _is_there(pair: Pair, texture: str) -> bool:
    if pair.robot.source is None:
        return False
    try:
        return Path(pair.robot.source.resolve(texture)).is_file()
    except UrdftoolError:
        return False


def _make_only(facts: Facts, paths: tuple[str, ...]) -> Facts:
    return {path: value for path, value in facts.items() if path in paths}


def _make_without(facts: Facts, paths: tuple[str, ...]) -> Facts:
    return {path: value for path, value in facts.items() if path not in paths}
