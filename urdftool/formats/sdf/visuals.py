"""Conversion of visuals to ``<visual>``, with color or texture."""

from __future__ import annotations

from ...model.elements import Capsule, Cylinder, Link, Visual
from ...source.document import Element
from .extensions import merged, values
from .gltf import in_file_axes
from .keywords import COLLISION_KEYWORDS
from .materials import material
from .shapes import geometry, set_place, writable
from .translation import Translation
from .xml import Node, add


def visual(node: Node, t: Translation, link: Link, part: Visual, name: str) -> None:
    """Add a visual; before SDF 1.8 a capsule becomes a cylinder of its full length."""
    if not writable(t, link, part):
        return
    part = in_file_axes(t, link, part)
    made = add(node, "visual", name=name)
    set_place(made, t, link, part.origin)
    shape = part.geometry
    if isinstance(shape, Capsule) and not t.options.since("1.8"):
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
    geometry(made, t, shape)
    material(made, t, link, part)
    retro = values(t, link, COLLISION_KEYWORDS).get("laserRetro")
    if retro is not None and not t.options.classic:
        add(made, "laser_retro", retro)
    merged(made, t, link, "visual")
