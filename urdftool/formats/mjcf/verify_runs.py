"""Simulation of a compiled model at its home configuration, to check that it holds still.

The module reads only the exported file and shares no code with the exporter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Array
from ...workspace import Workspace
from ..common.losses import DeclaredLosses
from .compiled import import_mujoco_module

TIMESTEPS = (0.002, 0.005)
"""Physics time steps [s] at which a model must run: MuJoCo's default, and a usual longer one."""

SECONDS = 2.0
"""Simulated time [s]. Chosen, no source."""

BEYOND = 0.01
"""Tolerance of joint limits [rad or m]. Chosen, no source."""

DRIFT = 0.02
"""Maximum motion of a free base from the start [m]; chosen, no source."""

TILT = 3.0
"""Maximum tilt of a free base from the start [°]; chosen, no source."""

SWING = 0.1
"""Maximum motion of a joint that no servo holds [rad or m]; chosen, no source."""

SAG = 0.05
"""Maximum motion of a joint that a servo holds [rad or m]; chosen, no source: ``TILT`` in radians.
"""

FALLEN_TILT = 30.0
"""Tilt of a free base above which the robot has fallen [°]; chosen, no source."""

FALLEN_DROP = 0.3
"""Drop of the center of mass, relative to its first height, above which the robot has fallen;
chosen, no source.
"""

THE_BASE = "the base"
"""The only free body of a model that has no other body on its world, in messages."""

STOP = 1e6
"""Speed [rad/s or m/s] above which the simulation has diverged."""


@dataclass
class Trial:
    """One simulation of a model.

    Attributes:
        timestep: Physics time step [s].
        warnings: Time [s] of the first occurrence of each of MuJoCo's warnings.
        beyond: Largest excess over joint limits [rad or m], by joint name, above the tolerance.
        base: The free body that moves most, for messages; empty if the model has none.
        drift: Its motion from the start [m]; infinite if the simulation diverged.
        tilt: Its tilt from the start [°].
        drop: Drop of the center of mass that it carries, relative to the height at the start.
        sink: Its drop [m].
        swing: Motion of each joint of a fixed base from the start [rad or m], by name.
        held: Names of the joints that a servo holds, directly or by a mimic.
        floating: Names of the joints that a free body carries.
        speed: Highest joint speed at the end [rad/s or m/s].
    """

    timestep: float
    warnings: dict[str, float] = field(default_factory=dict)
    beyond: dict[str, float] = field(default_factory=dict)
    base: str = ""
    drift: float = 0.0
    tilt: float = 0.0
    drop: float = 0.0
    sink: float = 0.0
    swing: dict[str, float] = field(default_factory=dict)
    held: frozenset[str] = frozenset()
    floating: frozenset[str] = frozenset()
    speed: float = 0.0

    def list_faults(self) -> list[str]:
        """List all faults as text; empty for a model that runs."""
        return [*self.list_instabilities(), *self.list_excesses(), *self.describe_motion()]

    @property
    def is_held(self) -> bool:
        """Tell whether a servo holds a joint that a free body carries, or there is none."""
        return not self.floating or bool(self.held & self.floating)

    @property
    def moves(self) -> bool:
        """Tell whether a free base does not stay where it starts."""
        return math.isfinite(self.drift) and (self.drift > DRIFT or self.tilt > TILT)

    def describe_motion(self) -> Iterator[str]:
        """Describe the motion of a free base, if it does not stay where it starts."""
        if not self.moves:
            return
        cause = "" if self.is_held else "; not held: no servo"
        at = f"(at {self.timestep * 1000:g} ms){cause}"
        moved = f"{self.base} moves by {self.drift:.2g} m and tilts by {self.tilt:.2g}°"
        if self.tilt > FALLEN_TILT or self.drop > FALLEN_DROP:
            yield f"falls: {moved} {at}"
        elif self.sink > self.drift / 2:
            who = "" if self.base == THE_BASE else f"{self.base} "
            yield f"{who}sags by {self.sink:.2g} m, and tilts by {self.tilt:.2g}° {at}"
        else:
            yield f"{moved} {at}"

    def describe_swing(self) -> Iterator[str]:
        """Describe the joints on a fixed base that do not stay where they start."""
        moved = {name: amount for name, amount in self.swing.items()
                 if amount > (SAG if name in self.held else SWING)}  # fmt: skip
        if not moved:
            return
        worst = max(moved, key=lambda name: moved[name])
        cause = "" if worst in self.held else "; not held: no servo"
        at = f"(at {self.timestep * 1000:g} ms){cause}"
        yield f"joints move by up to {moved[worst]:.2g}, '{worst}' most {at}"

    def list_instabilities(self) -> list[str]:
        """List warnings and divergence."""
        at = f"at {self.timestep * 1000:g} ms"
        found = [
            f"MuJoCo warns after {time:.3g} s: {text} ({at})"
            for text, time in self.warnings.items()
        ]
        if not math.isfinite(self.drift):
            found.append(f"the state is not finite ({at})")
        return found

    def list_excesses(self) -> list[str]:
        """List joints outside their limits."""
        at = f"at {self.timestep * 1000:g} ms"
        return [
            f"joint '{name}' leaves its limits by {amount:.2g} ({at})"
            for name, amount in self.beyond.items()
        ]


