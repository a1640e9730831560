"""Gains and force ranges of servos, which URDF does not have: chosen from limits and inertia.

A servo holds the robot at home: full effort at a small error, and enough stiffness that the robot
does not tip over. The stiffness k of a servo that a simulator integrates explicitly is bounded by
the inertia M that the joint moves and the time step Δt: k ≤ M/Δt². In a chain, M is that with the
other joints free, unless the ground carries the end of the chain. With damping that is critical for
the same M, which MuJoCo integrates implicitly, such a servo does not oscillate, at 5 ms either.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.elements import Robot
from ...model.kinematics import UNLIMITED
from ..written import Written
from .joint_loads import JointLoad

TIMESTEP = 0.002
"""Physics time step [s] for which gains are bounded by default: MuJoCo's default."""

PART = 1.0
"""Maximum position gain as a fraction of M/Δt². Of 63 robots of example-robot-data, 62 hold still
for 2 s at 2 ms with the four gains 0.25, 0.5, 1 and 2 at this one, the most."""

LONGER = 2.5
"""Ratio of the longest step at which servos must not diverge to the one that is written: 5 to 2 ms.

With implicit damping, servos with gains K and damping D are stable at a step h if
h² K < 4 M + 2 h D (in matrices, M the mass matrix). With D critical for the free inertia F of each
joint, this holds for every M if K ≤ (4/LONGER)² F/Δt² and h ≤ LONGER Δt; with D critical for the
held inertia, which bounds K as well, up to 4 Δt.

MuJoCo couples mimic joints without the implicit damping of the servo, at a longer step the weaker:
a servo that others follow has the gain for the longest step.
"""

POSITION_GAIN = {"hinge": 40.0, "slide": 400.0}
"""Ratio of position gain to effort limit [1/rad or 1/m]: full effort at 0.025 rad or 2.5 mm. From
the same trial: 10 and 100 let 10 of 31 robots with a free base tip over."""

VELOCITY_GAIN = 10.0
"""Ratio of velocity gain to effort/velocity: full effort at a tenth of the velocity limit. Chosen,
no source."""

FREQUENCY = 20.0
"""Angular frequency [rad/s] of a servo without an effort limit; chosen, no source."""

SAG = 0.01
"""Error [rad or m] with which a servo without an effort limit holds the load at home; chosen, no
source."""

FULL = {"hinge": 0.1, "slide": 0.01}
"""Error [rad or m] at which a servo without an effort limit applies its full force; chosen, no
source."""

PLAIN_GAIN = {
    "position": {"hinge": 100.0, "slide": 1000.0},
    "velocity": {"hinge": 10.0, "slide": 100.0},
}
"""Gains for joints without an effort limit that move nothing with mass."""


@dataclass(frozen=True)
class Gain:
    """A gain that is assumed.

    Attributes:
        value: The gain.
        is_bounded: Whether the inertia bounds it.
        force: Force limit [N·m or N] that is assumed with it; None if the joint has one, or if
            nothing is known to derive it from.
        sag: Error [rad or m] with which the servo holds the load at home.
        kd: Damping [N·m·s/rad or N·s/m] of a position servo that is critical while the other
            joints do not move, for a gain that would else diverge at a longer step; None for
            critical damping while they are free.
        is_weak: Whether the effort limit is below the load at home.
        is_carried: Whether the ground carries what the joint moves.
    """

    value: float
    is_bounded: bool = False
    force: float | None = None
    sag: float = 0.0
    kd: float | None = None
    is_weak: bool = False
    is_carried: bool = False


