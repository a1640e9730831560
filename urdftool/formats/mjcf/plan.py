"""The robot that an export to MJCF writes: the source with every choice of the export.

The plan is a :class:`Robot`: base, values of joints, actuators, exclusions, home configuration and
settings of the world are chosen here, from the description and the options. The other modules
translate it, and the proof compares the file with it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ...finding import Finding
from ...model.elements import Axis, Joint, Limit, Link, Origin, Robot
from ...model.mechanism import Base, Configuration, Frame, JointActuator, Light
from ...model.pose import compute_norm, get_origin_at
from ...model.settings import Settings, Value, get_number
from ..common.base import decide_base
from ..common.base_pose import get_robot_origin
from ..common.holding_pose import choose_holding_positions
from ..common.home_positions import choose_home_positions
from ..common.joint_loads import JointLoad, compute_joint_loads
from ..common.open_loops import report_open_loops
from ..common.shape_box import ShapeBoxes
from ..common.srdf import read_srdf
from ..common.standing import measure_ground
from ..common.standing_pose import choose_standing_positions, report_support
from ..common.upright import turn_upright
from ..written import Written
from .actuator import plan_actuators
from .contact import plan_exclusions
from .copied import get_described_home, has_copied_home, has_copies
from .for_rl import add_rotors, find_feet, list_joint_sensors, set_foot_contact
from .gazebo import USUAL_FRICTION
from .home import Home, place_home
from .inertials import compute_inertials
from .joint import PLANAR_SUFFIXES, get_axis, get_plane, report_locked_joints
from .joint_settings import choose_joint_settings, set_joint_values
from .link_inertia import LinkInertia
from .loops import plan_closures
from .mounted import name_lights
from .options import Options
from .read_extras import REFERENCE
from .sensor import plan_sensors
from .structure import WORLD, ZERO_AXIS, Structure, create_structure

DIFFUSE, SPECULAR, CUTOFF = (0.7, 0.7, 0.7), (0.3, 0.3, 0.3), 45.0
"""MuJoCo's colors and half angle [°] of a light."""


@dataclass(frozen=True)
class Plan:
    """What an export writes."""

    name: str
    options: Options
    structure: Structure
    home: Home
    masses: dict[str, LinkInertia]
    boxes: ShapeBoxes
    wrong: list[Finding]

    @property
    def robot(self) -> Robot:
        """Return the robot with every choice of the export."""
        return self.structure.robot


def make_plan(robot: Robot, name: str, options: Options, written: Written) -> Plan:
    """Make every choice of an export.

    Raises:
        SourceError: The SRDF cannot be read.
        ConfigError: The SRDF has no such group state, or the actuator file is invalid.
        ModelError: The robot has no such joint, or it mimics another.
    """
    is_for_rl = options.purpose == "rl"
    packages = robot.source.packages if robot.source is not None else None
    srdf = read_srdf(options.srdf, robot, written, packages) if options.srdf else None
    keep_locked = options.keep_locked_joints or robot.format == "mjcf"  # which holds them itself
    structure = create_structure(robot, keep_locked=keep_locked)
    report_locked_joints(structure, written)
    boxes = ShapeBoxes(robot)
    home_of_source = get_described_home(robot, options)
    chosen = choose_home_positions(
        robot, options.pose, options.state, srdf, written, home_of_source
    )
    virtual_joint = srdf.virtual_joint if srdf else None
    base = options.base
    free, reason = decide_base(structure, base, virtual_joint, boxes, chosen.values, written)
    positions = chosen.values
    if free:
        upright = turn_upright(structure, boxes, positions, written)
        reason = reason if upright is robot else "it stands on its legs with y up"
        structure = replace(structure, robot=upright)
    if free or chosen.stands:
        positions = choose_standing_positions(structure, boxes, chosen, written)
    if free and robot.format != "mjcf":
        positions = choose_holding_positions(structure, boxes, chosen, positions, written)
    if free and robot.format != "mjcf":  # whose author chose the start
        report_support(structure, boxes, positions, written)
    structure = replace(structure, free=free, reason=reason)
    home = place_home(structure, boxes, positions)
    masses, wrong = compute_inertials(structure, options.fix_inertia, written, force=options.force)
    settings = choose_joint_settings(structure, options)
    if is_for_rl:
        structure = replace(structure, robot=add_rotors(structure, settings, written))
    ground = measure_ground(structure, boxes, positions, home.pose) if free else None
    bodies = {name: one.body for name, one in masses.items()}
    loads = compute_joint_loads(structure, bodies, home.positions, home.pose, ground)
    singular = {name for name, load in loads.items() if load.is_singular}
    if robot.format == "mjcf":  # whose author chose the armature
        singular = set()
    structure = replace(structure, robot=set_joint_values(structure, settings, singular, written))
    loads = _add_armatures(structure.robot, loads)
    sites = [
        Frame(joint.provenance, joint.name, joint.child, "site")
        for joint in structure.joints
        if joint.name in structure.locked
    ]
    frames = [*sites, *(frame for frame in robot.frames if frame.kind != "body")]
    sensors = plan_sensors(structure, frames, written, base=options.base_sensors)
    actuators, stops = plan_actuators(structure, options, loads, settings, ground, written)
    feet = find_feet(structure, ground, home.pose, home.positions) if is_for_rl else frozenset()
    if is_for_rl:
        driven = {actuator.joint for actuator in actuators}
        sensors.sensors += list_joint_sensors(structure, driven)
    links = [_set_priority(link, robot.format) for link in structure.robot.links]
    planned = replace(
        structure.robot,
        joints=_set_stops(_set_efforts(structure.robot, actuators), stops),
        frames=[*sensors.frames, *_list_body_frames(robot)],
        mounted_sensors=sensors.sensors,
        cameras=sensors.cameras,
        closures=plan_closures(structure, written),
        links=[set_foot_contact(link, feet) for link in links],
        base=None if structure.in_world else _plan_base(structure.robot, home, is_free=free),
        joint_actuators=actuators,
        exclusions=plan_exclusions(structure, srdf.disabled if srdf else (), options.exclude),
        configurations=_list_configurations(structure, positions, options),
        world=_choose_world(structure) | robot.world | _set_timestep(options),
    )
    structure = replace(structure, robot=planned)
    report_open_loops(planned, home.positions, written)
    return Plan(name, options, structure, home, masses, boxes, wrong)


