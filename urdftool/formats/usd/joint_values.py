"""Values of joints as they are written: those of the description, and of an actuator file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.drives import GAINS, list_servo_joints
from ...model.elements import Joint
from ...model.kinematics import MOVABLE
from ...model.mechanism import JointActuator
from ...model.settings import MAGNITUDES, RESISTANCE, RESISTANCE_OF_URDF
from ..common.actuator_config import JointSettings
from ..common.described_gains import choose_joint_settings
from ..common.missing_bounds import explain_negative_effort
from ..common.servo_gains import drop_unlimited
from ..written import Written
from .bodies import Bodies


@dataclass(frozen=True)
class JointValues:
    """Values of a joint in SI units, per radian for an angle; None for no limit.

    Attributes:
        effort: Largest force of the drive.
        velocity: Largest velocity.
        resistance: Values of ``RESISTANCE`` by name; the largest force of the drive limits none.
        kp: Force of the drive for each unit of position.
        kd: Force of the drive for each unit of velocity.
    """

    effort: float | None = None
    velocity: float | None = None
    resistance: Mapping[str, float] = field(default_factory=dict)
    kp: float = 0.0
    kd: float = 0.0


def list_single_joints(bodies: Bodies) -> list[Joint]:
    """List the joints that move with one degree of freedom."""
    return [j for j in bodies.joints if j.type in MOVABLE and bodies.is_movable(j)]


def read_joint_settings(bodies: Bodies, config: Path | None) -> dict[str, JointSettings]:
    """Read the settings of each joint with one degree of freedom, by name.

    Raises:
        ConfigError: The file is not valid, or has settings for a joint that does not move.
    """
    names = [joint.name for joint in list_single_joints(bodies)]
    return choose_joint_settings(bodies.robot, names, config)


def choose_joint_values(
    bodies: Bodies,
    settings: Mapping[str, JointSettings],
    servos: Sequence[JointActuator],
    written: Written,
) -> dict[str, JointValues]:
    """Choose the values of each joint with one degree of freedom, by name."""
    joints = list_single_joints(bodies)
    found = {}
    for joint in joints:
        own = [servo for servo in servos if servo.joint == joint.name]
        values = _choose(joint, _compute_gains(own), settings[joint.name], written)
        found[joint.name] = _bound(values, own)
    _report_missing_gains(bodies, joints, found, written)
    return found


def get_own_values(joint: Joint) -> JointValues:
    """Return the values of the description of a joint, without gains; none is negative."""
    written = {name: joint.get_magnitude(name) for name in MAGNITUDES}
    finite = {name: value for name, value in written.items() if value and math.isfinite(value)}
    if written["effort"] == 0:
        finite["effort"] = 0.0
    resistance = {row.name: joint.get_resistance(row.name) for row in RESISTANCE}
    return JointValues(**finite, resistance=resistance)


def _choose(
    joint: Joint, gains: tuple[float, float], settings: JointSettings, written: Written
) -> JointValues:
    kp, kd = gains
    plain = replace(get_own_values(joint), kp=kp, kd=kd)
    force = settings.force_range
    values = replace(
        plain,
        effort=plain.effort if force is None else max(map(abs, force)),
        kp=kp if settings.kp is None else settings.kp,
        kd=kd if settings.kd is None else settings.kd,
        resistance={**plain.resistance, **settings.list_resistance()},
    )
    _report_changes(joint, plain, values, written)
    if joint.limit is not None and (joint.limit.effort or 0) < 0:
        text, place = explain_negative_effort(joint), joint.limit.place
        written.report_loss("effort", text, place, kind="joint", name=joint.name)
    return _drop_zero_effort(joint, values, written)


def _drop_zero_effort(joint: Joint, values: JointValues, written: Written) -> JointValues:
    """Return the values of a joint without an effort limit of zero, which is reported."""
    if values.effort != 0 or joint.limit is None:
        return values
    written.report_loss(
        "effort",
        f"effort limit 0 of joint '{joint.name}' is not written: a drive with it applies nothing, "
        "and Newton rejects the stage",
        joint.limit.place,
        kind="joint",
        name=joint.name,
    )
    return replace(values, effort=None)


def _bound(values: JointValues, servos: Sequence[JointActuator]) -> JointValues:
    """Give a drive without an effort limit the force range of the servo of its joint."""
    if len(servos) != 1 or (force := servos[0].force_range) is None:
        return values
    if drop_unlimited(values.effort) is not None:
        return values
    return replace(values, effort=abs(servos[0].gear) * max(map(abs, force)))


def _compute_gains(servos: Sequence[JointActuator]) -> tuple[float, float]:
    """Return kp and kd of the actuators of one joint [per rad or m]."""
    kp = kd = 0.0
    for actuator in servos:
        square = actuator.gear * actuator.gear
        kp -= actuator.bias[1] * square
        kd -= actuator.bias[2] * square
    return max(kp, 0.0), max(kd, 0.0)


def _report_changes(
    joint: Joint, before: JointValues, after: JointValues, written: Written
) -> None:
    """Report values of the description that the actuator file replaces."""
    sides = [{"effort": one.effort, **one.resistance} for one in (before, after)]
    changed = [
        f"{name} {new:g} instead of {'none' if old is None else f'{old:g}'}"
        for name in ("effort", *RESISTANCE_OF_URDF)
        if (old := sides[0][name]) != (new := sides[1][name])
    ]
    if changed:
        written.report_loss(
            "actuator-config",
            f"joint '{joint.name}' has {', '.join(changed)}, from the actuator file",
            joint.place,
            kind="joint",
            name=joint.name,
            severity=Severity.INFO,
        )


def _report_missing_gains(
    bodies: Bodies, joints: list[Joint], values: dict[str, JointValues], written: Written
) -> None:
    """Report that drives have no gains; those of followers never have."""
    robot = bodies.robot
    open_ = [j.name for j in joints if j.mimic is None
             and not (values[j.name].kp or values[j.name].kd)]  # fmt: skip
    if not open_:
        return
    servos = [name for name in list_servo_joints(robot) if name in open_]
    text = (
        f"the drives of {len(open_)} joints have {' and '.join(GAINS)} 0, since the description "
        "has no gains: they apply the commanded effort"
    )
    if servos:
        text += (
            f"; {quote_first(servos, 3)} have a position or velocity interface, which needs gains"
        )
    written.report_loss(
        "gains",
        f"{text}; --actuator-config sets kp and kd",
        robot.place,
        severity=Severity.INFO,
    )
