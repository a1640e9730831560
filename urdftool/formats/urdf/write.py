"""Export of a robot to URDF: files and losses."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import PurePath

from lxml import etree

from ...diagnostic import Severity
from ...errors import ModelError
from ...listing import quote_first
from ...model.drawn import list_drawn_once
from ...model.elements import BALL_TYPES, Collision, Joint, Link, Origin, Robot, Visual
from ...model.kinematics import UNLIMITED
from ...model.link import COMPONENTS
from ...model.mechanism import Base, Frame
from ...model.numbers import number_text
from ...model.pose import IDENTITY, make_pose
from ...model.selection import list_below, measure_tree, select_links
from ...model.settings import MAGNITUDES, RESISTANCE_OF_URDF
from ...model.urdf_schema import VOCABULARY
from ...model.world import WORLD
from ...source.document import Element
from ..common.directory import mark
from ..common.force_fallbacks import (
    FATAL,
    drop_invalid_parts,
    report_passed_defects,
    report_tree_defects,
)
from ..common.missing_bounds import explain_missing_bounds
from ..common.naming import UniqueNames, replace_file_name, shorten_file_name
from ..common.unexpressed import (
    report_moved_frames,
    report_other_elements,
    report_unwritten_settings,
    report_world_settings,
)
from ..defects import refuse
from ..written import Written
from .control import add_control
from .gazebo import add_cameras, add_sensors, copy_element, copy_extensions
from .mesh_files import MeshFiles, report_mesh_defects
from .names import Names
from .options import Options
from .semantics import make_srdf
from .settings import add_settings
from .shapes import add_shape
from .translation import Translation, add, add_origin, format_numbers


def write(robot: Robot, options: Options | None = None) -> Written:
    """Convert a robot to URDF.

    Raises:
        Refused: The robot has defects that prevent the export; the error lists them.
    """
    options = options or Options()
    stem = replace_file_name(robot.name or "robot")
    written = Written(options.file or f"{shorten_file_name(stem)}.urdf")
    robot = source = _put_on_world(_take_tree(robot, options.root, written), written)
    left = drop_invalid_parts(robot)
    converted = {joint.name for joint in robot.joints if joint.type in (*BALL_TYPES, "screw")}
    found = [
        finding
        for finding in report_tree_defects(robot, left, options.force)
        if finding.code != "unknown-joint-type" or finding.name not in converted
    ]
    if options.force:
        robot = left
    meshes = MeshFiles(robot, options)
    found += report_mesh_defects(robot, meshes)
    refuse(found, force=options.force, fatal=FATAL)
    t = Translation(robot, options, written, Names(robot, written), meshes)
    t.root.set("name", robot.name or "robot")
    for link in robot.links:
        _add_link(t, link)
    for joint in robot.joints:
        _add_joint(t, joint)
    _add_frames(t)
    copy_extensions(t)
    add_control(t)
    add_settings(t)
    add_cameras(t)
    add_sensors(t)
    _report_unexpressed(t)
    report_passed_defects(written, found)
    written.planned = source
    written.files[written.main] = _format_file(t, t.root)
    semantics = make_srdf(t)
    if semantics is not None:
        written.files[str(PurePath(written.main).with_suffix(".srdf"))] = _format_file(t, semantics)
    for path, name in meshes.places.items():
        written.files.setdefault(name, path)
    return written


def _format_file(t: Translation, root: etree._Element) -> bytes:
    etree.indent(root, "  ")
    source = PurePath(t.robot.source.path).name if t.robot.source is not None else "a robot"
    text = b'<?xml version="1.0"?>\n' + etree.tostring(root, encoding="UTF-8") + b"\n"
    return mark(text, source)


def _add_link(t: Translation, link: Link) -> None:
    node = add(t.root, "link", name=t.names.links[link.name])
    inertial = link.inertial
    if inertial is not None and inertial.mass is not None:
        inner = add(node, "inertial")
        add_origin(inner, inertial.origin)
        add(inner, "mass", value=number_text(inertial.mass))
        six = (0.0,) * 6 if inertial.inertia is None else inertial.inertia.six
        add(inner, "inertia", **{n: number_text(v) for n, v in zip(COMPONENTS, six, strict=True)})
    contact = link.find_child_xml("contact")
    if contact is not None:
        copy_element(node, contact)
    shapes: list[Visual | Collision] = [*list_drawn_once(t.robot, link), *link.collisions]
    for shape in shapes:
        add_shape(t.robot, t.written, t.meshes, node, link, shape)


def _add_joint(t: Translation, joint: Joint) -> None:
    name, child = t.names.joints[joint.name], t.names.links.get(joint.child, joint.child)
    parent = t.names.links.get(joint.parent, joint.parent)
    if joint.type in BALL_TYPES:
        _add_ball(t, joint, name, parent, child)
        return
    kind = joint.type
    if kind == "screw":
        kind = "continuous"
        text = f"joint '{joint.name}' is continuous, since URDF has no screws"
        t.written.report_loss("screw", text, joint.place, kind="joint", name=joint.name)
    if kind == "revolute" and joint.turns_freely:
        kind, text = "continuous", explain_missing_bounds(joint)
        t.written.report_loss("limit", text, joint.place, kind="joint", name=joint.name)
    node = _make_joint(t, name, kind, parent, child, joint.origin)
    if kind == "fixed":
        return
    if joint.axis is not None and kind != "floating":
        add(node, "axis", xyz=format_numbers(*joint.axis.xyz))
    _add_limit(t, node, joint, kind)
    values = {name: getattr(joint.dynamics, name, None) for name in RESISTANCE_OF_URDF}
    if written := {n: number_text(v) for n, v in values.items() if v is not None}:
        add(node, "dynamics", **written)
    if joint.mimic is not None:
        m = joint.mimic
        leader = t.names.joints.get(m.joint, m.joint)
        add(
            node,
            "mimic",
            joint=leader,
            multiplier=number_text(m.multiplier),
            offset=number_text(m.offset),
        )
    for tag in ("safety_controller", "calibration"):
        element = joint.find_child_xml(tag)
        if element is not None:
            add(node, tag, **element.attributes)


def _make_joint(
    t: Translation, name: str, kind: str, parent: str, child: str, origin: Origin | None
) -> etree._Element:
    node = add(t.root, "joint", name=name, type=kind)
    add(node, "parent", link=parent)
    add(node, "child", link=child)
    add_origin(node, origin)
    return node


def _add_limit(t: Translation, node: etree._Element, joint: Joint, kind: str) -> None:
    """Add the limits; URDF requires effort and velocity in each."""
    limit = joint.limit
    needed = kind in ("revolute", "prismatic")
    magnitudes = {name: getattr(limit, name, None) for name in MAGNITUDES}
    missing = [name for name, value in magnitudes.items() if value is None]
    if not needed and len(missing) == len(magnitudes):
        return
    values: dict[str, float] = {}
    if needed:
        lower, upper = (None, None) if limit is None else (limit.lower, limit.upper)
        unlimited = limit is None
        values["lower"] = _bound(lower, -UNLIMITED if unlimited else 0.0)
        values["upper"] = _bound(upper, UNLIMITED if unlimited else 0.0)
    values |= {name: _bound(value, UNLIMITED) for name, value in magnitudes.items()}
    if missing:
        text = (
            f"joint '{joint.name}' has no limit of {' and '.join(missing)}; URDF requires one, so "
            f"{UNLIMITED:g} is written"
        )
        data = {"missing": missing}
        t.written.report_loss(
            "limit", text, joint.place, kind="joint", name=joint.name,
            severity=Severity.INFO, data=data,
        )  # fmt: skip
    add(node, "limit", **{name: number_text(value) for name, value in values.items()})


def _bound(value: float | None, default: float) -> float:
    if value is None:
        return default
    return value if math.isfinite(value) else math.copysign(UNLIMITED, value)


def _add_ball(t: Translation, joint: Joint, name: str, parent: str, child: str) -> None:
    """Write a ball joint as three hinges with links without mass between them."""
    lost = ["limit"] if joint.limit is not None else []
    lost += [name for name in RESISTANCE_OF_URDF if joint.get_resistance(name)]
    rest = f"; its {' and '.join(lost)} {'are' if len(lost) > 1 else 'is'} dropped" if lost else ""
    text = f"joint '{joint.name}' is three hinges about x, y and z, since URDF has no ball joints"
    t.written.report_loss("ball", text + rest, joint.place, kind="joint", name=joint.name)
    origin = joint.origin
    for number, axis in enumerate(("1 0 0", "0 1 0", "0 0 1")):
        to = child if number == 2 else t.names.taken_links.take(f"{name}_{'xy'[number]}_link")
        if to != child:
            add(t.root, "link", name=to)
        own = t.names.taken_joints.take(f"{name}_{'xyz'[number]}")
        node = _make_joint(t, own, "continuous", parent, to, origin)
        add(node, "axis", xyz=axis)
        parent, origin = to, None


def _add_frames(t: Translation) -> None:
    """Add a link without mass for each named frame."""
    report_moved_frames(t.robot, t.written)
    if not t.options.frames:
        for frame in t.robot.frames:
            text = f"{frame.kind} '{frame.name}' is dropped"
            t.written.report_loss(
                "frame", text, frame.place, kind="link", name=frame.link, severity=Severity.INFO
            )
        return
    for frame in t.robot.frames:
        name = t.names.taken_links.take(_get_frame_name(frame))
        add(t.root, "link", name=name)
        own = t.names.taken_joints.take(f"{name}_fixed")
        parent = t.names.links.get(frame.link, frame.link)
        _make_joint(t, own, "fixed", parent, name, frame.origin)


def _get_frame_name(frame: Frame) -> str:
    if frame.kind == "body":
        return f"{frame.link}_origin"
    return (frame.name or f"{frame.link}_{frame.kind}").replace("::", "_")


def _report_unexpressed(t: Translation) -> None:
    """Report what the reader left out, and what URDF cannot hold, once for each kind."""
    robot = t.robot
    t.written.unread = robot.unread
    t.written.losses += robot.unread
    if robot.xml is None:
        report_world_settings(robot, t.written)
        report_unwritten_settings(robot, t.written, lambda row: row.path)
    else:
        copied = {element.tag for element in robot.xml.children} - {"mujoco"}
        report_other_elements(robot, t.written, expressed=copied)
        _report_additions(robot.xml, t.written)
    rotors = [j for j in robot.joints if j.dynamics is not None and j.dynamics.armature]
    kinds = (
        ("armature", "rotor inertia (armature) of joints is dropped", rotors),
        ("closure", "connections that close loops are dropped", robot.closures),
        ("plugin", "plugins of Gazebo are dropped", robot.mounted_plugins),
    )
    for code, text, parts in kinds:
        if parts:
            t.written.report_loss(
                code, f"{text}: {len(parts)}", parts[0].place, kind="robot", name=robot.name
            )


def _take_tree(robot: Robot, root: str, written: Written) -> Robot:
    """Return the robot of a model, without bodies that move freely next to it.

    A URDF describes one robot, whose free base has no joint. Of several trees at the world, the one
    with most joints that move is the robot. A source in URDF stays as it is.

    Raises:
        ModelError: The model has no such tree.
    """
    tops = _list_trees(robot)
    if root and root not in tops:
        trees = f"its trees begin at {quote_first(list(tops), 4)}" if tops else "it is one tree"
        raise ModelError(f"the model has no tree with the root link '{root}'; {trees}")
    if not tops:
        return robot
    largest = max(tops, key=lambda top: measure_tree(robot.tree, top))
    chosen = root or largest
    _report_others(robot, [top for top in tops if top != chosen], written)
    names = set(list_below(robot.tree, chosen))
    joint = tops[chosen]
    if joint.type != "floating":
        names.add(WORLD)
        return select_links(robot, [link for link in robot.links if link.name in names])
    _report_world(robot, written)
    part = select_links(robot, [link for link in robot.links if link.name in names])
    return replace(part, base=Base(joint.provenance, True, joint.origin))


_COPIED = ("contact",)
"""Elements of a link that are not URDF's, and are copied."""


