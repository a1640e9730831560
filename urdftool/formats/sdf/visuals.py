"""Conversion of visuals to ``<visual>``, with color or texture."""

from __future__ import annotations

from ...model.elements import Capsule, Cylinder, Link, Visual
from ...source.document import Element
from .extensions import list_values, merge_elements
from .gltf import undo_axis_conversion
from .keywords import COLLISION_KEYWORDS
from .materials import add_material
from .shapes import add_geometry, is_writable, set_place
from .translation import Translation
from .xml import Node, add


def add_visual(node: Node, t: Translation, link: Link, part: Visual, name: str) -> None:
    """Add a visual; before SDF 1.8 a capsule becomes a cylinder of its full length."""
    if not is_writable(t, link, part):
        return
    part = undo_axis_conversion(t, link, part)
    made = add(node, "visual", name=name)
    set_place(made, t, link, part.origin)
    shape = part.geometry
    if isinstance(shape, Capsule) and not t.options.is_at_least("1.8"):
        t.report_loss(
            "capsule",
            (
                f"SDF {t.options.sdf_version} has no capsule; exported as a cylinder of its full "
                "length"
            ),
            shape,
            link,
        )
        e = shape.element
        tube = Element("cylinder", {}, e.parent, e.file, e.start, e.calls)
        shape = Cylinder(tube, shape.radius, shape.length + 2 * shape.radius)
    assert shape is not None
    add_geometry(made, t, shape)
    add_material(made, t, link, part)
    retro = list_values(t, link, COLLISION_KEYWORDS).get("laserRetro")
    if retro is not None and not t.options.classic:
        add(made, "laser_retro", retro)
    merge_elements(made, t, link, "visual")
