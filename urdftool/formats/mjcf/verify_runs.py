"""Simulation of a compiled model at its home configuration, to check that it holds still.

The module reads only the exported file and shares no code with the exporter.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Array
from ...mechanics.standing import (
    DRIFT,
    NUDGE_ANGLE,
    NUDGE_TOWARD,
    WINDOW,
    Motion,
    get_nudge_side,
)
from ...mujoco_library import import_mujoco
from ...workspace import Workspace
from ..common.losses import DeclaredLosses
from .model_motion import ModelPose, compute_lowest_point, measure_motion

TIMESTEPS = (0.002, 0.005)
"""Physics time steps [s] at which a model must run: MuJoCo's default, and a usual longer one."""

SECONDS = 2.0
"""Simulated time [s]. Chosen, no source."""

BEYOND = 0.01
"""Tolerance of joint limits [rad or m]. Chosen, no source."""

STOP = 1e6
"""Speed [rad/s or m/s] above which the simulation has diverged."""


@dataclass
class Trial:
    """One simulation of a model.

    Attributes:
        timestep: Physics time step [s].
        warnings: Time [s] of the first occurrence of each of MuJoCo's warnings.
        beyond: Largest excess over joint limits [rad or m], by joint name, above the tolerance.
        motion: Motion of the free bodies, and of the joints except those that follow another one.
        motors: Names of the joints on a fixed base that got the torque that gravity needs.
        carried: Names of the joints that a free body carries, also of those that follow.
    """

    timestep: float
    warnings: dict[str, float] = field(default_factory=dict)
    beyond: dict[str, float] = field(default_factory=dict)
    motion: Motion = field(default_factory=Motion)
    motors: tuple[str, ...] = ()
    carried: frozenset[str] = frozenset()

    @property
    def drift(self) -> float:
        """Return the motion of the free body that moves most [m]; infinite after a divergence."""
        if not self.motion.is_finite:
            return math.inf
        return 0.0 if self.motion.worst is None else self.motion.worst.drift

    def list_faults(self) -> list[str]:
        """List all faults of a free base and of the simulation as text; empty if it runs."""
        return [*self.list_instabilities(), *self.list_excesses(), *self.describe_base()]

    def _end(self, text: str, *, is_held: bool = True) -> str:
        return f"{text} (at {self.timestep * 1000:g} ms)" + "; not held: no servo" * (not is_held)

    def describe_base(self) -> Iterator[str]:
        """Describe the motion of a free base, if it does not stay where it starts."""
        carried = [joint for joint in self.motion.joints if joint.is_carried]
        is_held = not carried or any(joint.is_held for joint in carried)
        for text in self.motion.describe_base():
            yield self._end(text, is_held=is_held)

    def describe_joints(self) -> Iterator[str]:
        """Describe the joints that do not stay where they start, if their base stands."""
        for text, is_held in self.motion.describe_joints():
            yield self._end(text, is_held=is_held)

    def list_instabilities(self) -> list[str]:
        """List warnings and divergence."""
        found = [
            self._end(f"MuJoCo warns after {time:.3g} s: {text}")
            for text, time in self.warnings.items()
        ]
        if not self.motion.is_finite:
            found.append(self._end("the state is not finite"))
        return found

    def list_excesses(self) -> list[str]:
        """List joints outside their limits."""
        return [
            self._end(f"joint '{name}' leaves its limits by {amount:.2g}")
            for name, amount in self.beyond.items()
        ]


def check_runs(
    path: Path,
    declared: DeclaredLosses,
    *,
    excluded: bool,
    start: str = "home",
    self_collides: bool = True,
) -> Check:
    """Simulate a model at each time step; return the row ``runs`` of the comparison.

    Without ``self_collides``, the bodies collide with planes and static geometry of the world only.
    """
    written = read_timestep(path)
    timesteps = sorted({written, TIMESTEPS[-1]})
    steps = " and ".join(f"{step * 1000:g}" for step in timesteps)
    check = Check(
        "runs",
        f"{SECONDS:g} s from {start}, {steps} ms: no warning, limits, joints, base [m]",
        DRIFT,
    )
    for timestep in timesteps:
        trial = run_at_home(path, timestep, self_collides=self_collides)
        known = declared.has_any("lossy-massless", "lossy-open-loop") or (
            not excluded and declared.has_any("lossy-overlap")
        )
        check.compare(0.0 if trial.list_faults() else trial.drift, "")
        # assumed gains are declared to be for the step that is written
        is_other = timestep > written and declared.has_any("lossy-gains")
        for fault in trial.list_instabilities():
            check.compare(math.inf, fault, known=known or is_other)
        # the export does not determine whether a free robot stands or sags
        for name, fault in zip(trial.beyond, trial.list_excesses(), strict=True):
            check.compare(math.inf, fault, known=known or is_other or name in trial.carried)
        for fault in (*trial.describe_joints(), *trial.describe_base()):
            check.compare(max(trial.drift, 2 * DRIFT), fault, known=True)
    if trial.motors:
        count = f"{len(trial.motors)} motor{'s' if len(trial.motors) > 1 else ''}"
        text = f"{count} without a servo got the torque that gravity needs"
        check.compare(2 * DRIFT, text, known=True)
    return check