def check_runs(
    path: Path, declared: DeclaredLosses, *, excluded: bool, start: str = "home"
) -> Check:
    """Simulate a model at each time step.

    Args:
        path: The MJCF file.
        declared: The reported losses.
        excluded: Whether links that overlap at home are excluded from contact.
        start: Where the model starts, for the table.

    Returns:
        The row ``runs`` of the comparison.
    """
    written = read_timestep(path)
    timesteps = sorted({written, TIMESTEPS[-1]})
    steps = " and ".join(f"{step * 1000:g}" for step in timesteps)
    check = Check(
        "runs",
        f"{SECONDS:g} s from {start}, {steps} ms: no warning, limits, base motion [m]",
        DRIFT,
    )
    for timestep in timesteps:
        trial = run_at_home(path, timestep)
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
            check.compare(math.inf, fault, known=known or is_other or name in trial.floating)
        for fault in trial.describe_swing():
            check.compare(max(*trial.swing.values(), 2 * DRIFT), fault, known=True)
        for fault in trial.describe_motion():
            check.compare(max(trial.drift, 2 * DRIFT), fault, known=True)
    return check


def read_timestep(path: Path) -> float:
    """Return the time step that a model has [s]."""
    return float(import_mujoco_module().MjModel.from_xml_path(str(path)).opt.timestep)


def run_at_home(path: Path, timestep: float, seconds: float = SECONDS) -> Trial:
    """Simulate a model from its key ``home``, held by its actuators.

    Without the key, the start is zero within the limits. A free base gets a floor under the lowest
    collision geometry if the file has no plane.
    """
    mujoco = import_mujoco_module()
    warned: list[str] = []
    mujoco.set_mju_user_warning(lambda text: warned.append(" ".join(text.split())))
    model = _compile_on_floor(mujoco, path)
    model.opt.timestep = timestep
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    data = mujoco.MjData(model)
    _start(mujoco, model, data)
    trial = Trial(timestep)
    bases = [int(body) for body in np.flatnonzero(_compute_free_bodies(mujoco, model))]
    names = _name_joints(mujoco, model)
    trial.floating = frozenset(
        name for joint, name in names.items() if model.body_rootid[model.jnt_bodyid[joint]] in bases
    )
    driven = _list_driven_joints(mujoco, model, data, by_position=False)
    trial.held = frozenset(names[joint] for joint in driven if joint in names)
    held = _list_driven_joints(mujoco, model, data, by_position=True)
    limited = [joint for joint in sorted(held) if model.jnt_limited[joint] and joint in names]
    start, joints = _Pose(model, data, bases), np.array(data.qpos)
    while data.time < seconds:
        mujoco.mj_step(model, data)
        for text in warned:
            trial.warnings.setdefault(text.partition(" Time =")[0], float(data.time))
        warned.clear()
        if not np.isfinite(data.qpos).all() or abs(data.qvel).max(initial=0.0) > STOP:
            trial.drift = math.inf
            return trial
        for joint in limited:
            value = float(data.qpos[model.jnt_qposadr[joint]])
            low, high = model.jnt_range[joint]
            amount = float(max(low - value, value - high))
            if amount > BEYOND:
                trial.beyond[names[joint]] = max(amount, trial.beyond.get(names[joint], 0.0))
    moved = abs(data.qpos - joints)
    for joint, name in names.items():
        if name not in trial.floating:
            first = int(model.jnt_qposadr[joint])
            count = 4 if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_BALL else 1
            trial.swing[name] = float(moved[first : first + count].max())
    if bases:
        _measure_motion(mujoco, model, trial, start, _Pose(model, data, bases))
    trial.speed = float(abs(data.qvel).max(initial=0.0))
    return trial


