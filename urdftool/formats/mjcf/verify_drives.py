"""Comparison of actuators: joint, gear, gain, control and force range."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...compare.check import Check
from ...model.elements import Joint
from ..common.actuator_config import JointSettings
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .declared_losses import LIMITS, TREE
from .verify_source import Source, is_locked

EXACT = 1e-9
DAMPING = 1e-6
"""Relative tolerance of MuJoCo's critical damping, computed from the mass matrix."""

STIFFEST = 250.0
"""Maximum natural frequency of a position servo with an assumed gain [rad/s]."""

_NO_LIMIT = 1e9
"""Effort or velocity that is written where there is no limit, but URDF requires a number."""

THREE_DIGITS = 6e-3
"""Relative change of a gain by rounding to three digits."""

WORDS = ("position", "velocity", "effort")


@dataclass(frozen=True)
class Wanted:
    """An actuator that the description or the options require.

    Attributes:
        kind: ``position``, ``velocity`` or ``motor``.
        gear: Ratio of joint effort to actuator force.
        gain: Gain of the servo [N·m/rad, N·m·s/rad, N/m or N·s/m]; 1 for a motor.
        bound: Control range; None if unlimited.
        damping: Velocity gain of a position servo; None for critical damping.
        force: Force range; None if unlimited.
        chosen: Whether the user chose the gain, which the inertia does not bound then.
    """

    kind: str
    gear: float
    gain: float
    bound: tuple[float, float] | None
    damping: float | None = None
    force: tuple[float, float] | None = None
    chosen: bool = False