def _list_body_frames(robot: Robot) -> list[Frame]:
    """Return the frames of bodies that are not at their joints."""
    return [frame for frame in robot.frames if frame.kind == "body"]


def _add_armatures(robot: Robot, loads: Mapping[str, JointLoad]) -> dict[str, JointLoad]:
    """Return what each joint moves, with its armature."""
    found = dict(loads)
    for joint in robot.joints:
        load, armature = loads.get(joint.name), joint.dynamics and joint.dynamics.armature
        if load is not None and armature:
            found[joint.name] = load.add_armature(armature)
    return found


def _set_efforts(robot: Robot, actuators: list[JointActuator]) -> list[Joint]:
    """Return the joints with the effort limits of their servos, which the model has.

    Of a URDF, a joint without limits that needs some and an effort of zero stay as they are: both
    are reported.
    """
    forces = {one.joint: max(map(abs, one.force_range)) for one in actuators
              if one.force_range is not None and robot.format != "mjcf"}  # fmt: skip
    joints = []
    for joint in robot.joints:
        limit = joint.limit
        if limit is None and joint.type == "continuous":
            limit = Limit(joint.provenance)
        elif limit is None and robot.format != "urdf":
            limit = Limit(joint.provenance, -math.inf, math.inf)
        if joint.name in forces and limit is not None and limit.effort != 0:
            joint = replace(joint, limit=replace(limit, effort=forces[joint.name]))
        joints.append(joint)
    return joints


def _set_stops(joints: list[Joint], stops: Mapping[str, Settings]) -> list[Joint]:
    """Return the joints with the settings of their stops."""
    return [
        replace(joint, settings=stops[joint.name] | joint.settings)
        if joint.name in stops
        else joint
        for joint in joints
    ]


def _list_configurations(
    structure: Structure, positions: Mapping[str, float], options: Options
) -> list[Configuration]:
    """Return the configurations of the model: ``home``, the start and those of keys of an MJCF."""
    robot = structure.robot
    has_keys = has_copies(robot, "keyframe")
    copied = [one for one in robot.configurations if has_keys or one.name == REFERENCE]
    if has_copied_home(robot, options):
        return copied
    own = Configuration(None, "home", _list_single(structure, positions))
    return [*(one for one in copied if one.name != own.name), own]


def _set_timestep(options: Options) -> Settings:
    """Return the setting of the time step that the user chose."""
    return {} if options.timestep is None else {"timestep": Value(None, options.timestep)}


def _plan_base(robot: Robot, home: Home, *, is_free: bool) -> Base:
    """Return the base; a free one stands on the floor."""
    origin = get_robot_origin(robot)
    if is_free:
        origin = replace(origin or Origin(), xyz=home.start.translation)
    return Base(robot.provenance if robot.base is None else robot.base.provenance, is_free, origin)


def _list_single(structure: Structure, positions: Mapping[str, float]) -> dict[str, float]:
    """Return the positions [rad or m] of the hinges and slides of the model, by name."""
    return {
        joint.name: positions.get(joint.name, 0.0)
        for joint in structure.moving
        if structure.is_single(joint)
    }


