"""Actuators: from transmissions, ros2_control and drive plugins, or one kind for every joint.

URDF has no gains; this module chooses them, and an actuator configuration file overrides them.
Position servos are critically damped for the inertia that the joint moves (``dampratio``).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from lxml import etree

from ...diagnostic import Severity
from ...model.drives import get_actuator_kind, get_plugin_drives
from ...model.elements import Joint, Robot
from ...model.mechanism import JointActuator
from ..common.actuator_config import JointSettings
from ..written import Written
from .digits import format_numbers_text, number_text
from .equality import follows
from .joint import get_effort
from .options import Actuators
from .structure import Structure, get_bounds, get_locked_at


@dataclass(frozen=True)
class Drive:
    """Actuator of a joint: ``position``, ``velocity`` or ``motor``, with its gear reduction."""

    joint: Joint
    kind: str
    reduction: float = 1.0


def plan_actuators(
    structure: Structure,
    actuators: Actuators,
    inertias: Mapping[str, float],
    settings: Mapping[str, JointSettings],
    written: Written,
) -> list[JointActuator]:
    """Choose the actuators of a robot; those of its source if it has some.

    Args:
        structure: The kinematic tree.
        actuators: Kind of actuators that the user chose.
        inertias: Inertia that each joint moves at home, with its armature [kg·m² or kg].
        settings: Settings by joint name, from the user.
        written: Receives losses and the assumed gains.
    """
    kinds = {joint.name: structure.get_kind(joint) for joint in structure.moving}
    if structure.robot.joint_actuators and actuators == "auto":
        return [a for a in structure.robot.joint_actuators if kinds.get(a.joint) in SINGLE]
    assumed: dict[str, Gain] = {}
    made = []
    for drive in _list_drives(structure, actuators, settings, written):
        own = settings.get(drive.joint.name, JointSettings())
        name = drive.joint.name
        made.append(_plan_actuator(drive, kinds[name], inertias.get(name, 0.0), own, assumed))
    if assumed:
        _report_assumed_gains(structure.robot, assumed, written)
    return made


def build_actuator_section(robot: Robot) -> etree._Element | None:
    """Build ``<actuator>`` with the actuators of a robot; None if it has none."""
    if not robot.joint_actuators:
        return None
    section = etree.Element("actuator")
    for actuator in robot.joint_actuators:
        section.append(_build_element(actuator, robot.joint[actuator.joint]))
    return section


def _list_drives(
    structure: Structure,
    actuators: Actuators,
    settings: Mapping[str, JointSettings],
    written: Written,
) -> Iterator[Drive]:
    described = dict(_list_described(structure.robot, written)) if actuators == "auto" else {}
    for joint in structure.moving:
        if structure.get_kind(joint) not in SINGLE or get_locked_at(joint) is not None:
            continue
        drive = None
        if actuators == "auto":
            if joint.name in described:
                kind, reduction = described[joint.name]
                drive = Drive(joint, kind, reduction)
        elif actuators != "none":
            drive = Drive(joint, actuators)
        drive = _get_chosen(joint, drive, settings.get(joint.name, JointSettings()))
        if drive is None:
            continue
        if follows(structure, joint):
            if actuators == "auto":
                _report_follower(joint, written)
            continue
        yield drive


def _get_chosen(joint: Joint, drive: Drive | None, settings: JointSettings) -> Drive | None:
    """Return the drive of a joint after applying the user's settings."""
    kind = settings.type
    if kind is None and settings.kp is not None:
        kind = "position"
    if kind is None and settings.kd is not None and (drive is None or drive.kind == "motor"):
        kind = "velocity"
    if kind is None or (drive is not None and drive.kind == kind):
        return drive
    return Drive(joint, kind) if drive is None else replace(drive, kind=kind, reduction=1.0)


def _report_follower(joint: Joint, written: Written) -> None:
    assert joint.mimic is not None
    written.report_loss(
        "mimic-actuator",
        f"joint '{joint.name}' mimics '{joint.mimic.joint}' and gets no actuator",
        joint.place,
        kind="joint",
        name=joint.name,
        severity=Severity.INFO,
    )


def _report_assumed_gains(robot: Robot, assumed: Mapping[str, Gain], written: Written) -> None:
    """Report assumed gains, and those that the inertia bounds."""
    bounded = [f"'{name}'" for name, gain in assumed.items() if gain.is_bounded]
    text = (
        f"gains of {len(assumed)} servos are assumed, because URDF has none: 10 times the "
        "effort limit"
    )
    if bounded:
        more = f" and {len(bounded) - 3} more" if len(bounded) > 3 else ""
        text += (
            f", and at most {PART:g} M/Δt² of the inertia M at home at Δt = "
            f"{TIMESTEP * 1000:g} ms, which bounds {', '.join(bounded[:3])}{more}"
        )
    written.report_loss(
        "gains",
        f"{text}; --actuator-config sets others",
        robot.place,
        severity=Severity.INFO,
    )


