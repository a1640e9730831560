"""The body tree: one body for each link, with its inertia, joint and geometry."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from ...model.elements import Collision, Joint, Link, Mesh, Visual
from ...model.numbers import format_numbers_text
from ...model.settings import LINKS_OF_MUJOCO
from ...model.shapes import get_shape_name
from ..common.base_pose import get_robot_origin
from ..common.naming import UniqueNames
from ..common.shape_box import get_shape_size
from ..written import Written
from .frame import set_origin, set_pose
from .gazebo import get_attributes, get_surface_attributes, report_surface_losses
from .home import Home
from .joint import build_joint_elements, create_locked_site
from .link_inertia import LinkInertia, build_inertial_element
from .material import Materials
from .meshes import Assets, MeshPiece
from .structure import Structure

Bodies = dict[str, etree._Element]


def build_body_tree(
    structure: Structure, home: Home, model: str, written: Written
) -> tuple[etree._Element, Bodies]:
    """Build ``<worldbody>`` with an empty body for each link; return it and the bodies by link.

    A root link named world becomes the worldbody. Free bodies are children of the worldbody, as
    MuJoCo requires.
    """
    robot = structure.robot
    world = etree.Element("worldbody")
    bodies: Bodies = {structure.root.name: world}
    if not structure.in_world:
        body = etree.SubElement(world, "body", name=structure.root.name)
        bodies[structure.root.name] = body
        set_origin(body, get_robot_origin(robot))
    for joint in structure.joints:
        body = etree.Element("body", name=structure.get_body_name(joint.child))
        parent = bodies[joint.parent]
        if structure.get_kind(joint) == "free" and parent is not world:
            set_pose(body, home.start @ structure.get_pose_at_zero(joint.child))
            world.append(body)
            if not structure.is_static(joint.parent):
                _report_detached_body(joint, written)
        else:
            if structure.locked.get(joint.name):
                set_pose(body, structure.compute_joint_pose(joint))
            else:
                set_origin(body, joint.origin)
            parent.append(body)
        bodies[joint.child] = body
    for body in world:
        body.set("childclass", model)
    return world, bodies


def fill_bodies(
    structure: Structure,
    bodies: Bodies,
    masses: dict[str, LinkInertia],
    assets: Assets,
    materials: Materials,
    written: Written,
) -> None:
    """Insert inertial, joints and geoms of each link into its body, before its child bodies."""
    names = UniqueNames()
    for name, body in bodies.items():
        link = structure.robot.link[name]
        parts: list[etree._Element] = []
        if name in masses:
            if body.tag == "worldbody":
                _report_world_mass(link, written)
            else:
                parts.append(build_inertial_element(masses[name]))
        parts.extend(_build_joints(structure, name, written))
        parts.extend(_list_visual_geoms(link, assets, materials, names, written))
        parts.extend(_list_collision_geoms(link, assets, names, written))
        body[0:0] = parts
        if link.is_weightless and body.tag == "body":
            body.set("gravcomp", "1")
        elif body.tag == "body":
            for attribute, value in get_attributes(link.settings, LINKS_OF_MUJOCO).items():
                body.set(attribute, value)
    for name, body in bodies.items():
        for geom in body.iterchildren("geom"):
            if geom.get("class") == "collision" and not geom.get("name"):
                geom.set("name", names.take(f"{name}_collision"))


def _build_joints(structure: Structure, link: str, written: Written) -> list[etree._Element]:
    joint = structure.robot.tree.get_parent_joint(link)
    if joint is None:
        return [etree.Element("freejoint", name=f"{link}_freejoint")] if structure.free else []
    if joint.name in structure.locked:
        return [create_locked_site(joint, written)]
    if structure.get_kind(joint) == "weld":
        return []
    return build_joint_elements(structure, joint, written)


def _report_detached_body(joint: Joint, written: Written) -> None:
    written.report_loss(
        "floating",
        f"link '{joint.child}' floats, and its parent '{joint.parent}' moves; free bodies in "
        "MuJoCo are children of the world, so it starts at its pose with all joints at zero",
        joint.place,
        kind="joint",
        name=joint.name,
    )


def _report_world_mass(link: Link, written: Written) -> None:
    place = link.place if link.inertial is None else link.inertial.place
    written.report_loss(
        "world-mass",
        f"link '{link.name}' is MuJoCo's world, which has no mass; it does not move",
        place,
        kind="link",
        name=link.name,
    )


_SIZELESS = "not exported: it has no size"


def _list_visual_geoms(
    link: Link, assets: Assets, materials: Materials, names: UniqueNames, written: Written
) -> Iterator[etree._Element]:
    """Yield the geoms of a link's visuals, one for each material of a mesh."""
    for visual in link.visuals:
        for index, (geom, piece) in enumerate(_list_geoms(link, visual, assets, written)):
            _set_name(geom, link, visual, names, index)
            geom.set("class", "visual")
            materials.set_material(geom, visual, link, piece)
            yield geom


def _list_collision_geoms(
    link: Link, assets: Assets, names: UniqueNames, written: Written
) -> Iterator[etree._Element]:
    """Yield the geoms of a link's collisions."""
    report_surface_losses(link, written)
    for collision in link.collisions:
        for index, (geom, _) in enumerate(_list_geoms(link, collision, assets, written)):
            _set_name(geom, link, collision, names, index)
            geom.set("class", "collision")
            for name, value in get_surface_attributes(collision).items():
                geom.set(name, value)
            yield geom


def _list_geoms(
    link: Link, shape: Visual | Collision, assets: Assets, written: Written
) -> Iterator[tuple[etree._Element, MeshPiece | None]]:
    what = "visual" if isinstance(shape, Visual) else "collision"
    if isinstance(shape.geometry, Mesh):
        for piece in assets.pieces.get(id(shape.geometry), ()):
            geom = etree.Element("geom", type="mesh", mesh=piece.name)
            set_origin(geom, shape.origin)
            yield geom, piece
        if id(shape.geometry) not in assets.pieces:
            _report_shape_loss(
                link,
                shape,
                f"a {what} of link '{link.name}' is not exported: its mesh is missing",
                written,
            )
        return
    simple = get_shape_size(shape.geometry)
    if simple is None:
        tag = f"<{get_shape_name(shape.geometry)}>" if shape.geometry is not None else "nothing"
        _report_shape_loss(
            link,
            shape,
            f"a {what} of link '{link.name}' is not exported: its geometry is {tag}",
            written,
        )
        return
    if not min(simple[1]) > 0:
        if simple[0] == "capsule" and simple[1][0] > 0 and simple[1][1] == 0:
            simple = "sphere", simple[1][:1]
        else:
            _report_shape_loss(
                link, shape, f"a {what} of link '{link.name}' is {_SIZELESS}", written
            )
            return
    geom = etree.Element("geom", type=simple[0], size=format_numbers_text(simple[1]))
    set_origin(geom, shape.origin)
    yield geom, None


def _report_shape_loss(
    link: Link, shape: Visual | Collision, message: str, written: Written
) -> None:
    kind = "visual" if isinstance(shape, Visual) else "collision"
    written.report_loss(kind, message, shape.place, kind="link", name=link.name)


def _set_name(
    geom: etree._Element, link: Link, shape: Visual | Collision, names: UniqueNames, index: int
) -> None:
    """Keep the name of a shape, made unique among all geoms."""
    if not shape.name:
        return
    kind = "visual" if isinstance(shape, Visual) else "collision"
    own = shape.name if index == 0 else f"{shape.name}_{index}"
    name = names.take(own, f"{link.name}_{own}", f"{link.name}_{own}_{kind}")
    geom.set("name", name)
