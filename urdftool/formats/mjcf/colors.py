"""Materials for colors that several geoms share."""

from __future__ import annotations

from collections import Counter

from lxml import etree

from ..common.naming import UniqueNames

PLAIN: dict[tuple[float, ...], str] = {
    (0, 0, 0): "black",
    (1, 1, 1): "white",
    (1, 0, 0): "red",
    (0, 1, 0): "green",
    (0, 0, 1): "blue",
    (1, 1, 0): "yellow",
    (0, 1, 1): "cyan",
    (1, 0, 1): "magenta",
}


def create_share_colors(world: etree._Element, materials: list[etree._Element]) -> None:
    """Create a material for each color of two or more visual geoms.

    Args:
        world: ``<worldbody>``, whose geoms are modified.
        materials: Elements of ``<asset>``, to which the materials are appended.
    """
    geoms = [g for g in world.iter("geom") if g.get("class") == "visual" and g.get("rgba")]
    counts = Counter(geom.get("rgba", "") for geom in geoms)
    names = UniqueNames(tuple(m.get("name", "") for m in materials if m.tag == "material"))
    named: dict[str, str] = {}
    for geom in geoms:
        rgba = geom.get("rgba", "")
        if counts[rgba] < 2:
            continue
        if rgba not in named:
            named[rgba] = names.take(color_name(rgba))
            materials.append(etree.Element("material", name=named[rgba], rgba=rgba))
        del geom.attrib["rgba"]
        geom.set("material", named[rgba])


def color_name(rgba: str) -> str:
    """Name a color: a plain word, the percentage of a gray, or its hexadecimal digits."""
    red, green, blue, alpha = (min(max(float(part), 0.0), 1.0) for part in rgba.split())
    name = PLAIN.get((red, green, blue))
    if name is None and red == green == blue:
        name = f"gray{round(100 * red)}"
    if name is None:
        name = "color_" + "".join(f"{round(255 * part):02x}" for part in (red, green, blue))
    return name if alpha == 1 else f"{name}_alpha{round(100 * alpha)}"
