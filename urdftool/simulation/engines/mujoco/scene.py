"""The robot as MuJoCo reads it: our own MJCF export of it, in a scene with a plane."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, parse

from ....model.elements import Cone, Inertial, Joint, Link, Robot
from ....model.numbers import format_numbers_text
from ....model.pose import Pose, quaternion_from_rotation
from ....model.settings import RESISTANCE_OF_URDF
from ...rigid_bodies import ROOTED, RigidBodyModel
from ...settings import Settings
from ...shapes import Shape, make_shapes
from ..base import ExportMjcf

SCENE = "scene.xml"
_CONTACT_BITS = ("contype", "conaffinity")
PLANE = "plane of the simulation"
MOTOR = "motor of "
"""What the motor of each held joint is called, before the joint's name."""


def write_model(
    robot: Robot,
    bodies: RigidBodyModel,
    settings: Settings,
    folder: Path,
    export_mjcf: ExportMjcf,
) -> Path:
    """Write the MJCF of a robot, its meshes and the scene around it; the path of the scene.

    Raises:
        Refused: It has defects past which no MJCF can be written.
    """
    root = robot.tree.root
    assert root is not None
    held = bodies.fixed_base or bodies.bodies[0].name != root.name
    model = _remove_without_visuals(robot, settings, rename=not held)
    written = export_mjcf(model, held)
    for name, content in written.files.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            target.write_bytes(content)
        else:
            shutil.copyfile(content, target)
    _add_cones(model, folder / written.main)
    path = folder / SCENE
    ElementTree(_build_scene(written.main, bodies)).write(path, "utf-8", xml_declaration=True)
    return path


def _add_cones(robot: Robot, path: Path) -> None:
    """Add the cones of a robot to its MJCF as convex meshes: MuJoCo's geoms have no cone."""
    cones = {
        link.name: replace(link, collisions=[c for c in link.collisions if _is_cone(c.geometry)])
        for link in robot.links
    }
    if not any(link.collisions for link in cones.values()):
        return
    tree = parse(path)
    root = tree.getroot()
    bodies = {body.get("name"): body for body in root.iter("body")}
    asset = SubElement(root, "asset")
    for name, link in cones.items():
        body = bodies.get(name, root.find("worldbody"))
        for shape in make_shapes(robot, link, Pose(), 0):
            assert body is not None
            _add_mesh(asset, body, f"cone {shape.index} of {name}", shape)
    tree.write(path, "utf-8", xml_declaration=True)


def _is_cone(geometry: object) -> bool:
    return isinstance(geometry, Cone) and geometry.radius > 0 and geometry.length > 0


def _add_mesh(asset: Element, body: Element, name: str, shape: Shape) -> None:
    """Add a convex shape without mass to a body whose frame is that of the shape's pose."""
    corners = format_numbers_text(shape.pieces[0].ravel().tolist())
    SubElement(asset, "mesh", name=name, vertex=corners)
    at = format_numbers_text(shape.pose.translation)
    turn = format_numbers_text(quaternion_from_rotation(shape.pose.rotation))
    geom = SubElement(body, "geom", type="mesh", mesh=name, mass="0", pos=at, quat=turn)
    geom.attrib |= dict.fromkeys(_CONTACT_BITS, "1")


def _build_scene(main: str, bodies: RigidBodyModel) -> Element:
    scene = Element("mujoco", model="scene")
    SubElement(scene, "include", file=main)
    world = SubElement(scene, "worldbody")
    SubElement(world, "geom", name=PLANE, type="plane", size="0 0 1")
    motors = SubElement(scene, "actuator")
    for joint in bodies.joints:
        if joint.leader is None and joint.lower != joint.upper:
            SubElement(motors, "motor", name=MOTOR + joint.name, joint=joint.name)
    return scene


def _remove_without_visuals(robot: Robot, settings: Settings, *, rename: bool) -> Robot:
    """Remove visuals, add payloads, and rename a moving link that is called world."""
    links = [
        _remove_with_payload(link, settings.payloads.get(link.name, 0.0)) for link in robot.links
    ]
    joints = [_set_without_negative_losses(joint) for joint in robot.joints]
    root = robot.tree.root
    if rename or root is None or root.name != ROOTED:
        name = get_moving_name(ROOTED)
        links = [replace(link, name=name) if link.name == ROOTED else link for link in links]
        joints = [_make_renamed_ends(joint, name) for joint in joints]
    frames = [frame for frame in robot.frames if frame.kind != "body"]  # bodies are at their joints
    return replace(robot, links=links, joints=joints, frames=frames)


def get_moving_name(name: str) -> str:
    """Return the name of a link's body, if MuJoCo reserves the link's own name."""
    return f"{name} (moving)"  # which no other link is called


def _set_without_negative_losses(joint: Joint) -> Joint:
    """Set values of the dynamics below zero to zero, which would drive a joint."""
    values = {name: getattr(joint.dynamics, name, None) for name in RESISTANCE_OF_URDF}
    return joint.replace_resistance({n: 0.0 for n, value in values.items() if (value or 0.0) < 0})


def _make_renamed_ends(joint: Joint, name: str) -> Joint:
    if ROOTED not in (joint.parent, joint.child):
        return joint
    parent, child = (name if end == ROOTED else end for end in (joint.parent, joint.child))
    return replace(joint, parent=parent, child=child)


def _remove_with_payload(link: Link, payload: float) -> Link:
    """Remove visuals, and add a point mass [kg] at the center of mass."""
    inertial = link.inertial
    if payload:
        mass = link.mass + payload
        inertial = (
            Inertial(link.provenance, None, mass)
            if inertial is None or not link.mass
            else replace(inertial, mass=mass)
        )
    # all collisions of the robot touch the plane: one whose contacts <pair> lists has contype 0
    collisions = [
        replace(one, surface={n: v for n, v in one.surface.items() if n not in _CONTACT_BITS})
        for one in link.collisions
    ]
    return replace(link, visuals=[], collisions=collisions, inertial=inertial)
