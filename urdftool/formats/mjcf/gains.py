"""Gains that a description does not have: from the effort, within what the time step allows.

A servo asks for the whole effort of its joint at a small error. Many descriptions have a
placeholder as effort, and a servo of 10 times that would be stiffer than any time step can
integrate. So a gain is bounded by the inertia M that the joint moves at home: the servo swings at
250 rad/s at most, which is M/Δt² / 4 at MuJoCo's time step of 2 ms, and 1.56 M/Δt² at 5 ms.

Measured in MuJoCo 4.0 with ``implicitfast`` and critical damping, on the 104 robots of
example-robot-data and pybullet_data that have joints, without contacts, at 2 ms and 5 ms: with
gains of up to 1.56 M/(5 ms)² all but two hold still, which do not have the effort for it; six do
not at 4, seventeen at 16, and twenty-one without a bound. Velocity servos, which ``implicitfast``
integrates implicitly, are stable up to 1000 M/Δt: they need no bound.
"""

from __future__ import annotations

from dataclasses import dataclass

TIMESTEP = 0.002
"""Physics time step [s] for which gains are bounded: MuJoCo's default."""

PART = 0.25
"""The largest position gain, as a part of M/Δt²."""

POSITION_GAIN = {"hinge": 10.0, "slide": 100.0}
"""Gain of a position servo over its joint's effort [1/rad or 1/m]: all of it at 0.1 rad or 1 cm."""

VELOCITY_GAIN = 10.0
"""Gain of a velocity servo over effort by velocity: all of it at a tenth of the velocity."""

PLAIN_GAIN = {
    "position": {"hinge": 100.0, "slide": 1000.0},
    "velocity": {"hinge": 10.0, "slide": 100.0},
}
"""Gains where no effort is written."""


@dataclass(frozen=True)
class Gain:
    """A gain, and whether the inertia bounds it."""

    value: float
    is_bounded: bool


def position_gain(kind: str, effort: float | None, inertia: float) -> Gain:
    """Choose the gain of a position servo [N·m/rad or N/m].

    Args:
        kind: ``hinge`` or ``slide``.
        effort: The effort limit [N·m or N], where there is one.
        inertia: The inertia that the joint moves, with its armature [kg·m² or kg].
    """
    wanted = effort * POSITION_GAIN[kind] if effort else PLAIN_GAIN["position"][kind]
    most = PART * inertia / TIMESTEP**2
    if wanted <= most or most <= 0:
        return Gain(wanted, is_bounded=False)
    return Gain(float(f"{most:.3g}"), is_bounded=True)


def velocity_gain(kind: str, effort: float | None, velocity: float) -> Gain:
    """Choose the gain of a velocity servo [N·m·s/rad or N·s/m].

    Args:
        kind: ``hinge`` or ``slide``.
        effort: The effort limit [N·m or N], where there is one.
        velocity: The velocity limit [rad/s or m/s]; 0 where there is none.
    """
    wanted = PLAIN_GAIN["velocity"][kind]
    if effort and velocity:
        wanted = effort * VELOCITY_GAIN / velocity
    return Gain(wanted, is_bounded=False)
