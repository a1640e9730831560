"""Home of a robot in a stage: joint positions, the floor, and servos that hold both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.elements import Joint
from ...model.mechanism import JointActuator
from ...model.pose import Pose
from ..common.actuator_config import JointSettings
from ..common.drive_choice import AUTO, Drive, list_drives
from ..common.floor import NEAT, lift_to_floor
from ..common.holding_pose import choose_holding_positions
from ..common.home_positions import choose_home_positions
from ..common.joint_loads import JointLoad, compute_joint_loads
from ..common.open_loops import report_open_loops
from ..common.rigid_tree import RigidGroups, group_rigid_links
from ..common.servo_gains import (
    TIMESTEP,
    Gain,
    choose_position_gain,
    choose_velocity_gain,
    compute_kd,
    drop_unlimited,
    report_gains,
)
from ..common.shape_box import ShapeBoxes
from ..common.srdf import Srdf
from ..common.standing import Ground, measure_ground
from ..common.standing_pose import choose_standing_positions, report_support
from ..written import Written
from .bodies import Bodies, is_movable
from .inertials import BodyInertia
from .joint_values import list_single_joints
from .options import Options


@dataclass(frozen=True)
class Home:
    """Initial configuration of a robot.

    Attributes:
        positions: Joint positions [rad or m] by name.
        pose: Pose of the root at which a free robot stands on the floor z = 0.
        tree: The rigid bodies.
        ground: Geometry near the ground; None for a fixed base.
        loads: What each joint moves and holds, by name.
    """

    positions: Mapping[str, float]
    pose: Pose
    tree: RigidGroups
    ground: Ground | None
    loads: Mapping[str, JointLoad]


def plan_home(
    bodies: Bodies,
    inertias: Mapping[str, BodyInertia],
    options: Options,
    srdf: Srdf | None,
    written: Written,
) -> Home:
    """Choose the home of a robot.

    Raises:
        ConfigError: The SRDF has no such state.
        ModelError: A joint of the pose does not exist or mimics another.
    """
    robot = bodies.robot
    tree, boxes = group_rigid_links(robot, is_movable), ShapeBoxes(robot)
    chosen = choose_home_positions(robot, options.pose, options.state, srdf, written)
    positions, pose, ground = chosen.values, bodies.root_pose, None
    if bodies.free or chosen.stands:
        positions = choose_standing_positions(tree, boxes, chosen, written)
    if bodies.free:
        positions = choose_holding_positions(tree, boxes, chosen, positions, written)
        report_support(tree, boxes, positions, written)
        pose = lift_to_floor(tree, boxes, positions, pose)
        _report_height(bodies, pose.translation[2], written)
        ground = measure_ground(tree, boxes, positions, pose)
    report_open_loops(robot, positions, written)
    masses = {name: one.body for name, one in inertias.items()}
    loads = compute_joint_loads(tree, masses, positions, pose, ground)
    return Home(positions, pose, tree, ground, loads)


def _report_height(bodies: Bodies, height: float, written: Written) -> None:
    """Report the height of the root [m] at which a free robot stands on the floor."""
    place = bodies.root_pose.translation[2]
    if abs(height - place) < NEAT:
        return
    root = bodies.robot.tree.roots[0]
    written.report_loss(
        "start",
        f"the lowest point of the robot is at z = 0 if its root is at z = {height:g} m; the stage "
        f"has it at z = {place:g}: place the robot there, above the ground of the scene",
        root.place,
        kind="link",
        name=root.name,
        severity=Severity.INFO,
        data={"height": height},
    )


def plan_servos(
    bodies: Bodies,
    home: Home,
    options: Options,
    settings: Mapping[str, JointSettings],
    written: Written,
) -> list[JointActuator]:
    """Choose the servos of a robot; those of its source if that has actuators."""
    robot = bodies.robot
    if options.actuators in AUTO and (robot.joint_actuators or robot.format in ("mjcf", "usd")):
        _report_laws(bodies, written)
        return list(robot.joint_actuators)
    joints = list_single_joints(bodies)
    drives = list_drives(home.tree, joints, options.actuators, settings, home.ground, written)
    timestep = options.timestep or TIMESTEP
    assumed: dict[str, Gain] = {}
    made = []
    for drive in drives:
        own = settings.get(drive.joint.name, JointSettings())
        load = _add_armature(drive.joint, home.loads.get(drive.joint.name, JointLoad()), own)
        if own.kp is None and own.kd is None and drive.kind != "motor":
            made.append(_make_servo(drive, load, own, timestep, assumed))
    report_gains(robot, assumed, timestep, written)
    return made


def _report_laws(bodies: Bodies, written: Written) -> None:
    """Report actuators with a law that no drive has, and those of one joint, which are one drive.

    The force of a drive is kp · (target − position) + kd · (target velocity − velocity).
    """
    for actuator in bodies.robot.joint_actuators:
        if actuator.mode == "general":
            written.report_loss(
                "actuator",
                f"actuator '{actuator.name}' of joint '{actuator.joint}' is a drive with the gains "
                f"of its bias; its gain {actuator.gain:g} and constant bias {actuator.bias[0]:g} "
                "are dropped",
                actuator.place,
                kind="joint",
                name=actuator.joint,
            )
    for joint in list_single_joints(bodies):
        own = [one for one in bodies.robot.joint_actuators if one.joint == joint.name]
        if len(own) > 1:
            names = quote_first([one.name for one in own], 3)
            written.report_loss(
                "actuator",
                f"actuators {names} of joint '{joint.name}' are one drive, with the sum of their "
                "gains and force limits",
                own[0].place,
                kind="joint",
                name=joint.name,
            )


def _add_armature(joint: Joint, load: JointLoad, settings: JointSettings) -> JointLoad:
    armature = settings.armature
    if armature is None:
        armature = joint.get_resistance("armature")
    return load.add_armature(max(armature, 0.0))


def _make_servo(
    drive: Drive,
    load: JointLoad,
    settings: JointSettings,
    timestep: float,
    assumed: dict[str, Gain],
) -> JointActuator:
    """Choose the gains of a servo; a position servo is critically damped at home."""
    joint = drive.joint
    kind = "slide" if joint.type == "prismatic" else "hinge"
    force = settings.force_range
    effort = drop_unlimited(joint.get_magnitude("effort"))
    if force is not None:
        effort = max(map(abs, force))
    if drive.kind == "velocity":
        velocity = drop_unlimited(joint.get_magnitude("velocity")) or 0.0
        gain = choose_velocity_gain(kind, effort, velocity, load, timestep)
        kp, kd = 0.0, gain.value
    else:
        gain = choose_position_gain(kind, effort, load, timestep)
        kp, kd = gain.value, compute_kd(gain, load, timestep)
    assumed[joint.name] = gain
    return JointActuator(
        None,
        joint.name,
        joint.name,
        drive.kind,
        gain=gain.value,
        bias=(0.0, -kp, -kd),
        force_range=None if gain.force is None else (-gain.force, gain.force),
    )