class _Pose:
    """Places of the free bodies, and of the mass that each carries."""

    def __init__(self, model: Any, data: Any, bases: list[int]) -> None:
        self.bodies = bases
        self.places = np.array(data.xpos[bases])
        self.up = np.array(data.xmat[bases])[:, 6:]  # the world's z axis in the body
        self.heights = np.array(data.subtree_com[bases])[:, 2]
        self.lowest = compute_lowest_point(import_mujoco_module(), model, data)


def _measure_motion(mujoco: Any, model: Any, trial: Trial, start: _Pose, end: _Pose) -> None:
    """Record the motion of the free body that moves most, by its drift and its tilt."""
    drifts = np.linalg.norm(end.places - start.places, axis=1)
    cosines = np.clip((start.up * end.up).sum(axis=1), -1.0, 1.0)
    tilts = np.degrees(np.arccos(cosines))
    most = int(np.maximum(drifts / DRIFT, tilts / TILT).argmax())
    body = start.bodies[most]
    is_alone = (model.body_parentid[1:] == 0).sum() == 1
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body) or body
    trial.base = THE_BASE if is_alone else f"body '{name}'"
    trial.drift, trial.tilt = float(drifts[most]), float(tilts[most])
    trial.sink = float(start.places[most, 2] - end.places[most, 2])
    height = max(float(start.heights[most] - start.lowest), 1e-9)
    trial.drop = float(start.heights[most] - end.heights[most]) / height


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

    Args:
        mujoco: The module.
        model: The model.
        data: Its state at the start, forwarded.
        by_position: Whether servos of a velocity do not count.
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


def compute_lowest_point(mujoco: Any, model: Any, data: Any) -> float:
    """Compute the height [m] of the lowest point of the collision geoms, in the world."""
    lows = list(list_low_points(mujoco, model, data))
    return min(lows, default=0.0)


def list_low_points(mujoco: Any, model: Any, data: Any) -> Iterator[float]:
    """Yield the height [m] of the lowest point of each collision geom that is not a plane."""
    kinds = mujoco.mjtGeom
    for geom in range(model.ngeom):
        kind = int(model.geom_type[geom])
        collides = model.geom_contype[geom] or model.geom_conaffinity[geom]
        if not collides or kind in (int(kinds.mjGEOM_PLANE), int(kinds.mjGEOM_HFIELD)):
            continue
        rotation = data.geom_xmat[geom].reshape(3, 3)
        place, size = data.geom_xpos[geom], model.geom_size[geom]
        if kind in _REACHES:
            yield float(place[2] - _REACHES[kind](rotation[2], size))
            continue
        if kind == int(kinds.mjGEOM_MESH):
            mesh = int(model.geom_dataid[geom])
            first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
            points = model.mesh_vert[first : first + count]
        else:
            middle, half = model.geom_aabb[geom][:3], model.geom_aabb[geom][3:]
            signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
            points = middle + signs * half
        yield float((points @ rotation.T + place)[:, 2].min())


_SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER = 2, 3, 4, 5  # mjtGeom of MuJoCo

_REACHES: dict[int, Callable[[Array, Array], float]] = {
    _SPHERE: lambda _, size: float(size[0]),
    _CAPSULE: lambda up, size: float(size[0] + abs(up[2]) * size[1]),
    _ELLIPSOID: lambda up, size: float(np.linalg.norm(up * size)),
    _CYLINDER: lambda up, size: float(
        abs(up[2]) * size[1] + size[0] * math.sqrt(max(0.0, 1 - up[2] ** 2))
    ),
}
"""How far shapes reach below their center [m]: by the world's z axis in the shape, and its size."""
