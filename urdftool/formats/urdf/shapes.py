"""Visuals and collisions of an export to URDF."""

from __future__ import annotations

from dataclasses import replace

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Material,
    Mesh,
    Origin,
    Robot,
    Sphere,
    Visual,
)
from ...model.materials import UNCOLORED, resolve_material
from ...model.pose import Pose, get_origin_at, make_pose
from ...model.settings import LOST_SETTINGS
from ...model.shapes import get_shape_name
from ..written import Written
from .mesh_files import MeshFiles
from .translation import add_origin, format_numbers


def add_shape(
    robot: Robot,
    written: Written,
    meshes: MeshFiles,
    node: etree._Element,
    link: Link,
    shape: Visual | Collision,
) -> None:
    """Add a visual or collision to the element of its link, or report why it is dropped."""
    kind = "visual" if isinstance(shape, Visual) else "collision"
    for number, (origin, geometry) in enumerate(_split(shape.origin, shape.geometry)):
        inner = _make_geometry(geometry, meshes)
        if inner is None:
            name = get_shape_name(geometry)
            text = f"{kind} of link '{link.name}' is dropped, since URDF has no shape '{name}'"
            written.report_loss("shape", text, shape.place, kind="link", name=link.name)
            continue
        end = f"_end{number}" if number else ""  # names in a link are unique
        attributes = {"name": shape.name + end} if shape.name else {}
        outer = etree.SubElement(node, kind, attributes)
        add_origin(outer, origin)
        etree.SubElement(outer, "geometry").append(inner)
        if isinstance(shape, Visual) and shape.material is not None:
            _add_material(robot, meshes, outer, shape.material)
    if isinstance(shape, Visual):
        _report_looks(robot, written, link, shape)
    if isinstance(shape.geometry, Capsule):
        text = f"{kind} of link '{link.name}' is a cylinder with two spheres in place of a capsule"
        written.report_loss(
            "capsule", text, shape.place, kind="link", name=link.name, severity=Severity.INFO
        )


def _report_looks(robot: Robot, written: Written, link: Link, shape: Visual) -> None:
    """Report lights of a visual, which plain URDF does not have; blocks of URDF are copied."""
    in_color = ("diffuse", "transparency") if "diffuse" in shape.appearance else ()
    lost = [name for name in shape.appearance if name not in in_color]
    if robot.format == "sdf" and shape.material is not None and "ambient" not in lost:
        lost.append("ambient")  # black in SDF where none is written, the color in URDF
    if lost and robot.format != "urdf":
        names, data = ", ".join(lost).replace("_", " "), {LOST_SETTINGS: lost}
        verb = "are" if len(lost) > 1 else "is"
        text = f"{names} of a visual of link '{link.name}' {verb} dropped; URDF has a color"
        info, kind = Severity.INFO, "link"
        written.report_loss(
            "appearance", text, shape.place, kind=kind, name=link.name, severity=info, data=data
        )


def _split(
    origin: Origin | None, geometry: Geometry | None
) -> list[tuple[Origin | None, Geometry]]:
    """Return the shapes of URDF that form a shape: those of a capsule are three."""
    if geometry is None:
        return []
    if isinstance(geometry, Ellipsoid) and len(set(geometry.radii)) == 1:
        return [(origin, Sphere(geometry.provenance, geometry.radii[0]))]
    if not isinstance(geometry, Capsule):
        return [(origin, geometry)]
    pose, place = make_pose(origin), geometry.provenance
    ball = Sphere(place, geometry.radius)
    ends: list[tuple[Origin | None, Geometry]] = [
        (get_origin_at(pose @ Pose(translation=(0.0, 0.0, z))), replace(ball))
        for z in (-geometry.length / 2, geometry.length / 2)
    ]
    return [(origin, Cylinder(place, geometry.radius, geometry.length)), *ends]


def _make_geometry(geometry: Geometry, meshes: MeshFiles) -> etree._Element | None:
    if isinstance(geometry, Box):
        return etree.Element("box", size=format_numbers(*geometry.size))
    if isinstance(geometry, Sphere):
        return etree.Element("sphere", radius=format_numbers(geometry.radius))
    if isinstance(geometry, Cylinder):
        radius, length = format_numbers(geometry.radius), format_numbers(geometry.length)
        return etree.Element("cylinder", radius=radius, length=length)
    if isinstance(geometry, Mesh):
        place = meshes.get_place(geometry.filename)
        if place is None:
            return None
        node = etree.Element("mesh", filename=place)
        if geometry.scale != (1.0, 1.0, 1.0):
            node.set("scale", format_numbers(*geometry.scale))
        return node
    return None


def _add_material(
    robot: Robot, meshes: MeshFiles, parent: etree._Element, material: Material
) -> None:
    """Add a material with its own color or texture; one by name is resolved."""
    full = resolve_material(robot, material)
    color, texture = (None, None) if full is None else (full.color, full.texture)
    place = meshes.get_place(texture) if texture else None
    if color == UNCOLORED.get(robot.format) and not material.name:
        color = None
    if color is None and place is None:
        return
    name = material.name or "rgba_" + "_".join(f"{part:.4g}" for part in color or ())
    node = etree.SubElement(parent, "material", name=name)
    if color is not None:
        etree.SubElement(node, "color", rgba=format_numbers(*color))
    if place is not None:
        etree.SubElement(node, "texture", filename=place)
