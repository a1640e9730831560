"""Settings of a simulation: spawn pose, held joints, ground, duration, trials."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

from ..arguments import require_kind
from ..mechanics.standing import NUDGE_TOWARD, get_nudge_side
from ..suggestions import require_number, require_word

if TYPE_CHECKING:
    from .control import Control

HOLDS = ("all", "actuated", "none")
"""Words of ``hold``."""

RANGES = {
    "duration": (1e-9, 3600.0),
    "timestep": (1e-5, 0.05),
    "slope": (-math.pi / 3, math.pi / 3),
    "friction": (0.0, math.inf),
    "gravity": (0.0, math.inf),
    "trials": (1, 1000),
    "tilt": (0.0, math.pi),
    "nudge": (0.0, math.pi),
    "time_limit": (0.1, 86400.0),
}
"""Least and greatest value of each number [s, rad, m/s², –], as on the command line."""


@dataclass(frozen=True)
class Settings:
    """Settings of a simulation.

    Attributes:
        duration: Maximum simulated time [s].
        timestep: Physics time step [s].
        hold: Held joints: ``all``; ``actuated`` for joints with a transmission, ros2_control or a
            plugin in the file; ``none``.
        pose: Initial positions of joints by name [rad, m], at which they are held.
        height: Height of the root frame above the plane [m]; None for the lowest point of the
            collision geometry just above the plane.
        fixed_base: Whether to fix the root to the world.
        payloads: Point masses by link [kg], at the link's center of mass, or at the origin of a
            link without mass.
        friction: Friction coefficient of links for which the file has none [–].
        gravity: Magnitude of gravity [m/s²].
        slope: Slope of the plane, downward along x [rad].
        self_collision: Whether contacts between links are enabled, except parent and child.
        seed: Seed of the random tilts and yaws of trials.
        trials: Number of trials; all but the first start with a random tilt and yaw.
        tilt: Maximum tilt of a trial [rad].
        start_rpy: Roll, pitch and yaw of the upright robot at the start [rad]; set for each trial.
        upright_rpy: Roll, pitch and yaw of the root of the upright robot [rad].
        fixed_in_exports: Why the exports fix the root that is simulated free; only reported.
        sweep: Whether each joint is also moved through its limits.
        nudge: Angle by which gravity tilts to one side and then to the other at the start [rad],
            so that a robot balanced on a point falls.
        time_limit: Limit of the engine's processor time, for all trials [s].
        controls: Controllers of joints by name; None without a controller file. With one, ``hold``
            is ignored.
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
    upright_rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    fixed_in_exports: str = ""
    sweep: bool = False
    nudge: float = 0.02
    time_limit: float = 60.0
    controls: Mapping[str, Control] | None = None

    def __post_init__(self) -> None:
        """Raise ConfigError if a value is not allowed."""
        for one in fields(self):
            require_kind(one.name, getattr(self, one.name), str(one.type))
        require_word("hold", self.hold, HOLDS)
        for name, (least, most) in RANGES.items():
            require_number(name, getattr(self, name), least, most)
        if self.height is not None:
            require_number("height", self.height)
        for link, mass in self.payloads.items():
            require_number(f"payload of '{link}'", mass, 0.0)

    def compute_gravity_at(self, time: float) -> tuple[float, float, float]:
        """Compute gravity [m/s²] at a time [s], in the frame in which the plane is level."""
        lean = self.nudge * get_nudge_side(time)
        angle = self.slope + lean * math.cos(NUDGE_TOWARD)
        side = lean * math.sin(NUDGE_TOWARD)
        x, y = math.sin(angle), math.cos(angle) * math.sin(side)
        return self.gravity * x, self.gravity * y, -self.gravity * math.cos(angle) * math.cos(side)