def _report_additions(root: Element, written: Written) -> None:
    """Report attributes and elements of links and joints that URDF does not have."""
    for part in (*root.list_children("link"), *root.list_children("joint")):
        for what, element in _list_additions(part):
            name = part.get("name") or ""
            text = f"{what} of {part.tag} '{name}' is dropped"
            place, kind = element.place, part.tag
            written.report_loss("addition", text, place, kind=kind, name=name)


def _list_additions(element: Element) -> Iterator[tuple[str, Element]]:
    known = VOCABULARY[element.tag]
    for name in element.attributes:
        if name not in known.attributes and not name.startswith("xmlns"):
            yield f"{name} of <{element.tag}>", element
    for child in element.children:
        if child.tag in known.children:
            yield from _list_additions(child)
        elif (element.tag, child.tag) not in (("link", tag) for tag in _COPIED):
            yield f"<{child.tag}>", child


_LEVEL = 1e-9
"""Sine of the angle of a base that is not tilted; chosen, above rounding errors."""


def _put_on_world(robot: Robot, written: Written) -> Robot:
    """Return a robot whose tilted fixed base is on a link ``world``; other poses are reported.

    URDF has no pose of the robot, and gravity acts along the z axis of its root.
    """
    base, root = robot.base, robot.tree.root
    if robot.xml is not None or base is None or base.is_free or root is None:
        return robot
    pose = make_pose(base.origin)
    if pose == IDENTITY or root.name == WORLD:
        return robot
    if max(map(abs, pose.rotation[2][:2])) <= _LEVEL and pose.rotation[2][2] > 0:
        written.report_loss(
            "base-pose",
            f"the pose of the fixed base '{root.name}' in the world is dropped; it is level",
            base.place,
            kind="link",
            name=root.name,
            severity=Severity.INFO,
        )
        return robot
    taken = UniqueNames(joint.name for joint in robot.joints)
    name = taken.take(f"{root.name}_fixed")
    joint = Joint(base.provenance, name, "fixed", WORLD, root.name, origin=base.origin)
    links = [Link(base.provenance, WORLD), *robot.links]
    return replace(robot, links=links, joints=[joint, *robot.joints], base=None)


