"""Export of a robot to USD: stage, files and losses."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from pxr import Usd

from ...diagnostic import Severity
from ...lint.validate import validate
from ...model.elements import Joint, Limit, Robot
from ...model.kinematics import MOVABLE, follow_mimic_chain
from ...model.mechanism import Base, Configuration, ContactExclusion, JointActuator
from ...model.part import Part
from ...model.settings import SPRING, Setting
from ..common.naming import replace_file_name, shorten_file_name
from ..common.srdf import read_srdf
from ..common.unexpressed import (
    list_link_exclusions,
    report_blocks,
    report_looks,
    report_moved_frames,
    report_unexpressed,
    report_unwritten_settings,
)
from ..defects import FATAL, refuse, report_defects, report_size, report_taken_world
from ..written import Written
from .bodies import Bodies, make_bodies, report_floating
from .contacts import list_overlaps, write_pairs, write_self_collision
from .files import make_layered_files, make_single_file
from .home import plan_home, plan_servos
from .inertials import make_inertias
from .joint_values import JointValues, choose_joint_values, get_own_values, read_joint_settings
from .joints import JointWriter, report_unwritten_spring
from .links import LinkWriter
from .loops import write_closures, write_frames
from .materials import FOLDER, MaterialWriter
from .meshes import Meshes
from .names import Names, make_names
from .options import Options
from .shapes import ShapeWriter
from .stage import ISAAC, LAYERS, PHYSX, StageBuilder, apply, set_targets, set_value
from .surfaces import SurfaceWriter

_APPROXIMATIONS = {"hull": "convexHull", "mesh": "none"}


def write(robot: Robot, options: Options | None = None) -> Written:
    """Convert a robot to USD, without options with the defaults of the command line.

    Returns:
        The stage and its images, with every loss.

    Raises:
        Refused: The robot has report_defects that prevent the export; the error lists all of them.
        SourceError: The SRDF cannot be read.
    """
    options = options or Options()
    robot, world = report_taken_world(robot)
    name = _choose_name(robot)
    written = Written(options.file or get_stage_name(robot))
    found = [
        *([] if options.force else world),
        *report_defects(robot),
        *validate(robot, "export:usd"),
        *report_size(robot, "USD"),
    ]
    if any(finding.code in FATAL for finding in found):
        refuse(found, force=options.force)
    written.losses += world if options.force else []
    _report_losses(robot, written)
    packages = robot.source.packages if robot.source is not None else None
    srdf = read_srdf(options.srdf, robot, written, packages) if options.srdf else None
    bodies = make_bodies(robot, options.base, srdf.virtual_joint if srdf else None, written)
    report_floating(bodies, written)
    inertias, wrong = make_inertias(bodies, options, written)
    names = make_names(robot, name)
    written.renamed = names.renamed
    builder = _make_builder(names, options)
    materials = MaterialWriter(builder, robot, written)
    meshes = Meshes(builder, materials, written, _APPROXIMATIONS[options.approximation])
    found += [*wrong, *meshes.load(robot)]
    refuse(found, force=options.force)
    written.losses += found
    if options.decompose and options.cutter is not None:
        meshes.cut(robot, options.cutter)

    links = LinkWriter(builder, bodies, names)
    links.write(inertias)
    shapes = ShapeWriter(links, meshes, materials, SurfaceWriter(links, written), written)
    for link in robot.links:
        shapes.write(link)
    home = plan_home(bodies, inertias, options, srdf, written)
    settings = read_joint_settings(bodies, options.actuator_config)
    servos = plan_servos(bodies, home, options, settings, written)
    values = choose_joint_values(bodies, settings, servos, written)
    overlaps = list_overlaps(robot, options, home.positions, written)
    given = [*list_link_exclusions(robot, written), *overlaps]
    exclusions = [(pair.link, pair.other) for pair in given]
    pairs = [*exclusions, *(srdf.disabled if srdf else ())]
    planned = _make_planned(bodies, values, home.positions, pairs)
    joints = JointWriter(builder, bodies, names, options, values, home.positions, written)
    _write_joints(joints, links, options, planned)
    written.planned = planned
    _report_names(bodies, names, written)
    _finish(builder, robot, options, written)
    return written


def _make_builder(names: Names, options: Options) -> StageBuilder:
    kinds = [kind for kind in LAYERS
             if not (kind == PHYSX and not options.has_physx)
             and not (kind == ISAAC and options.target != "isaac")]  # fmt: skip
    return StageBuilder(names.robot, is_layered=options.layers == "payload", kinds=kinds)


def _write_joints(joints: JointWriter, links: LinkWriter, options: Options, planned: Robot) -> None:
    written, robot = joints.written, joints.bodies.robot
    joints.write()
    write_mimics(joints)
    write_closures(joints, written)
    write_frames(links, robot)
    report_moved_frames(robot, written)
    write_self_collision(links, options, written)
    write_pairs(links, planned.exclusions, options.proofs)
    if planned.exclusions:
        count = len(planned.exclusions)
        written.summary.append(f"{count} {'pair' if count == 1 else 'pairs'} without contact")
    for joint in robot.joints:
        report_unwritten_spring(joint, written)
    if options.target == "isaac":
        write_isaac(links, joints)


def _finish(builder: StageBuilder, robot: Robot, options: Options, written: Written) -> None:
    """Turn the stage into files."""
    if robot.name:
        builder.prim.SetCustomDataByKey("urdf:robot", robot.name)
    builder.prim.SetCustomDataByKey("urdf:root", robot.tree.roots[0].name)
    source = Path(robot.source.path).name if robot.source is not None else "a robot"
    images = {path: content for path, content in written.files.items() if path.startswith(FOLDER)}
    make = make_layered_files if options.layers == "payload" else make_single_file
    written.files = make(builder, written.main, source, images)


def get_stage_name(robot: Robot) -> str:
    """Return the name of the stage in a folder."""
    return f"{shorten_file_name(replace_file_name(_choose_name(robot)))}.usda"


def _choose_name(robot: Robot) -> str:
    """Return the robot's name; without one, that of its file."""
    if robot.name or robot.source is None:
        return robot.name or "robot"
    return Path(robot.source.path).name.partition(".")[0] or "robot"


