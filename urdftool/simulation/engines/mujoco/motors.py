"""Drive joints in MuJoCo: dry friction and a servo within the effort limit, or PID gains."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...control import Pids, is_driven
from ...recording import Array
from ...rigid_bodies import RigidBodyModel
from ...settings import Settings
from ..base import UNLIMITED_EFFORT

_RIGID = (2.5, 1.0)
"""Of a brake: time constant in timesteps, part of critical. Chosen, no source."""

_IMPEDANCE = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Parameters ``solimp`` of MuJoCo of joints that dry friction holds: almost rigid. Chosen, no
source.
"""

_STIFF = 0.5
"""Natural frequency of an unloaded joint under its servo, times the timestep. Chosen, no source."""

_DAMPED = 10.0
"""Its kd over the critical one; a load on it lowers that. Chosen, no source."""

_CREEP = 0.25
"""S: time constant of the integral of the remaining error. Chosen, no source."""

_FAR = 0.02  # rad, m: error at which the servo starts
_NEAR = 2e-3
"""Rad, m: error at which friction holds the joint again,. Chosen, no source."""

_SLOW = 0.1
"""Rad/s, m/s: below this speed. Chosen, no source."""


class Motors:
    """Motors that hold joints at their initial positions.

    A joint at its position is held by dry friction equal to its effort limit: a constraint that the
    solver solves together with contacts of any stiffness, without a position error or oscillation.
    If the friction is overcome, a servo with the same effort limit drives the joint back: a spring
    and damper in proportion to the inertia at the joint, and an integral term.
    """

    def __init__(
        self,
        mj: Any,
        model: Any,
        data: Any,
        bodies: RigidBodyModel,
        settings: Settings,
        motors: dict[str, int],
    ) -> None:
        """Set up the motors of a model at its start, by the name of their joint."""
        self._mj, self._model, self._data = mj, model, data
        model.actuator_gainprm[:, :] = 0.0  # also of motors in the file
        model.actuator_biasprm[:, :] = 0.0
        joints = {joint.name: joint for joint in bodies.joints}
        controls = settings.controls or {}
        gained = [name for name in bodies.held if name in motors and is_driven(controls, name)]
        names = [name for name in bodies.held if name in motors and name not in gained]
        self._pids = Pids(
            [controls[name] for name in gained],
            [bodies.positions[name] for name in gained],
            [joints[name].effort for name in gained],
            [joints[name].kind == "continuous" for name in gained],
            settings.timestep,
        )
        self._driven, self._driven_at, self._driven_dofs = self._find_addresses(gained, motors)
        model.actuator_gainprm[self._driven, 0] = 1.0
        self._held, self._at, self._dofs = self._find_addresses(names, motors)
        self._target = np.array([bodies.positions[name] for name in names])
        self._bound = np.array([joints[name].effort or UNLIMITED_EFFORT for name in names])
        self._friction = np.array(model.dof_frictionloss[self._dofs])
        self._make_servos(settings.timestep)
        self._braked = np.ones(len(names), dtype=bool)
        model.dof_solref[self._dofs] = (_RIGID[0] * settings.timestep, _RIGID[1])
        model.dof_solimp[self._dofs] = _IMPEDANCE
        self._set_brake()

    def _find_addresses(self, names: list[str], motors: dict[str, int]) -> tuple[Any, Any, Any]:
        """Find the motors of joints, and the addresses of position and rate of each."""
        numbers = np.array([motors[name] for name in names], dtype=int)
        joints = self._model.actuator_trnid[numbers, 0]
        return numbers, self._model.jnt_qposadr[joints], self._model.jnt_dofadr[joints]

    def _make_servos(self, timestep: float) -> None:
        model = self._model
        inertia = _compute_motor_inertias(self._mj, model, self._data, self._dofs)
        fast = _STIFF / timestep
        self._kp = inertia * fast**2
        # with implicit Euler, the spring force is that of the position after the step
        self._kd = 2 * _DAMPED * inertia * fast + self._kp * timestep
        self._growth = self._kp * timestep / _CREEP
        self._sum = np.zeros(len(self._dofs))
        model.actuator_gainprm[self._held, 0] = 1.0
        model.actuator_biastype[self._held] = self._mj.mjtBias.mjBIAS_AFFINE
        model.actuator_forcelimited[self._held] = True
        model.actuator_forcerange[self._held] = np.outer(self._bound, [-1, 1])

    def _set_brake(self) -> None:
        """Set the dry friction of joints held by it, and remove that of the others."""
        tight = np.where(self._braked, self._bound, 0.0)
        self._model.dof_frictionloss[self._dofs] = self._friction + tight
        self._model.actuator_biasprm[self._held, 2] = np.where(self._braked, 0.0, -self._kd)
        self._sum[self._braked] = 0.0

    def drive(self) -> None:
        """Set the controls of the motors for the next step."""
        data = self._data
        if len(self._driven):
            data.ctrl[self._driven] = self._pids.step(
                data.qpos[self._driven_at], data.qvel[self._driven_dofs]
            )
        if not len(self._held):
            return
        error = self._target - data.qpos[self._at]
        far, near = np.abs(error) > _FAR, np.abs(error) < _NEAR
        slow = np.abs(data.qvel[self._dofs]) < _SLOW
        braked = np.where(self._braked, ~far, near & slow)
        if (braked != self._braked).any():
            self._braked = braked
            self._set_brake()
        if braked.all():
            data.ctrl[self._held] = 0.0
            return
        full = np.abs(data.actuator_force[self._held]) >= 0.999 * self._bound
        grown = np.where(full | braked, 0.0, self._growth * error)
        self._sum = np.clip(self._sum + grown, -self._bound, self._bound)
        data.ctrl[self._held] = np.where(braked, 0.0, self._kp * error + self._sum)

    def get_efforts(self, dofs: Any) -> Array:
        """Return the effort that drives or holds each degree of freedom [N·m, N]."""
        data = self._data
        whole = np.array(data.qfrc_actuator)
        kind = self._mj.mjtConstraint.mjCNSTR_FRICTION_DOF
        rows = np.flatnonzero(np.array(data.efc_type[: data.nefc]) == int(kind))
        numbers = np.array(data.efc_id)[rows]
        forces = np.zeros_like(whole)
        forces[numbers] = np.array(data.efc_force)[rows]
        held = self._dofs[self._braked]
        bound = self._bound[self._braked]
        whole[held] += np.clip(forces[held], -bound, bound)
        found: Array = whole[dofs]
        return found


def _compute_motor_inertias(mj: Any, model: Any, data: Any, dofs: Any) -> Any:
    """Compute the inertia at each motor if all other joints are free [kg·m², kg]."""
    found = np.zeros(len(dofs))
    for row, dof in enumerate(dofs):
        unit, answer = np.zeros((1, model.nv)), np.zeros((1, model.nv))
        unit[0, dof] = 1.0
        mj.mj_solveM(model, data, answer, unit)
        found[row] = 1.0 / answer[0, dof]
    return found