def _list_trees(robot: Robot) -> dict[str, Joint]:
    """Return the joint of each tree at the world, by its root link, if one of them is free."""
    world = robot.tree.root
    if robot.xml is not None or world is None or world.name != WORLD:
        return {}
    joints = robot.tree.get_child_joints(WORLD)
    if not any(joint.type == "floating" for joint in joints):
        return {}
    return {joint.child: joint for joint in joints}


def _report_others(robot: Robot, others: list[str], written: Written) -> None:
    """Report the trees that are left out."""
    if not others:
        return
    written.report_loss(
        "tree",
        f"bodies next to the robot are left out, since a URDF describes one: {len(others)} trees "
        f"that begin at {quote_first(others, 4)}; --root {others[0]} exports that one",
        robot.link[others[0]].place,
        kind="link",
        name=others[0],
    )


def _report_world(robot: Robot, written: Written) -> None:
    """Report the shapes of the world, which do not belong to a robot with a free base."""
    world = robot.link[WORLD]
    count = len(world.collisions) + len(world.visuals)
    if count:
        written.report_loss(
            "world-shape",
            f"{count} shapes of the world, such as its floor, are left out: the robot has a free "
            "base",
            world.place,
            kind="link",
            name=WORLD,
            severity=Severity.INFO,
        )
