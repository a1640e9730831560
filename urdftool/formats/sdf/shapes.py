"""Conversion of ``<geometry>`` and poses of shapes."""

from __future__ import annotations

from collections.abc import Callable

from ...model.bounds import has_extent
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Mesh,
    Origin,
    Plane,
    Sphere,
    UnknownShape,
    Visual,
)
from ...model.mesh_formats import READ_BY
from ...model.numbers import format_numbers_text, number_text
from ...model.pose import IDENTITY, make_pose
from ...model.shapes import get_shape_name
from .pose import set_origin, set_pose
from .translation import Translation
from .xml import Node, add


def set_place(node: Node, t: Translation, link: Link, origin: Origin | None) -> None:
    """Set the pose of an element of a link, which may have become a frame of its owner.

    The numbers of the source are kept, relative to that frame. Gazebo Classic ignores frames here,
    so for it the poses are composed.
    """
    if t.plan.stays(link.name):
        set_origin(node, origin, exact=t.options.is_at_least("1.9"))
    elif t.options.classic:
        set_pose(node, t.plan.in_owner[link.name] @ (make_pose(origin) if origin else IDENTITY))
    else:
        set_origin(node, origin, t.names.link(link.name), t.options.is_at_least("1.9"))


def is_writable(t: Translation, link: Link, shape: Visual | Collision) -> bool:
    """Tell whether a shape can be exported; report it if not."""
    geometry, beyond = shape.geometry, (UnknownShape, Cone, Plane)
    is_late = isinstance(geometry, Ellipsoid) and not t.options.is_at_least("1.8")
    if geometry is None or is_late or isinstance(geometry, beyond) or not has_extent(geometry):
        if geometry is None:
            what = "has no geometry"
        elif is_late:
            what = "has <ellipsoid>, which SDF has from 1.8 on"
        elif isinstance(geometry, beyond):
            what = f"has <{get_shape_name(geometry)}>, which is not written"
        else:
            what = f"has a <{get_shape_name(geometry)}> without extent"
        t.report_loss(
            "shape",
            f"a {shape.tag} of link '{link.name}' {what}; it is not exported",
            geometry or shape,
            link,
        )
        return False
    if isinstance(geometry, Mesh) and not t.meshes.is_known(geometry):
        t.report_loss(
            "mesh",
            f"mesh '{geometry.filename}' of link '{link.name}' is "
            f"{'not a mesh' if geometry.filename in t.meshes.refused else 'missing'}; the "
            f"{shape.tag} is not exported",
            geometry,
            link,
        )
        return False
    if isinstance(geometry, Mesh):
        _check_format(t, link, geometry)
    return True


def _check_format(t: Translation, link: Link, mesh: Mesh) -> None:
    """Report a mesh that the target cannot read; it is exported nevertheless."""
    known = READ_BY[t.options.target]
    name = mesh.filename.rpartition("/")[2]
    if name.rpartition(".")[2].lower() not in known:
        reader = "Gazebo Classic" if t.options.classic else "gz"
        t.report_loss(
            "mesh-format",
            (
                f"mesh '{mesh.filename}' of link '{link.name}' has a format that {reader} does not "
                "read"
            ),
            mesh,
            link,
            hint=f"convert it, for instance to {known[0]}",
        )


def add_geometry(node: Node, t: Translation, shape: Geometry) -> None:
    """Add the geometry of a visual or collision."""
    holder = add(node, "geometry")
    if isinstance(shape, Mesh):
        mesh = add(holder, "mesh")
        add(mesh, "uri", t.meshes.get_uri(shape))
        if shape.scale != (1.0, 1.0, 1.0):
            add(mesh, "scale", format_numbers_text(shape.scale))
        return
    _PRIMITIVES[type(shape)](add(holder, get_shape_name(shape)), shape)


def _add_box(node: Node, box: Box) -> None:
    add(node, "size", format_numbers_text(box.size))


def _round(node: Node, shape: Cylinder | Capsule) -> None:
    add(node, "radius", number_text(shape.radius))
    add(node, "length", number_text(shape.length))


def _add_sphere(node: Node, sphere: Sphere) -> None:
    add(node, "radius", number_text(sphere.radius))


def _add_ellipsoid(node: Node, ellipsoid: Ellipsoid) -> None:
    add(node, "radii", format_numbers_text(ellipsoid.radii))


_PRIMITIVES: dict[type, Callable[..., None]] = {
    Box: _add_box,
    Cylinder: _round,
    Capsule: _round,
    Sphere: _add_sphere,
    Ellipsoid: _add_ellipsoid,
}
