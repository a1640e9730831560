"""The body tree: one body for each link, with its inertia, joint and geometry."""

from __future__ import annotations

from lxml import etree

from ...model.elements import Joint, Link
from ...model.settings import LINKS_OF_MUJOCO
from ..common.base_pose import get_robot_origin
from ..common.naming import UniqueNames
from ..written import Written
from .frame import set_origin, set_pose
from .gazebo import get_attributes
from .geom import list_collision_geoms, list_visual_geoms
from .home import Home
from .joint import build_joint_elements, create_locked_site
from .link_inertia import LinkInertia, build_inertial_element
from .material import Materials
from .meshes import Assets
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
        parts.extend(list_visual_geoms(link, assets, materials, names, written))
        parts.extend(list_collision_geoms(link, assets, names, written))
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