def _list_described(robot: Robot, written: Written) -> Iterator[tuple[str, tuple[str, float]]]:
    """Yield kind and reduction of each joint that the description drives; the last wins."""
    for name, kind in get_plugin_drives(robot).items():
        yield name, (kind, 1.0)
    for transmission in robot.transmissions:
        reductions = [a.mechanical_reduction for a in transmission.actuators]
        reduction = next((r for r in reductions if r), 1.0)
        for joint in transmission.joints:
            if joint.name not in robot.joint:
                written.report_loss(
                    "transmission",
                    f"transmission '{transmission.name}' is of joint '{joint.name}', which "
                    "does not exist",
                    joint.place,
                    kind="transmission",
                    name=transmission.name,
                )
                continue
            names = [*joint.hardware_interfaces]
            names += [name for a in transmission.actuators for name in a.hardware_interfaces]
            kind = get_actuator_kind(names)
            if "simple" not in transmission.type.lower() and transmission.type:
                written.report_loss(
                    "transmission",
                    f"transmission '{transmission.name}' of type {transmission.type} is written as "
                    "one actuator a joint",
                    transmission.place,
                    kind="transmission",
                    name=transmission.name,
                )
            yield joint.name, (kind, reduction if kind == "motor" else 1.0)
    for block in robot.ros2_controls:
        for component in block.joints:
            names = [interface.name for interface in component.command_interfaces]
            if names and component.name in robot.joint:
                yield component.name, (get_actuator_kind(names), 1.0)


def _plan_actuator(
    drive: Drive,
    kind: str,
    inertia: float,
    settings: JointSettings,
    assumed: dict[str, Gain],
) -> JointActuator:
    """Choose gains and ranges of an actuator.

    Args:
        drive: Its joint and kind.
        kind: ``hinge`` or ``slide``.
        inertia: Inertia that the joint moves [kg·m² or kg].
        settings: Settings from the user.
        assumed: Receives the gains that are assumed.
    """
    joint = drive.joint
    made = JointActuator(None, joint.name, joint.name, drive.kind, force_range=settings.force_range)
    effort = _drop_unlimited(get_effort(joint))
    if settings.force_range is not None:
        effort = max(map(abs, settings.force_range))
    if drive.kind == "position":
        gain = settings.kp
        if gain is None:
            assumed[joint.name] = position_gain(kind, effort, inertia)
            gain = assumed[joint.name].value
        limits = get_bounds(joint)
        bounds = limits if limits is not None and limits[0] < limits[1] else None
        ratio = 1.0 if settings.kd is None else None
        bias = (0.0, -gain, -(settings.kd or 0.0))
        return replace(made, gain=gain, bias=bias, damping_ratio=ratio, control_range=bounds)
    if drive.kind == "velocity":
        limit = None if joint.limit is None else joint.limit.velocity
        velocity = abs(_drop_unlimited(limit) or 0.0)
        gain = settings.kd
        if gain is None:
            assumed[joint.name] = choose_velocity_gain(kind, effort, velocity)
            gain = assumed[joint.name].value
        bounds = (-velocity, velocity) if velocity else None
        return replace(made, gain=gain, bias=(0.0, 0.0, -gain), control_range=bounds)
    bound = effort / abs(drive.reduction) if effort else 0.0
    return replace(made, gear=drive.reduction, control_range=(-bound, bound) if bound else None)


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


UNLIMITED = 1e9
"""Effort and velocity that stand for no limit, as ``export urdf`` writes them."""


def _drop_unlimited(value: float | None) -> float | None:
    return None if value is None or abs(value) >= UNLIMITED else value


SINGLE = ("hinge", "slide")
"""Kinds of joints with one position, which actuators drive."""

TIMESTEP = 0.002
"""Physics time step [s] for which gains are bounded: MuJoCo's default."""

PART = 0.25
"""Maximum position gain as a fraction of M/Δt²."""

POSITION_GAIN = {"hinge": 10.0, "slide": 100.0}
"""Ratio of position gain to effort limit [1/rad or 1/m]: full effort at 0.1 rad or 1 cm."""

VELOCITY_GAIN = 10.0
"""Ratio of velocity gain to effort/velocity: full effort at a tenth of the velocity limit."""

PLAIN_GAIN = {
    "position": {"hinge": 100.0, "slide": 1000.0},
    "velocity": {"hinge": 10.0, "slide": 100.0},
}
"""Gains for joints without an effort limit."""


@dataclass(frozen=True)
class Gain:
    """A gain, and whether the inertia bounds it."""

    value: float
    is_bounded: bool


def position_gain(kind: str, effort: float | None, inertia: float) -> Gain:
    """Choose the gain of a position servo [N·m/rad or N/m].

    Args:
        kind: ``hinge`` or ``slide``.
        effort: The effort limit [N·m or N], if any.
        inertia: The inertia that the joint moves, with its armature [kg·m² or kg].
    """
    wanted = effort * POSITION_GAIN[kind] if effort else PLAIN_GAIN["position"][kind]
    most = PART * inertia / TIMESTEP**2
    if wanted <= most or most <= 0:
        return Gain(wanted, is_bounded=False)
    return Gain(float(f"{most:.3g}"), is_bounded=True)


def choose_velocity_gain(kind: str, effort: float | None, velocity: float) -> Gain:
    """Choose the gain of a velocity servo [N·m·s/rad or N·s/m].

    Args:
        kind: ``hinge`` or ``slide``.
        effort: The effort limit [N·m or N], if any.
        velocity: The velocity limit [rad/s or m/s]; 0 for none.
    """
    wanted = PLAIN_GAIN["velocity"][kind]
    if effort and velocity:
        wanted = effort * VELOCITY_GAIN / velocity
    return Gain(wanted, is_bounded=False)