def _report_names(bodies: Bodies, names: Names, written: Written) -> None:
    """Report each name that is not valid in USD."""
    for (kind, old), new in names.renamed.items():
        part = bodies.robot.link[old] if kind == "link" else bodies.robot.joint[old]
        written.report_loss(
            "name",
            f"{kind} '{old}' is prim '{new}', since USD does not allow the name or it is taken; "
            "the original is in its customData",
            part.place,
            kind=kind,
            name=old,
            severity=Severity.INFO,
        )


def write_isaac(links: LinkWriter, joints: JointWriter) -> None:
    """Apply the schemas of Isaac Sim; the first link is the base."""
    builder, bodies = links.builder, links.bodies
    order = sorted(bodies.links, key=lambda link: link.name != bodies.base)
    with builder.edit_layer(ISAAC):
        for link in order:
            _name(builder.stage.GetPrimAtPath(links.get_path(link.name)), "Link", link.name)
        written = [joint for joint in bodies.joints if joint.type != "floating"]
        for joint in written:
            _name(builder.stage.GetPrimAtPath(joints.get_path(joint.name)), "Joint", joint.name)
        apply(builder.prim, "IsaacRobotAPI")
        paths = [links.get_path(link.name) for link in order]
        set_targets(builder.prim, "isaac:physics:robotLinks", paths)
        root = builder.root.AppendPath("joints/root_joint")
        own = [root] if builder.stage.GetPrimAtPath(root) else []
        paths = [*own, *(joints.get_path(joint.name) for joint in written)]
        set_targets(builder.prim, "isaac:physics:robotJoints", paths)


def _name(prim: Usd.Prim, kind: str, name: str) -> None:
    apply(prim, f"Isaac{kind}API")
    if prim.GetName() != name:
        set_value(prim, "isaac:nameOverride", "string", name)


def write_mimics(writer: JointWriter) -> None:
    """Write each ``<mimic>`` whose follower and leader move; report the others."""
    bodies = writer.bodies
    movable = {j.name: j for j in bodies.joints if j.type in MOVABLE and bodies.is_movable(j)}
    for joint in bodies.robot.joints:
        if joint.mimic is None:
            continue
        reason = _find_obstacle(joint, movable)
        leader, factor, offset = joint.name, 1.0, 0.0
        if not reason:
            leader, factor, offset = follow_mimic_chain(joint, movable)
            follows = movable[leader].mimic
            if leader == joint.name or (follows is not None and follows.joint in movable):
                reason = "it follows itself"
        if reason:
            writer.written.report_loss(
                "mimic",
                f"<mimic> of joint '{joint.name}' is dropped: {reason}",
                joint.mimic.place,
                kind="joint",
                name=joint.name,
            )
        else:
            writer.write_mimic(joint, leader, factor, offset)


