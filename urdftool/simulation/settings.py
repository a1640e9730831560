"""How a robot is spawned, what holds it, and for how long it is watched."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .control import Control

NUDGE = 0.1
"""How long gravity leans to each side [s]."""

_TOWARD = 0.6  # rad from x; along no robot's axis of symmetry


@dataclass(frozen=True)
class Settings:
    """One run.

    Attributes:
        duration: The longest the robot is watched [s of the simulated world].
        timestep: Of the engine [s].
        hold: Which joints are held: ``all``; ``actuated`` are those that the file drives, by a
            transmission, ros2_control or a plugin; ``none``.
        pose: Positions of joints by name [rad, m] at the start, which are held too.
        height: Of the root's frame above the plane [m]; None puts the lowest point of what
            collides just above it.
        fixed_base: Fix the root to the world.
        payloads: Further mass by link [kg], as a point in the link's centre of mass, or in its
            origin where it weighs nothing.
        friction: Of every contact where the file says nothing [–].
        gravity: Its strength [m/s²].
        slope: The plane falls along x by this angle [rad].
        self_collision: Whether links of the robot push each other, other than the two of a joint.
        seed: Of tilts and turns.
        trials: How many runs; the first is upright, the others are tilted and turned.
        tilt: The largest tilt of a trial [rad].
        start_rpy: How the root is turned at the start; set for each trial.
        sweep: Whether each joint is moved through its limits, too.
        nudge: How far gravity leans to one side and then to the other at the start [rad]: what
            balances on a point would stand for ever without it.
        time_limit: The longest the engine may work [s of the user's clock].
        controls: What drives each joint by name, where a file of controllers says it; ``hold``
            is then of no account.
    """

    duration: float = 5.0
    timestep: float = 0.002
    hold: str = "all"
    pose: dict[str, float] = field(default_factory=dict)
    height: float | None = None
    fixed_base: bool = False
    payloads: dict[str, float] = field(default_factory=dict)
    friction: float = 1.0
    gravity: float = 9.81
    slope: float = 0.0
    self_collision: bool = False
    seed: int = 0
    trials: int = 1
    tilt: float = 0.1
    start_rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sweep: bool = False
    nudge: float = 0.02
    time_limit: float = 60.0
    controls: Mapping[str, Control] | None = None

    def compute_gravity_at(self, time: float) -> tuple[float, float, float]:
        """Compute gravity [m/s²] at a time [s], in the frame in which the plane is level."""
        lean = 0.0
        if self.nudge and time < 2 * NUDGE:
            lean = self.nudge if time < NUDGE else -self.nudge
        angle = self.slope + lean * math.cos(_TOWARD)
        side = lean * math.sin(_TOWARD)
        x, y = math.sin(angle), math.cos(angle) * math.sin(side)
        return self.gravity * x, self.gravity * y, -self.gravity * math.cos(angle) * math.cos(side)
