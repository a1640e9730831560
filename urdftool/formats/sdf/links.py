"""Conversion of links to ``<link>``, with the content of the links that they own."""

from __future__ import annotations

from dataclasses import replace

from ...model.block_elements import is_set_by_block
from ...model.elements import Capsule, Collision, Cylinder, Link, Origin, Sphere, Visual
from ...model.numbers import format_content
from ...model.pose import Pose, make_pose, rpy_from_rotation
from ...model.settings import SURFACE
from .extensions import link_extensions, merge_elements, write_settings
from .frames import place
from .gltf import undo_axis_conversion
from .inertials import add_inertial
from .materials import add_material
from .native import merge_native
from .sensors import add_sensors
from .shape_names import choose_shape_names
from .shapes import add_geometry, is_writable, set_place
from .translation import Translation
from .xml import Node, add


def link(model: Node, t: Translation, part: Link) -> None:
    """Add a link that stays a body."""
    node = add(model, "link", name=t.names.link(part.name))
    place(node, t, t.robot.tree.get_parent_joint(part.name))
    add_inertial(node, t, part)
    members = [t.robot.link[name] for name in t.plan.members[part.name]]
    names = choose_shape_names(members)
    for member in members:
        for one in member.visuals:
            add_visual(node, t, member, one, names[id(one)])
    for member in members:
        for two in member.collisions:
            add_collision(node, t, member, two, names[id(two)])
    for member in members:
        add_sensors(node, t, member)
    for member in members:
        link_extensions(node, t, member)


def add_collision(node: Node, t: Translation, link: Link, part: Collision, name: str) -> None:
    """Add a collision; before SDF 1.8 a capsule becomes three shapes."""
    if not is_writable(t, link, part):
        return
    if isinstance(part.geometry, Capsule) and not t.options.is_at_least("1.8"):
        t.report_note(
            "capsule",
            f"SDF {t.options.sdf_version} has no capsule; exported as a cylinder and two spheres",
            part.geometry,
            link,
        )
        for suffix, piece in _collect_pieces(part, part.geometry):
            _add_one(node, t, link, piece, name + suffix)
        return
    _add_one(node, t, link, part, name)


def _add_one(node: Node, t: Translation, link: Link, part: Collision, name: str) -> None:
    part = undo_axis_conversion(t, link, part)
    made = add(node, "collision", name=name)
    set_place(made, t, link, part.origin)
    assert part.geometry is not None
    add_geometry(made, t, part.geometry)
    if is_set_by_block(part.name, link.name):
        merge_elements(made, t, link, "collision")
    merge_native(made, t, f"link {link.name}", part)
    write_settings(made, part.surface, SURFACE)


def _collect_pieces(part: Collision, capsule: Capsule) -> list[tuple[str, Collision]]:
    pose = make_pose(part.origin)
    element = part.provenance

    def placed(z: float) -> Origin:
        moved = pose @ Pose(translation=(0.0, 0.0, z))
        return Origin(element, moved.translation, rpy_from_rotation(moved.rotation))

    tube = Cylinder(capsule.provenance, capsule.radius, capsule.length)
    ball = Sphere(capsule.provenance, capsule.radius)
    half = capsule.length / 2
    return [
        ("", replace(part, geometry=tube)),
        ("_top", replace(part, origin=placed(half), geometry=ball)),
        ("_bottom", replace(part, origin=placed(-half), geometry=ball)),
    ]


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
        shape = Cylinder(shape.provenance, shape.radius, shape.length + 2 * shape.radius)
    assert shape is not None
    add_geometry(made, t, shape)
    add_material(made, t, link, part)
    retro = link.surface.get("laser_retro")
    if retro is not None and not t.options.classic:
        add(made, "laser_retro", format_content(retro.content))
    merge_elements(made, t, link, "visual")
    merge_native(made, t, f"link {link.name}", part)
