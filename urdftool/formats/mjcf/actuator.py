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


def build_actuator_section(
    structure: Structure,
    actuators: Actuators,
    inertias: Mapping[str, float],
    settings: Mapping[str, JointSettings],
    written: Written,
) -> tuple[etree._Element | None, list[Drive]]:
    """Build ``<actuator>``; None if it is empty. Also return the drives in its order.

    Args:
        structure: The kinematic tree.
        actuators: Kind of actuators that the user chose.
        inertias: Inertia that each joint moves at home, with its armature [kg·m² or kg].
        settings: Settings by joint name, from the user.
        written: Receives losses and the assumed gains.
    """
    drives = list(_list_drives(structure, actuators, settings, written))
    if not drives:
        return None, []
    section = etree.Element("actuator")
    assumed: dict[str, Gain] = {}
    for drive in drives:
        own = settings.get(drive.joint.name, JointSettings())
        section.append(_build_element(structure, drive, inertias, own, assumed))
    if assumed:
        _report_assumed_gains(structure.robot, assumed, written)
    return section, drives


def _list_drives(
    structure: Structure,
    actuators: Actuators,
    settings: Mapping[str, JointSettings],
    written: Written,
) -> Iterator[Drive]:
    said = dict(_list_described(structure.robot, written)) if actuators == "auto" else {}
    for joint in structure.moving:
        if structure.get_kind(joint) not in ("hinge", "slide") or get_locked_at(joint) is not None:
            continue
        drive = None
        if actuators == "auto":
            if joint.name in said:
                kind, reduction = said[joint.name]
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


def _build_element(
    structure: Structure,
    drive: Drive,
    inertias: Mapping[str, float],
    settings: JointSettings,
    assumed: dict[str, Gain],
) -> etree._Element:
    joint, kind = drive.joint, structure.get_kind(drive.joint)
    effort = _drop_unlimited(get_effort(joint))
    inertia = inertias.get(joint.name, 0.0)
    element = etree.Element(drive.kind, name=joint.name, joint=joint.name)
    if settings.force_range is not None:
        effort = max(map(abs, settings.force_range))
        element.set("forcerange", format_numbers_text(settings.force_range))
    if drive.kind == "position":
        stiffness = settings.kp
        if stiffness is None:
            assumed[joint.name] = position_gain(kind, effort, inertia)
            stiffness = assumed[joint.name].value
        element.set("kp", number_text(stiffness))
        if settings.kd is None:
            element.set("dampratio", "1")
        else:
            element.set("kv", number_text(settings.kd))
        limits = get_bounds(joint)
        if limits is not None and limits[0] < limits[1]:
            element.set("inheritrange", "1")
    elif drive.kind == "velocity":
        limit = None if joint.limit is None else joint.limit.velocity
        velocity = abs(_drop_unlimited(limit) or 0.0)
        damping = settings.kd
        if damping is None:
            assumed[joint.name] = choose_velocity_gain(kind, effort, velocity)
            damping = assumed[joint.name].value
        element.set("kv", number_text(damping))
        if velocity:
            element.set("ctrlrange", format_numbers_text((-velocity, velocity)))
    else:
        if drive.reduction != 1.0:
            element.set("gear", number_text(drive.reduction))
        if effort:
            bound = effort / abs(drive.reduction)
            element.set("ctrlrange", format_numbers_text((-bound, bound)))
    return element


UNLIMITED = 1e9
"""Effort and velocity that stand for no limit, as ``export urdf`` writes them."""


def _drop_unlimited(value: float | None) -> float | None:
    return None if value is None or abs(value) >= UNLIMITED else value


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