def read_timestep(path: Path) -> float:
    """Return the time step that a model has [s]."""
    return float(import_mujoco("--verify").MjModel.from_xml_path(str(path)).opt.timestep)


def run_at_home(
    path: Path, timestep: float, seconds: float = SECONDS, *, self_collides: bool = True
) -> Trial:
    """Simulate a model from its key ``home``, held by its actuators.

    Without the key, the start is zero within the limits. A free base gets a floor under the lowest
    collision geometry if the file has no plane.
    """
    mujoco = import_mujoco("--verify")
    warned: list[str] = []
    mujoco.set_mju_user_warning(lambda text: warned.append(" ".join(text.split())))
    model = _compile_on_floor(mujoco, path)
    if not self_collides:  # a contact needs the type of one geom in the affinity of the other
        model.geom_conaffinity[model.geom_bodyid > 0] = 0
    model.opt.timestep = timestep
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    data = mujoco.MjData(model)
    _start(mujoco, model, data)
    trial = Trial(timestep)
    bases = [int(body) for body in np.flatnonzero(_compute_free_bodies(mujoco, model))]
    names = _name_joints(mujoco, model)
    roots = model.body_rootid[model.jnt_bodyid]
    trial.carried = frozenset(name for joint, name in names.items() if roots[joint] in bases)
    driven = _list_driven_joints(mujoco, model, data, by_position=False)
    held = _list_driven_joints(mujoco, model, data, by_position=True)
    limited = [joint for joint in sorted(held) if model.jnt_limited[joint] and joint in names]
    motors = _Motors(mujoco, model, bases)
    trial.motors = tuple(names[joint] for joint in motors.joints)
    poses = [ModelPose(model, data, bases)]
    gravity, later = np.array(model.opt.gravity), [WINDOW, WINDOW / 2]
    while data.time < seconds:
        lean = get_nudge_side(data.time) * NUDGE_ANGLE * float(np.linalg.norm(gravity))
        toward = (math.cos(NUDGE_TOWARD), math.sin(NUDGE_TOWARD), 0.0)
        model.opt.gravity[:] = gravity + lean * np.array(toward)
        motors.drive(data)
        mujoco.mj_step(model, data)
        for text in warned:
            trial.warnings.setdefault(text.partition(" Time =")[0], float(data.time))
        warned.clear()
        if not np.isfinite(data.qpos).all() or abs(data.qvel).max(initial=0.0) > STOP:
            trial.motion = Motion(is_finite=False)
            return trial
        for joint in limited:
            value = float(data.qpos[model.jnt_qposadr[joint]])
            low, high = model.jnt_range[joint]
            amount = float(max(low - value, value - high))
            if amount > BEYOND:
                trial.beyond[names[joint]] = max(amount, trial.beyond.get(names[joint], 0.0))
        if later and data.time >= seconds - later[0]:
            later.pop(0)
            poses.append(ModelPose(model, data, bases))
    poses.append(ModelPose(model, data, bases))
    trial.motion = measure_motion(model, data, names, poses, {*driven, *motors.joints})
    return trial


class _Motors:
    """Motors of joints on a fixed base, which hold them by the torque that gravity needs."""

    def __init__(self, mujoco: Any, model: Any, bases: list[int]) -> None:
        kinds, self.model = mujoco.mjtTrn, model
        found: dict[int, int] = {}
        for actuator in range(model.nu):
            joint = int(model.actuator_trnid[actuator][0])
            if (
                model.actuator_trntype[actuator] == kinds.mjTRN_JOINT
                and model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
                and model.actuator_dyntype[actuator] == mujoco.mjtDyn.mjDYN_NONE
                and model.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
                and model.jnt_type[joint] >= int(mujoco.mjtJoint.mjJNT_SLIDE)
                and model.body_rootid[model.jnt_bodyid[joint]] not in bases
                and model.actuator_gainprm[actuator][0] * model.actuator_gear[actuator][0]
            ):
                found.setdefault(joint, actuator)
        self.joints = list(found)
        self._numbers = np.array(list(found.values()), dtype=int)
        self._dofs = model.jnt_dofadr[self.joints] if found else np.zeros(0, dtype=int)
        self._gains = (
            model.actuator_gainprm[self._numbers, 0] * model.actuator_gear[self._numbers, 0]
        )

    def drive(self, data: Any) -> None:
        """Set the controls to the torque that balances gravity and springs in this state."""
        if not len(self._numbers):
            return
        wanted = (data.qfrc_bias - data.qfrc_passive)[self._dofs] / self._gains
        low, high = self.model.actuator_ctrlrange[self._numbers].T
        is_limited = self.model.actuator_ctrllimited[self._numbers] > 0
        data.ctrl[self._numbers] = np.where(is_limited, np.clip(wanted, low, high), wanted)