def check_actuator(source: Source, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare the actuators with those that the description and the options require."""
    check = Check("actuators", "joint, kind, gear, gain, range of control and force", EXACT)
    model = compiled.model
    wanted = dict(_list_required(source))
    compiled.set_pose({})
    for number in range(model.nu):
        joint = compiled.name("JOINT", int(model.actuator_trnid[number][0]))
        if int(model.actuator_trntype[number]) != int(compiled.mujoco.mjtTrn.mjTRN_JOINT):
            joint = ""
        one = wanted.pop(joint, None)
        if one is None:
            name = compiled.name("ACTUATOR", number)
            check.compare(
                math.inf,
                f"actuator '{name}' drives '{joint}', which the description does not require",
            )
        else:
            _compare(number, joint, one, compiled, check)
    for joint in wanted:
        known = declared.has_for((*TREE, *LIMITS), joint)
        check.compare(math.inf, f"joint '{joint}' has no actuator", known=known)
    return check


def _compare(number: int, joint: str, wanted: Wanted, compiled: Compiled, check: Check) -> None:
    """Compare one actuator."""
    model = compiled.model
    about = f"actuator of joint '{joint}'"
    gear = [wanted.gear, 0, 0, 0, 0, 0]
    check.compare(_compute_apart(model.actuator_gear[number], gear), f"gear of {about}")
    kinds = {"motor": (0, 0), "position": (0, 1), "velocity": (0, 1)}
    found = int(model.actuator_gaintype[number]), int(model.actuator_biastype[number])
    if found != kinds[wanted.kind] or int(model.actuator_dyntype[number]) != 0:
        check.compare(math.inf, f"{about} is not a {wanted.kind}")
        return
    if compiled.name("ACTUATOR", number) != joint:
        check.compare(math.inf, f"{about} has another name")
    gain, bias = model.actuator_gainprm[number], model.actuator_biasprm[number]
    if wanted.kind == "position" and not wanted.chosen:
        compiled.set_pose(_get_at_home(compiled))
        most = STIFFEST**2 * compiled.get_moved_by(joint)[0]
        compiled.set_pose({})
        if wanted.gain > most > 0:  # the export rounds a bounded gain to three digits
            is_near = abs(gain[0] / most - 1) < THREE_DIGITS
            wanted = replace(wanted, gain=float(gain[0]) if is_near else most)
    check.compare(_compute_apart(gain[:3], [wanted.gain, 0, 0]), f"gain of {about}")
    opposed = {"motor": (0.0, 0.0), "position": (-wanted.gain, None), "velocity": (0, -wanted.gain)}
    position, velocity = opposed[wanted.kind]
    check.compare(_compute_apart(bias[:2], [0, position]), f"feedback of {about}")
    if wanted.damping is not None:
        velocity = -wanted.damping
    if velocity is not None:
        check.compare(_compute_apart(bias[2], velocity), f"damping of {about}")
    else:
        critical = [2 * math.sqrt(wanted.gain * mass) for mass in compiled.get_moved_by(joint)]
        off = min(abs(-bias[2] - each) / max(each, 1e-9) for each in critical)
        check.compare(off * EXACT / DAMPING, f"damping of {about}")
    bound = wanted.bound
    limited = bool(model.actuator_ctrllimited[number])
    if limited != (bound is not None):
        check.compare(math.inf, f"range of the control of {about}")
    elif bound is not None:
        off = _compute_apart(model.actuator_ctrlrange[number], bound)
        check.compare(off, f"range of the control of {about}")
    if bool(model.actuator_forcelimited[number]) != (wanted.force is not None):
        check.compare(math.inf, f"{about} has a different force limit")
    elif wanted.force is not None:
        off = _compute_apart(model.actuator_forcerange[number], wanted.force)
        check.compare(off, f"range of the force of {about}")


def _list_required(source: Source) -> Iterator[tuple[str, Wanted]]:
    """Yield the required actuator of each joint, by joint name."""
    choice = source.options.actuators
    said = dict(_list_described(source)) if choice == "auto" else {}
    for joint in source.robot.joints:
        if joint.type not in ("revolute", "continuous", "prismatic") or not source.moves(joint):
            continue
        if is_locked(joint):
            continue
        if _follows(source, joint):
            continue
        drive: tuple[str, float] | None = said.get(joint.name)
        if choice not in ("auto", "none"):
            drive = choice, 1.0
        settings = source.settings.get(joint.name, JointSettings())
        kind = settings.type or ("position" if settings.kp is not None else None)
        if kind is None and settings.kd is not None and (drive is None or drive[0] == "motor"):
            kind = "velocity"
        if kind is not None and (drive is None or drive[0] != kind):
            drive = kind, 1.0
        if drive is not None:
            yield joint.name, _get_configured(_drive(joint, *drive, settings.force_range), settings)


def _get_configured(wanted: Wanted, settings: JointSettings) -> Wanted:
    """Return an actuator with the gains that the user set."""
    wanted = replace(wanted, force=settings.force_range)
    if wanted.kind == "position":
        chosen = settings.kp is not None
        gain = wanted.gain if settings.kp is None else settings.kp
        return replace(wanted, gain=gain, damping=settings.kd, chosen=chosen)
    if wanted.kind == "velocity" and settings.kd is not None:
        return replace(wanted, gain=settings.kd, chosen=True)
    return wanted


def _get_at_home(compiled: Compiled) -> dict[str, float]:
    """Return the positions of hinges and slides in the key ``home``, by joint."""
    model, key = compiled.model, compiled.get_id("KEY", "home")
    return {
        compiled.name("JOINT", number): float(model.key_qpos[key][model.jnt_qposadr[number]])
        for number in range(model.njnt)
        if key >= 0 and model.jnt_type[number] >= 2
    }


def _list_described(source: Source) -> Iterator[tuple[str, tuple[str, float]]]:
    """Yield kind and gear by joint: from drive plugins, then transmissions, then ros2_control."""
    for plugin in source.drive_plugins:
        for element in plugin.walk():
            for name in element.text.replace(",", " ").split():
                part = source.robot.joint.get(name)
                if part is not None and part.type in ("revolute", "continuous", "prismatic"):
                    yield name, ("velocity" if _turns(part) else "position", 1.0)
    for transmission in source.robot.transmissions:
        gears = [a.mechanical_reduction for a in transmission.actuators if a.mechanical_reduction]
        for joint in transmission.joints:
            words = [*joint.hardware_interfaces]
            for actuator in transmission.actuators:
                words += actuator.hardware_interfaces
            kind = _format_kind(words)
            yield joint.name, (kind, gears[0] if gears and kind == "motor" else 1.0)
    for control in source.robot.ros2_controls:
        for component in control.joints:
            names = [interface.name for interface in component.command_interfaces]
            if names:
                yield component.name, (_format_kind(names), 1.0)


def _turns(joint: Joint) -> bool:
    """Tell whether a joint can rotate like a wheel, instead of steering."""
    limits = _collect_limits(joint)
    return limits is None or not -7.0 < limits[0] < limits[1] < 7.0


def _format_kind(interfaces: list[str]) -> str:
    for text in interfaces:
        last = text.lower().split("/")[-1]
        found = [word for word in WORDS if word in last]
        if found:
            return "motor" if found[0] == "effort" else found[0]
    return "motor"


def _follows(source: Source, joint: Joint) -> bool:
    if joint.mimic is None:
        return False
    return joint.mimic.joint != joint.name and joint.mimic.joint in source.robot.joint


def _collect_limits(joint: Joint) -> tuple[float, float] | None:
    if joint.type == "continuous" or joint.limit is None:
        return None
    return joint.limit.lower or 0.0, joint.limit.upper or 0.0


def _drive(
    joint: Joint, kind: str, gear: float, force: tuple[float, float] | None = None
) -> Wanted:
    """Create an actuator: gain from effort and velocity limits, range from joint limits."""
    effort = abs(joint.limit.effort or 0.0) if joint.limit else 0.0
    effort = max(map(abs, force)) if force is not None else effort
    velocity = abs(joint.limit.velocity or 0.0) if joint.limit else 0.0
    if not force and effort >= _NO_LIMIT:
        effort = 0.0
    velocity = velocity if velocity < _NO_LIMIT else 0.0
    slides = joint.type == "prismatic"
    if kind == "motor":
        bound = effort / abs(gear)
        return Wanted(kind, gear, 1.0, (-bound, bound) if effort else None)
    if kind == "position":
        gain = (100.0 if slides else 10.0) * (effort or 10.0)
        limits = _collect_limits(joint)
        return Wanted(kind, 1.0, gain, limits if limits and limits[0] < limits[1] else None)
    gain = 10.0 * effort / velocity if effort and velocity else (100.0 if slides else 10.0)
    return Wanted(kind, 1.0, gain, (-velocity, velocity) if velocity else None)


def _compute_apart(found: object, expected: object) -> float:
    one, other = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    return float(np.max(abs(one - other) / np.maximum(1.0, abs(other))))