def _set_priority(link: Link, source: str) -> Link:
    """Return a link whose collisions with less than MuJoCo's friction have a ``priority``.

    MuJoCo uses the larger friction of two geoms unless one has priority, Gazebo the smaller.
    """
    if source == "mjcf":
        return _name_collisions(link)
    made: dict[int, Settings] = {}
    for surface in (link.surface, *(shape.surface for shape in link.collisions)):
        friction = get_number(surface, "friction")
        made[id(surface)] = surface
        if friction is not None and friction < USUAL_FRICTION:
            value = Value(surface["friction"].provenance, 1.0)
            made[id(surface)] = {"priority": value, **surface}
    return replace(
        link,
        surface=made[id(link.surface)],
        collisions=[replace(c, surface=made[id(c.surface)]) for c in link.collisions],
    )


def _name_collisions(link: Link) -> Link:
    """Return a link whose visuals leave their names to collisions, which pairs and sensors name."""
    touching = {shape.name for shape in link.collisions if shape.name}
    visuals = [
        replace(shape, name=f"{shape.name}_visual") if shape.name in touching else shape
        for shape in link.visuals
    ]
    return replace(link, visuals=visuals)


def _choose_world(structure: Structure) -> Settings:
    """Choose the integrator, and elliptic friction cones if a body is free.

    With pyramidal cones, Newton's method may stop before the forces converge if a heavy base on the
    ground carries light links, and velocities diverge: measured in MuJoCo 4.0 for 1 s on 13 free
    robots of example-robot-data, in three (TIAGo's) of them; in none with elliptic cones, at no
    higher cost.
    """
    if structure.robot.format == "mjcf":
        return {}
    world: Settings = {"integrator": Value(None, "implicitfast")}
    if structure.free or any(structure.get_kind(joint) == "free" for joint in structure.moving):
        world["cone"] = Value(None, "elliptic")
    return world


def convert_parts(plan: Plan) -> Robot:
    """Return the robot of a plan with the joints and lights that MuJoCo has for them."""
    robot = replace(plan.robot, lights=[*map(_complete_light, name_lights(plan.robot.lights))])
    return _move_floating(plan, _split_planar(robot))


def _complete_light(light: Light) -> Light:
    """Return a light with MuJoCo's values where none is written, and a direction of length 1."""
    aim = light.direction
    if aim is not None:
        length = compute_norm(aim)
        aim = (aim[0] / length, aim[1] / length, aim[2] / length)
    cutoff = math.radians(CUTOFF) if light.cutoff is None else light.cutoff
    return replace(
        light,
        direction=aim,
        diffuse=light.diffuse or DIFFUSE,
        specular=light.specular or SPECULAR,
        cutoff=cutoff if light.type == "spot" else None,
    )


def _move_floating(plan: Plan, robot: Robot) -> Robot:
    """Return a robot whose floating joints are children of the world, with the root."""
    structure = plan.structure
    moved = [
        replace(
            joint,
            parent=WORLD,
            origin=get_origin_at(
                plan.home.start @ structure.get_pose_at_zero(joint.child), joint.provenance
            ),
        )
        if joint.type == "floating" and joint.parent != WORLD
        else joint
        for joint in robot.joints
    ]
    if moved == robot.joints or structure.in_world:
        return replace(robot, joints=moved)
    root, is_free = structure.root.name, structure.free
    name, kind = (f"{root}_freejoint", "floating") if is_free else (f"{root}_fixed", "fixed")
    origin = get_origin_at(plan.home.start, robot.provenance)
    first = Joint(robot.provenance, name, kind, WORLD, root, origin=origin)
    links = [Link(robot.provenance, WORLD), *robot.links]
    return replace(robot, links=links, joints=[first, *moved], base=None)


def _split_planar(robot: Robot) -> Robot:
    """Return a robot with two slides and a hinge in place of each planar joint."""
    joints, links, planar = [], list(robot.links), dict[str, float]()
    for joint in robot.joints:
        if joint.type != "planar" or compute_norm(get_axis(joint)) < ZERO_AXIS:
            joints.append(joint)
            continue
        names = [joint.name + suffix for suffix in PLANAR_SUFFIXES]
        planar |= dict.fromkeys(names, 0.0)
        between = [f"{joint.child}~{number}" for number in (1, 2)]
        places = [joint.parent, *between, joint.child]
        links += [Link(joint.provenance, name, is_virtual=True) for name in between]
        for number, axis in enumerate(get_plane(get_axis(joint))):
            joints.append(
                replace(
                    joint,
                    name=names[number],
                    type="continuous" if number == 2 else "prismatic",
                    parent=places[number],
                    child=places[number + 1],
                    origin=joint.origin if number == 0 else None,
                    axis=Axis(joint.provenance, axis),
                    limit=None if number == 2 else Limit(joint.provenance, -math.inf, math.inf),
                )
            )
    states = [replace(one, positions=one.positions | planar) for one in robot.configurations]
    return replace(robot, links=links, joints=joints, configurations=states)
