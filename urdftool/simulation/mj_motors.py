"""What drives joints in MuJoCo: a stiff servo within the joint's effort, or gains of a file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .bodies import Bodies
from .control import Pids, driven
from .settings import Settings

_STIFF = 0.5  # natural frequency of a servo times the timestep; two is the edge of stability
_DAMPED = 5.0  # damping over critical of an unloaded joint; a load on it lowers that
_CREEP = 0.25  # s: how soon what is left of an error is integrated away


class Motors:
    """Servos that hold joints where they start.

    Each has a stiffness by the inertia that it feels, so that it is as stiff as the timestep bears
    whatever the robot's size; damping is integrated implicitly, so it may be large. An integral
    part takes away what a load leaves, so a joint sags only where its effort is too small.
    """

    def __init__(
        self,
        mj: Any,
        model: Any,
        data: Any,
        bodies: Bodies,
        settings: Settings,
        motors: dict[str, int],
    ) -> None:
        """Take a model at its start, and the motor of each joint by name."""
        self._data = data
        model.actuator_gainprm[:, :] = 0.0  # also of motors that the file brings along
        model.actuator_biasprm[:, :] = 0.0
        joints = {joint.name: joint for joint in bodies.joints}
        controls = settings.controls or {}
        gained = [name for name in bodies.held if name in motors and driven(controls, name)]
        names = [name for name in bodies.held if name in motors and name not in gained]
        self._driven = np.array([motors[name] for name in gained], dtype=int)
        numbers = model.actuator_trnid[self._driven, 0]
        self._driven_at = model.jnt_qposadr[numbers]
        self._driven_dofs = model.jnt_dofadr[numbers]
        self._pids = Pids(
            [controls[name] for name in gained],
            [bodies.positions[name] for name in gained],
            [joints[name].effort for name in gained],
            [joints[name].kind == "continuous" for name in gained],
            settings.timestep,
        )
        self.motors = np.array([motors[name] for name in names], dtype=int)
        numbers = model.actuator_trnid[self.motors, 0]
        self._at, dofs = model.jnt_qposadr[numbers], model.jnt_dofadr[numbers]
        self._target = np.array([bodies.positions[name] for name in names])
        efforts = [joints[name].effort for name in names]
        self._bound = np.array([math.inf if effort is None else effort for effort in efforts])
        inertia = _felt(mj, model, data, dofs)
        fast = _STIFF / settings.timestep
        self._stiffness = inertia * fast**2
        self._sum = np.zeros(len(names))
        self._growth = self._stiffness * settings.timestep / _CREEP
        model.actuator_gainprm[self.motors, 0] = 1.0
        model.actuator_gainprm[self._driven, 0] = 1.0
        model.actuator_biastype[self.motors] = mj.mjtBias.mjBIAS_AFFINE
        model.actuator_biasprm[self.motors, 2] = -2 * _DAMPED * inertia * fast
        limited = np.isfinite(self._bound)
        model.actuator_forcelimited[self.motors] = limited
        model.actuator_forcerange[self.motors[limited]] = np.outer(self._bound[limited], [-1, 1])

    def drive(self) -> None:
        """Set what the motors do in the next step."""
        data = self._data
        if len(self._driven):
            data.ctrl[self._driven] = self._pids.step(
                data.qpos[self._driven_at], data.qvel[self._driven_dofs]
            )
        if not len(self.motors):
            return
        error = self._target - data.qpos[self._at]
        full = np.abs(data.actuator_force[self.motors]) >= 0.999 * self._bound
        grown = np.where(full, 0.0, self._growth * error)
        self._sum = np.clip(self._sum + grown, -self._bound, self._bound)
        data.ctrl[self.motors] = self._stiffness * error + self._sum


def _felt(mj: Any, model: Any, data: Any, dofs: Any) -> Any:
    """The inertia that a motor moves when every other joint is free [kg·m², kg]."""
    found = np.zeros(len(dofs))
    for row, dof in enumerate(dofs):
        unit, answer = np.zeros((1, model.nv)), np.zeros((1, model.nv))
        unit[0, dof] = 1.0
        mj.mj_solveM(model, data, answer, unit)
        found[row] = 1.0 / answer[0, dof]
    return found