def read_home_positions(mujoco: Any, model: Any) -> Array:
    """Read the configuration of the key ``home``; without one, return zero within the limits."""
    key = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, "home")
    if key >= 0:
        return np.array(model.key_qpos[key])
    positions = np.array(model.qpos0)
    for joint in range(model.njnt):
        if model.jnt_limited[joint] and model.jnt_type[joint] >= int(mujoco.mjtJoint.mjJNT_SLIDE):
            low, high = model.jnt_range[joint]
            address = model.jnt_qposadr[joint]
            positions[address] = min(max(positions[address], low), high)
    for number in range(model.neq):
        one, other = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
        if model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT:
            lead = positions[model.jnt_qposadr[other]] if other >= 0 else 0.0
            offset, slope = model.eq_data[number][:2]
            positions[model.jnt_qposadr[one]] = offset + slope * lead
    return positions


def _start(mujoco: Any, model: Any, data: Any) -> None:
    """Set the state to home, and the targets of the servos."""
    key = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, "home")
    if key >= 0:
        mujoco.mj_resetDataKeyframe(model, data, key)
    else:
        data.qpos[:] = read_home_positions(mujoco, model)
        for actuator in range(model.nu):
            joint = int(model.actuator_trnid[actuator][0])
            is_servo = model.actuator_biasprm[actuator][1] != 0
            on_joint = model.actuator_trntype[actuator] == mujoco.mjtTrn.mjTRN_JOINT
            if is_servo and on_joint:
                data.ctrl[actuator] = data.qpos[model.jnt_qposadr[joint]]
    mujoco.mj_forward(model, data)


def _compute_free_bodies(mujoco: Any, model: Any) -> Array:
    free = np.zeros(model.nbody, dtype=bool)
    free[model.jnt_bodyid[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE]] = True
    return free


def _name_joints(mujoco: Any, model: Any) -> dict[int, str]:
    """Return the name of each joint that is not free; its number without a name."""
    free, kind = mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtObj.mjOBJ_JOINT
    return {
        joint: mujoco.mj_id2name(model, kind, joint) or str(joint)
        for joint in range(model.njnt)
        if model.jnt_type[joint] != free
    }


def _list_driven_joints(mujoco: Any, model: Any, data: Any, *, by_position: bool) -> set[int]:
    """List the joints that a servo moves, directly, by a tendon or by a mimic.

    With ``by_position``, servos of a velocity do not count.
    """
    terms = slice(1, 2) if by_position else slice(1, 3)
    servos = np.flatnonzero((model.actuator_biasprm[:, terms] != 0).any(axis=1))
    moment = np.zeros((model.nu, model.nv))
    mujoco.mju_sparse2dense(
        moment,
        data.actuator_moment.ravel(),
        data.moment_rownnz,
        data.moment_rowadr,
        data.moment_colind.ravel(),
    )
    freedoms = np.flatnonzero((moment[servos] != 0).any(axis=0))
    driven = {int(model.dof_jntid[freedom]) for freedom in freedoms}
    return driven | {
        int(model.eq_obj1id[number])
        for number in range(model.neq)
        if model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT
        and int(model.eq_obj2id[number]) in (-1, *driven)
    }


def _compile_on_floor(mujoco: Any, path: Path) -> Any:
    """Compile a file; add a floor if it has a free body and no plane."""
    model = mujoco.MjModel.from_xml_path(str(path))
    if (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE).any():
        return model
    if not _compute_free_bodies(mujoco, model).any():
        return model
    data = mujoco.MjData(model)
    _start(mujoco, model, data)
    spec = _read_spec(mujoco, path)
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 1],
        pos=[0, 0, compute_lowest_point(mujoco, model, data)],
    )
    return spec.compile()


def _read_spec(mujoco: Any, path: Path) -> Any:
    """Read a file; MuJoCo takes files in ``.xml`` alone, and a text only without parts."""
    if path.suffix == ".xml":
        return mujoco.MjSpec.from_file(str(path))
    spec = mujoco.MjSpec.from_string(Workspace().read_text(path))
    spec.modelfiledir = str(path.parent)
    return spec