def choose_position_gain(
    kind: str, effort: float | None, load: JointLoad, timestep: float = TIMESTEP
) -> Gain:
    """Choose the gain of a position servo [N·m/rad or N/m].

    The effort limit is in N·m or N, the time step in s.
    """
    longest = timestep * (LONGER if load.is_followed else 1.0)
    most = PART * (load.reduced or load.inertia) / longest**2
    if effort:
        desired = max(effort * POSITION_GAIN[kind], load.stiffness)
    elif most > 0:
        desired = _round(max(load.inertia * FREQUENCY**2, load.force / SAG, load.stiffness))
    else:
        return Gain(PLAIN_GAIN["position"][kind])
    is_bounded = 0 < most < desired
    value = _round(most) if is_bounded else desired
    force = None if effort else _round(max(value * FULL[kind], 2 * load.force))
    is_stiff = load.is_carried and value > (4 / LONGER) ** 2 * load.free / timestep**2
    kd = _round(2 * math.sqrt(value * load.inertia)) if is_stiff else None
    if effort and load.force > effort and not load.is_carried:  # by the ground
        return Gain(value, is_bounded, force, kd=kd, is_weak=True)
    return Gain(value, is_bounded, force, load.force / value, kd, is_carried=load.is_carried)


def compute_kd(gain: Gain, load: JointLoad, timestep: float = TIMESTEP) -> float:
    """Compute the damping of a position servo [N·m·s/rad or N·s/m].

    It is critical for the inertia that the joint moves while the other joints are free, for which
    MuJoCo computes ``dampratio``, or that of the gain.

    Args:
        gain: From :func:`choose_position_gain`.
        load: What the joint moves, with its armature.
        timestep: Physics time step [s], for a joint that moves nothing with mass.
    """
    if gain.kd is not None:
        return gain.kd
    inertia = load.free or load.inertia or gain.value * timestep**2
    return 2 * math.sqrt(gain.value * inertia)


def choose_velocity_gain(
    kind: str,
    effort: float | None,
    velocity: float,
    load: JointLoad,
    timestep: float = TIMESTEP,
) -> Gain:
    """Choose the gain of a velocity servo [N·m·s/rad or N·s/m].

    The effort limit is in N·m or N, the velocity limit in rad/s or m/s (0: none).
    """
    if effort and velocity:
        return Gain(effort * VELOCITY_GAIN / velocity)
    desired, most = PLAIN_GAIN["velocity"][kind], PART * load.inertia / timestep
    if effort or not 0 < most < desired:
        return Gain(desired)
    return Gain(_round(most), is_bounded=True)


def report_gains(
    robot: Robot,
    assumed: Mapping[str, Gain],
    timestep: float,
    written: Written,
    *,
    remark: str = "",
) -> None:
    """Report that gains are assumed, which of them inertia bounds, and the sag at home."""
    if not assumed:
        return
    servos = "1 servo" if len(assumed) == 1 else f"{len(assumed)} servos"
    text = f"gains of {servos} are assumed, because the description has none"
    forces = [name for name, gain in assumed.items() if gain.force is not None]
    if forces:
        text += (
            "; without an effort limit, they follow from inertia and load, also the force range, "
            f"for {quote_first(forces, 3)}"
        )
    bounded = [name for name, gain in assumed.items() if gain.is_bounded]
    if bounded:
        text += (
            f"; the inertia M at home and Δt = {timestep * 1000:g} ms bound them to at most "
            f"{PART:g} M/Δt² for {quote_first(bounded, 3)}"
        )
    most = max(assumed, key=lambda name: assumed[name].sag)
    sag = assumed[most].sag
    if sag > 0:
        text += f"; at home, at rest, they sag by at most {sag:.2g} (joint '{most}')"
        if assumed[most].is_carried:
            text += "; on the ground, the robot may rock by more, which --verify steps"
    weak = [name for name, gain in assumed.items() if gain.is_weak]
    if weak:
        written.advice.append(
            "the load at home is above the effort limit, so that the servo does not hold it: "
            f"{quote_first(weak, 3)}"
        )
    written.report_loss(
        "gains",
        f"{text}{remark and f'; {remark}'}; --actuator-config sets others",
        robot.place,
        severity=Severity.INFO,
        data={
            "timestep": timestep,
            "sag": sag,
            "joint": most if sag > 0 else "",
            "weak": weak,
            "names": forces,
        },
    )


def _round(value: float) -> float:
    """Round to three digits: a chosen value has no more."""
    return float(f"{value:.3g}")


def drop_unlimited(value: float | None) -> float | None:
    """Return a limit; None if it stands for no limit."""
    return None if value is None or abs(value) >= UNLIMITED else value