def _find_obstacle(joint: Joint, movable: dict[str, Joint]) -> str:
    """Return why a joint cannot follow its leader; empty if it can."""
    assert joint.mimic is not None
    if joint.name not in movable:
        return f"a joint of type {joint.type} has no position that could follow"
    if not joint.mimic.joint:
        return "it names no joint"
    if joint.mimic.joint not in movable:
        return f"joint '{joint.mimic.joint}' does not exist or has no position"
    return ""


_EXPRESSED = (
    "closure",
    "joint-actuator",
    "exclusion",
    "frame",
    "base",
    "joint-spring",
    "joint-armature",
    "setting",
)
"""Codes of parts of SDF and MJCF that an export to USD writes, or reports itself."""


def _report_losses(robot: Robot, written: Written) -> None:
    """Report each part that is not written."""
    report_unexpressed(robot, written, expressed=_EXPRESSED)
    report_unwritten_settings(robot, written, _is_written)
    report_blocks(robot, written)
    report_looks(robot, written)
    for code, what, part, name in _list_parts(robot):
        written.report_loss(
            code,
            f"{what} is not written",
            part.place,
            kind="joint" if name else "",
            name=name,
            severity=Severity.INFO,
        )


def _is_written(row: Setting) -> bool:
    """Tell whether an export writes a setting, or reports it itself."""
    return bool(row.usd) or row.name in (*SPRING, "self_collide")


def _list_parts(robot: Robot) -> Iterator[tuple[str, str, Part, str]]:
    for joint in robot.joints:
        if joint.safety_controller is not None:
            what = f"<safety_controller> of joint '{joint.name}'"
            yield "safety-controller", what, joint.safety_controller, joint.name
        if joint.calibration is not None:
            what = f"<calibration> of joint '{joint.name}'"
            yield "calibration", what, joint.calibration, joint.name
    for transmission in robot.transmissions:
        yield "transmission", f"transmission '{transmission.name}'", transmission, ""
    for control in robot.ros2_controls:
        yield "ros2-control", f"<ros2_control> '{control.name}'", control, ""
    inside = {id(plugin) for sensor in robot.sensors for plugin in sensor.plugins}
    for plugin in robot.plugins:
        if id(plugin) not in inside:
            yield "plugin", f"plugin '{plugin.filename or plugin.name}'", plugin, ""
    for sensor in robot.sensors:
        yield "sensor", f"sensor '{sensor.name}' of type {sensor.type}", sensor, ""


def _make_planned(
    bodies: Bodies,
    values: Mapping[str, JointValues],
    home: Mapping[str, float],
    pairs: Iterable[tuple[str, str]],
) -> Robot:
    """Return the robot with the chosen base, home, values and drives of joints, contact pairs."""
    robot = bodies.robot
    origin = None if robot.base is None else robot.base.origin
    return replace(
        robot,
        base=Base(robot.provenance, bodies.free, origin),
        joints=[_set_values(joint, values.get(joint.name)) for joint in robot.joints],
        joint_actuators=list(_make_drives(robot, values)),
        configurations=[Configuration(robot.provenance, "home", dict(home))],
        exclusions=list(_make_exclusions(bodies, pairs)),
    )


def _set_values(joint: Joint, values: JointValues | None) -> Joint:
    """Return a joint with the values that are not those of the description."""
    if values is None:
        return joint
    own = get_own_values(joint)
    joint = joint.replace_resistance({
        name: value for name, value in values.resistance.items() if value != own.resistance[name]
    })  # fmt: skip
    if values.effort != own.effort:
        unlimited = Limit(joint.provenance, -math.inf, math.inf)  # no bound that is missing is 0
        limit = replace(joint.limit or unlimited, effort=values.effort)
        joint = replace(joint, limit=limit)
    return joint


def _make_drives(robot: Robot, values: Mapping[str, JointValues]) -> Iterator[JointActuator]:
    """Yield the drives with gains; one without applies the commanded effort."""
    for joint in robot.joints:
        one = values.get(joint.name)
        if one is None or not (one.kp or one.kd):
            continue
        yield JointActuator(
            joint.provenance,
            joint.name,
            joint.name,
            "position" if one.kp else "velocity",
            gain=one.kp or one.kd,
            bias=(0.0, -one.kp, -one.kd),
            force_range=None if one.effort is None else (-one.effort, one.effort),
        )


def _make_exclusions(
    bodies: Bodies, pairs: Iterable[tuple[str, str]]
) -> Iterator[ContactExclusion]:
    """Yield the pairs of bodies of which links never collide, each once."""
    known: set[tuple[str, str]] = set()
    for one, other in pairs:
        first, second = sorted((bodies.carrier[one], bodies.carrier[other]))
        if first and second and first != second and (first, second) not in known:
            known.add((first, second))
            yield ContactExclusion(bodies.robot.provenance, first, second)
