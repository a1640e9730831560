"""PID controllers of joints, as in ros_control's control_toolbox."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .recording import Array

SERVO, POSITION, VELOCITY, NONE = "servo", "position-pid", "velocity-pid", "none"


@dataclass(frozen=True)
class Pid:
    """Gains from an error in rad or m, or rad/s or m/s, to an effort in N·m or N.

    Attributes:
        p: Proportional gain.
        i: Integral gain.
        d: Derivative gain.
        i_min: Minimum of the integral term; zero by default, as in ros_control.
        i_max: Maximum of the integral term.
        antiwindup: Whether the integral itself is also limited.
    """

    p: float
    i: float = 0.0
    d: float = 0.0
    i_min: float = 0.0
    i_max: float = 0.0
    antiwindup: bool = False


@dataclass(frozen=True)
class Control:
    """Control of a joint.

    Attributes:
        controller: Name of the controller in the file.
        kind: ``servo``, a position or velocity interface with a constant command;
            ``position-pid`` or ``velocity-pid``, whose output is an effort; or ``none``.
        pid: Gains of a PID; None for other kinds.
        at: Path of the file, and the first and last byte of the gains or the joint's name.
    """

    controller: str
    kind: str
    pid: Pid | None
    at: tuple[str, int, int]


class Pids:
    """PID loops of several joints."""

    def __init__(
        self,
        controls: Sequence[Control],
        targets: Sequence[float],
        efforts: Sequence[float | None],
        turning: Sequence[bool],
        timestep: float,
    ) -> None:
        """Initialize the loops at rest.

        Args:
            controls: Control of each joint, with gains.
            targets: Target position of each joint [rad, m].
            efforts: Effort limit of each joint [N·m, N]; None without a limit.
            turning: Whether each joint is continuous: its error is the shortest rotation.
            timestep: Time between steps [s].
        """
        gains = [control.pid for control in controls]
        assert all(gains)
        self._dt = timestep
        self._p, self._i, self._d, self._low, self._high = (
            np.array([float(getattr(pid, name)) for pid in gains])
            for name in ("p", "i", "d", "i_min", "i_max")
        )
        self._windup = np.array([pid.antiwindup and pid.i != 0 for pid in gains if pid], dtype=bool)
        self._by_position = np.array([control.kind == POSITION for control in controls], dtype=bool)
        self._target, self._turning = np.array(targets), np.array(turning, dtype=bool)
        self._bound = np.array([math.inf if effort is None else effort for effort in efforts])
        self._sum = np.zeros(len(gains))
        self._last: Array | None = None
        self.efforts: Array = np.zeros(len(gains))

    def step(self, positions: Array, rates: Array) -> Array:
        """Compute the effort of each joint for the next step [N·m, N]."""
        errors = self._target - positions
        turn = (errors + math.pi) % (2 * math.pi) - math.pi
        error = np.where(self._by_position, np.where(self._turning, turn, errors), -rates)
        self._sum = self._sum + self._dt * error
        some = self._windup
        ends = np.sort(np.stack([self._low[some], self._high[some]]) / self._i[some], axis=0)
        self._sum[some] = np.clip(self._sum[some], ends[0], ends[1])
        integral = np.clip(self._i * self._sum, self._low, self._high)
        slope = np.zeros_like(error) if self._last is None else (error - self._last) / self._dt
        self._last = error
        total = self._p * error + integral + self._d * slope
        self.efforts = np.clip(total, -self._bound, self._bound)
        return self.efforts


def is_driven(controls: Mapping[str, Control] | None, name: str) -> bool:
    """Tell whether gains of a controller file drive a joint."""
    control = None if controls is None else controls.get(name)
    return control is not None and control.kind in (POSITION, VELOCITY)
