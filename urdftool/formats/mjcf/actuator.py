"""Actuators: those of the source or description, and servos for the other joints.

URDF has no gains; ``common/servo_gains.py`` chooses them, and an actuator configuration file
overrides them. Position servos are critically damped for the inertia that the joint moves
(``dampratio``).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

from lxml import etree

from ...model.elements import Joint, Robot
from ...model.mechanism import JointActuator
from ...model.numbers import format_numbers_text, number_text
from ...model.settings import Settings, Value
from ..common.actuator_config import JointSettings
from ..common.drive_choice import AUTO, Drive, list_drives
from ..common.joint_loads import JointLoad
from ..common.servo_gains import (
    TIMESTEP,
    Gain,
    choose_position_gain,
    choose_velocity_gain,
    drop_unlimited,
    report_gains,
)
from ..common.standing import Ground
from ..written import Written
from .for_rl import replace_motors
from .joint import get_effort
from .options import Options
from .structure import Structure, get_bounds, get_locked_at

STOP_STEPS = 2.0
"""Time constant of a stop in time steps: the smallest that MuJoCo takes (documentation of
``solref``: "at least two times larger than the simulation timestep").
"""


def plan_actuators(
    structure: Structure,
    options: Options,
    loads: Mapping[str, JointLoad],
    settings: Mapping[str, JointSettings],
    ground: Ground | None,
    written: Written,
) -> tuple[list[JointActuator], dict[str, Settings]]:
    """Choose the actuators of a robot; those of its source if that is a model with actuators.

    Returns:
        The actuators, and settings that follow from their gains, by the name of the joint.
    """
    robot, single = structure.robot, list(filter(structure.is_single, structure.moving))
    if options.actuators in AUTO and (robot.joint_actuators or robot.format == "mjcf"):
        names = {joint.name for joint in single}
        return [one for one in robot.joint_actuators if one.joint in names], {}
    joints = [joint for joint in single if get_locked_at(joint) is None]
    drives = list_drives(structure, joints, options.actuators, settings, ground, written)
    if options.purpose == "rl":
        drives = list(replace_motors(drives, settings))
    timestep = options.timestep or TIMESTEP
    assumed: dict[str, Gain] = {}
    made = []
    for drive in drives:
        name, kind = drive.joint.name, structure.get_kind(drive.joint)
        load, chosen = loads.get(name, JointLoad()), settings.get(name, JointSettings())
        made.append(_plan_actuator(drive, kind, load, chosen, timestep, assumed))
    stops = _choose_stops(drives, assumed, timestep)
    remark = "the stops of these joints are as stiff as the step allows" if stops else ""
    report_gains(robot, assumed, timestep, written, remark=remark)
    return made, stops


def _choose_stops(
    drives: Iterable[Drive], assumed: Mapping[str, Gain], timestep: float
) -> dict[str, Settings]:
    """Choose the stops of joints with a position servo whose gain is assumed.

    The servo may be 100 times stiffer than MuJoCo's default stop, and would push it in.
    """
    stiff = Value(None, (STOP_STEPS * timestep, 1.0))
    return {
        drive.joint.name: {"limit_solref": stiff}
        for drive in drives
        if drive.kind == "position"
        and drive.joint.name in assumed
        and get_bounds(drive.joint) is not None
        and "limit_solref" not in drive.joint.settings
    }


def build_actuator_section(robot: Robot) -> etree._Element | None:
    """Build ``<actuator>`` with the actuators of a robot; None if it has none."""
    if not robot.joint_actuators:
        return None
    section = etree.Element("actuator")
    for actuator in robot.joint_actuators:
        section.append(_build_element(actuator, robot.joint[actuator.joint]))
    return section


def _plan_actuator(
    drive: Drive,
    kind: str,
    load: JointLoad,
    settings: JointSettings,
    timestep: float,
    assumed: dict[str, Gain],
) -> JointActuator:
    """Choose gains and ranges of an actuator."""
    joint = drive.joint
    made = JointActuator(None, joint.name, joint.name, drive.kind, force_range=settings.force_range)
    effort = drop_unlimited(get_effort(joint))
    if settings.force_range is not None:
        effort = max(map(abs, settings.force_range))
    if drive.kind == "position":
        gain, kd = settings.kp, settings.kd
        if gain is None:
            chosen = assumed[joint.name] = choose_position_gain(kind, effort, load, timestep)
            gain, kd = chosen.value, chosen.kd if kd is None else kd
            if chosen.force is not None:
                made = replace(made, force_range=(-chosen.force, chosen.force))
        limits = get_bounds(joint)
        bounds = limits if limits is not None and _is_range(*limits) else None
        bounds = settings.command_range or bounds
        ratio = 1.0 if kd is None else None
        bias = (0.0, -gain, -(kd or 0.0))
        return replace(made, gain=gain, bias=bias, damping_ratio=ratio, control_range=bounds)
    if drive.kind == "velocity":
        velocity = drop_unlimited(joint.get_magnitude("velocity")) or 0.0
        gain = settings.kd
        if gain is None:
            chosen = choose_velocity_gain(kind, effort, velocity, load, timestep)
            assumed[joint.name] = chosen
            gain = assumed[joint.name].value
        bounds = settings.command_range or ((-velocity, velocity) if velocity else None)
        return replace(made, gain=gain, bias=(0.0, 0.0, -gain), control_range=bounds)
    bound = effort / abs(drive.reduction) if effort else 0.0
    return replace(made, gear=drive.reduction, control_range=(-bound, bound) if bound else None)


def _is_range(lower: float, upper: float) -> bool:
    """Tell whether two limits are those of a range; MuJoCo has none that is infinite."""
    return lower < upper and math.isfinite(lower) and math.isfinite(upper)


def _build_element(actuator: JointActuator, joint: Joint) -> etree._Element:
    """Build the element of an actuator."""
    element = etree.Element(actuator.mode, name=actuator.name or joint.name, joint=joint.name)
    if actuator.gear != 1.0:
        element.set("gear", number_text(actuator.gear))
    if actuator.force_range is not None:
        element.set("forcerange", format_numbers_text(actuator.force_range))
    if actuator.mode == "position":
        element.set("kp", number_text(actuator.gain))
        if actuator.damping_ratio is not None:
            element.set("dampratio", number_text(actuator.damping_ratio))
        elif actuator.bias[2]:
            element.set("kv", number_text(-actuator.bias[2]))
    elif actuator.mode == "velocity":
        element.set("kv", number_text(actuator.gain))
    elif actuator.mode == "general":
        element.set("gainprm", number_text(actuator.gain))
        element.set("biastype", "affine")
        element.set("biasprm", format_numbers_text(actuator.bias))
    if actuator.control_range is None:
        return element
    if actuator.mode == "position" and actuator.control_range == get_bounds(joint):
        element.set("inheritrange", "1")
    else:
        element.set("ctrlrange", format_numbers_text(actuator.control_range))
    return element
