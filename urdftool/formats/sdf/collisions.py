"""Conversion of collisions to ``<collision>``, with the contact values of the link."""

from __future__ import annotations

from ...model.elements import Capsule, Collision, Cylinder, Link, Origin, Sphere
from ...model.pose import Pose, pose_of, rpy_of_rotation
from ...source.document import Element
from .extensions import merged, values
from .gltf import in_file_axes
from .keywords import COLLISION_KEYWORDS
from .shapes import geometry, set_place, writable
from .translation import Translation
from .xml import Node, add, at


def collision(node: Node, t: Translation, link: Link, part: Collision, name: str) -> None:
    """Add a collision; before SDF 1.8 a capsule becomes three shapes."""
    if not writable(t, link, part):
        return
    if isinstance(part.geometry, Capsule) and not t.options.since("1.8"):
        t.report_note(
            "capsule",
            f"SDF {t.options.sdf_version} has no capsule; exported as a cylinder and two spheres",
            part.geometry,
            link,
        )
        for suffix, piece in _pieces(part, part.geometry):
            _one(node, t, link, piece, name + suffix)
        return
    _one(node, t, link, part, name)


def _one(node: Node, t: Translation, link: Link, part: Collision, name: str) -> None:
    part = in_file_axes(t, link, part)
    made = add(node, "collision", name=name)
    set_place(made, t, link, part.origin)
    assert part.geometry is not None
    geometry(made, t, part.geometry)
    for tag, text in values(t, link, COLLISION_KEYWORDS).items():
        at(made, COLLISION_KEYWORDS[tag].path).text = text
    merged(made, t, link, "collision")


def _pieces(part: Collision, capsule: Capsule) -> list[tuple[str, Collision]]:
    pose = pose_of(part.origin)
    element = part.element

    def placed(z: float) -> Origin:
        moved = pose @ Pose(translation=(0.0, 0.0, z))
        return Origin(element, moved.translation, rpy_of_rotation(moved.rotation))

    tube = Cylinder(_tagged(capsule, "cylinder"), capsule.radius, capsule.length)
    ball = Sphere(_tagged(capsule, "sphere"), capsule.radius)
    half = capsule.length / 2
    return [
        ("", Collision(element, None, part.origin, tube)),
        ("_top", Collision(element, None, placed(half), ball)),
        ("_bottom", Collision(element, None, placed(-half), ball)),
    ]


def _tagged(capsule: Capsule, tag: str) -> Element:
    e = capsule.element
    return Element(tag, {}, e.parent, e.file, e.start, e.calls)
