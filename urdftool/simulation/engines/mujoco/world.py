"""The robot above a plane in MuJoCo: compiling, stepping and sampling."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ....errors import ModelError
from ....mechanics.spatial_inertia import SpatialInertia, combine
from ....mechanics.tensor import compute_principal_moments
from ....model.pose import rotation_from_quaternion
from ....model.settings import RESISTANCE
from ...recording import Array, Contact, ReadBack
from ...rigid_bodies import TENSOR_ROUNDING, RigidBody, RigidBodyModel
from ...settings import Settings
from ..base import Sample
from ..registry import name_alternative
from .contacts import ContactReader
from .motors import Motors
from .scene import MOTOR, PLANE, SCENE, get_moving_name

_SOFT = 5.0
"""Timesteps: the time constant of a contact; below two it is unstable, near it jumps. Chosen, no
source.
"""

_IMPEDANCE = (0.95, 0.99, 0.001, 0.5, 2.0)
"""Parameters ``solimp`` of MuJoCo of contacts: the width is 1 mm. Chosen, no source."""


_TOO_DEEP = "XML_ELEMENT_DEPTH_EXCEEDED"


class MuJoCoWorld:
    """A robot above a plane, in MuJoCo."""

    def __init__(self, mj: Any, bodies: RigidBodyModel, settings: Settings, folder: Path) -> None:
        """Load the model and set its initial state."""
        self.mj, self.bodies, self.settings = mj, bodies, settings
        self.version = str(mj.__version__)
        self.capped: dict[str, float] = {}  # implicit integration is stable
        mj.set_mju_user_warning(lambda _: None)  # without it a log is written to the folder
        try:
            self.model = mj.MjModel.from_xml_path(str(folder / SCENE))
        except ValueError as error:
            reason = " ".join(str(error).split())
            if _TOO_DEEP in reason:
                raise ModelError(_explain_depth()) from None
            raise ModelError(f"MuJoCo cannot compile the MJCF of the robot: {reason}") from None
        self.data = mj.MjData(self.model)
        self.number_of = {
            link: self._get_body(link) for body in bodies.bodies for link in body.links
        }
        self.numbers = [self.number_of[body.name] for body in bodies.bodies]
        self.joints = [self._get_id("JOINT", joint.name) for joint in bodies.joints]
        self.plane = self._get_id("GEOM", PLANE)
        self.read_back = _read_back(self.model, bodies, self.number_of, self.joints)
        self._set_options()
        self._set_forces()
        self._make_contacts()
        self._place()
        self.touches = ContactReader(mj, self.model, self.data, bodies, self.number_of, self.plane)
        motors = {
            joint.name: number
            for joint in bodies.joints
            if (number := self._get_id("ACTUATOR", MOTOR + joint.name)) >= 0
        }
        self.motors = Motors(mj, self.model, self.data, bodies, settings, motors)

    def _get_id(self, kind: str, name: str) -> int:
        return int(self.mj.mj_name2id(self.model, getattr(self.mj.mjtObj, f"mjOBJ_{kind}"), name))

    def _get_body(self, link: str) -> int:
        """Return the number of a link's body; 0, the world, if it has no body of its own."""
        number = self._get_id("BODY", get_moving_name(link))
        return number if number >= 0 else max(0, self._get_id("BODY", link))

    def _set_options(self) -> None:
        mj, option = self.mj, self.model.opt
        option.timestep = self.settings.timestep
        option.integrator = mj.mjtIntegrator.mjINT_IMPLICITFAST
        option.cone = mj.mjtCone.mjCONE_ELLIPTIC
        option.solver = mj.mjtSolver.mjSOL_NEWTON
        option.iterations, option.tolerance = 100, 1e-10
        option.impratio, option.noslip_iterations = 10.0, 5
        option.density = option.viscosity = 0.0
        option.wind = (0.0, 0.0, 0.0)
        option.disableflags = mj.mjtDisableBit.mjDSBL_AUTORESET
        option.enableflags = 0
        option.gravity = self.settings.compute_gravity_at(0.0)

    def _set_forces(self) -> None:
        """Remove gravity compensation and springs that the bodies do not have."""
        for body in self.bodies.bodies:
            if body.weightless is None:
                self.model.body_gravcomp[[self.number_of[link] for link in body.links]] = 0.0
        for joint, number in zip(self.bodies.joints, self.joints, strict=True):
            if number >= 0:
                self.model.jnt_stiffness[number] = joint.stiffness

    def _make_contacts(self) -> None:
        """Set friction by the file or the settings, and which geoms may make contact."""
        model, settings = self.model, self.settings
        solid = np.flatnonzero((model.geom_contype != 0) | (model.geom_conaffinity != 0))
        model.geom_solref[:] = (max(_SOFT * settings.timestep, 1e-4), 1.0)
        model.geom_solimp[:] = _IMPEDANCE
        model.geom_margin[:] = 0.0
        # collision geometry of the robot is one group, the plane the other
        model.geom_contype[solid] = 1
        model.geom_conaffinity[solid] = 3 if settings.self_collision else 2
        model.geom_contype[self.plane], model.geom_conaffinity[self.plane] = 2, 1
        model.geom_friction[self.plane, 0] = 0.0  # MuJoCo uses the larger value of two geoms
        lump = {self.number_of[link]: body for body in self.bodies.bodies for link in body.links}
        for geom in solid:
            body = lump.get(int(model.geom_bodyid[geom]))
            if body is None or geom == self.plane:
                continue
            own = body.surface.get("friction")
            model.geom_friction[geom, 0] = settings.friction if own is None else own

    def _place(self) -> None:
        """Set the initial pose of the root's link frame and the initial joint positions."""
        mj, model, data = self.mj, self.model, self.data
        at, turn = (
            np.array(self.bodies.start.translation),
            _convert_quaternion(self.bodies.start.rotation),
        )
        mj.mj_resetData(model, data)
        root = self.numbers[0]
        free = [
            j for j in range(model.njnt)
            if model.jnt_type[j] == mj.mjtJoint.mjJNT_FREE and model.jnt_bodyid[j] == root
        ]  # fmt: skip
        if free:
            first = int(model.jnt_qposadr[free[0]])
            data.qpos[first : first + 3], data.qpos[first + 3 : first + 7] = at, turn
        elif root:
            model.body_pos[root], model.body_quat[root] = at, turn
        else:
            self._move_world(at, turn)
        for joint, number in zip(self.bodies.joints, self.joints, strict=True):
            if number >= 0:
                data.qpos[model.jnt_qposadr[number]] = self.bodies.positions[joint.name]
        start = data.qpos.copy()
        mj.mj_setConst(model, data)
        mj.mj_resetData(model, data)
        data.qpos[:] = start
        mj.mj_forward(model, data)

    def _move_world(self, at: Array, turn: Array) -> None:
        """Move the children of a root that is the world itself."""
        mj, model = self.mj, self.model
        tops = np.flatnonzero(model.body_parentid == 0)[1:]
        geoms = np.flatnonzero(model.geom_bodyid == 0)
        for places, turns, rows in (
            (model.body_pos, model.body_quat, tops),
            (model.geom_pos, model.geom_quat, geoms[geoms != self.plane]),
        ):
            for row in rows:
                place, whole = np.zeros(3), np.zeros(4)
                mj.mju_rotVecQuat(place, places[row], turn)
                mj.mju_mulQuat(whole, turn, turns[row])
                places[row], turns[row] = place + at, whole

    def set_joint_position(self, joint: int, value: float) -> None:
        """Set the position of a joint [rad, m], and of those that mimic it, without a step."""
        name = self.bodies.joints[joint].name
        for number, one in zip(self.joints, self.bodies.joints, strict=True):
            if number >= 0 and name in (one.name, one.leader):
                to = value if one.name == name else one.multiplier * value + one.offset
                self.data.qpos[self.model.jnt_qposadr[number]] = to
        self.mj.mj_kinematics(self.model, self.data)

    def clear_ground(self) -> None:
        """Return without changes: overlaps with the plane are measured only on request."""

    def find_overlaps(self, *, ground: bool = True) -> list[Contact]:
        """Find the interpenetration of each pair of bodies, whether or not contacts are enabled."""
        return self.touches.find_overlaps(ground=ground)

    def list_contacts(self) -> list[Contact]:
        """List the contacts with the plane."""
        return self.touches.list_contacts()

    def has_diverged(self) -> bool:
        """Tell whether MuJoCo warned of values that are not finite: the simulation diverged."""
        bad = self.mj.mjtWarning
        numbers = (bad.mjWARN_BADQPOS, bad.mjWARN_BADQVEL, bad.mjWARN_BADQACC)
        return any(self.data.warning[int(number)].number for number in numbers)

    def set_gravity(self, gravity: tuple[float, float, float], poses: Array) -> None:
        """Set gravity."""
        self.model.opt.gravity = gravity

    def step(self) -> None:
        """Advance by one timestep."""
        self.motors.drive()
        self.mj.mj_step(self.model, self.data)

    def sample(self, time: float) -> Sample:
        """Measure one value for each column of the recording at a time [s]."""
        mj, model, data = self.mj, self.model, self.data
        mj.mj_forward(model, data)
        mj.mj_energyVel(model, data)
        count = len(self.numbers)
        poses, velocities = np.zeros((count, 7)), np.zeros((count, 6))
        poses[:, :3] = data.xpos[self.numbers]
        poses[:, 3:] = data.xquat[self.numbers][:, [1, 2, 3, 0]]
        if not self.numbers[0]:  # the root is the world
            start = self.bodies.start
            poses[0, :3] = start.translation
            poses[0, 3:] = _convert_quaternion(start.rotation)[[1, 2, 3, 0]]
        speed = np.zeros(6)
        for row, (number, body) in enumerate(zip(self.numbers, self.bodies.bodies, strict=True)):
            mj.mj_objectVelocity(model, data, mj.mjtObj.mjOBJ_XBODY, number, speed, 0)
            arm = np.zeros(3) if body.properties is None else body.properties.com
            turned = data.xmat[number].reshape(3, 3) @ arm
            velocities[row, :3] = speed[3:] + np.cross(speed[:3], turned)
            velocities[row, 3:] = speed[:3]
        positions, rates = np.zeros(len(self.joints)), np.zeros(len(self.joints))
        efforts = np.zeros(len(self.joints))
        if self.joints:
            positions = data.qpos[model.jnt_qposadr[self.joints]]
            rates = data.qvel[model.jnt_dofadr[self.joints]]
            efforts = self.motors.get_efforts(model.jnt_dofadr[self.joints])
        up = -np.array(self.settings.compute_gravity_at(math.inf))
        return {
            "times": time,
            "poses": poses,
            "velocities": velocities,
            "positions": np.array(positions),
            "rates": np.array(rates),
            "efforts": np.array(efforts),
            "kinetic": float(data.energy[1]),
            "potential": float(model.body_mass * (1 - model.body_gravcomp) @ (data.xipos @ up))
            + self.bodies.compute_spring_energy(np.array(positions)),
            "depths": self.touches.measure_deepest(),
        }


def _explain_depth() -> str:
    other = name_alternative("mujoco", lambda known: known.lumps_fixed_joints)
    return "the kinematic chain exceeds MuJoCo's XML nesting limit (about 500 links)" + (
        f"; {other} has no such limit for fixed joints" if other else ""
    )


def _convert_quaternion(rotation: Any) -> Array:
    """Convert a rotation matrix to a quaternion w, x, y, z."""
    from ....model.pose import quaternion_from_rotation

    return np.array(quaternion_from_rotation(rotation))


_CLOSE = 1e-5
"""Relative difference of a value from what was written that rounding explains. Chosen, no source.
"""


def _read_back(
    model: Any, bodies: RigidBodyModel, number_of: Mapping[str, int], joints: Sequence[int]
) -> list[ReadBack]:
    """List the differences in mass, center of mass, principal moments, joint and shapes."""
    found: list[ReadBack] = []
    number = 0
    for row, body in enumerate(bodies.bodies):
        if row or not bodies.fixed_base:
            found += _list_mass(model, body, number_of)
        if body.joint is not None:
            found += _list_joint(model, body, joints[number])
            number += 1
        numbers = [number_of[link] for link in body.links if number_of[link]]
        solid = np.isin(model.geom_bodyid, numbers) & (model.geom_contype != 0)
        if numbers and bool(solid.any()) != bool(body.shapes):
            specified, loaded = str(len(body.shapes)), str(int(solid.sum()))
            found.append(ReadBack("link", body.name, "collision shapes", specified, loaded))
    return found


def _list_mass(model: Any, body: RigidBody, number_of: Mapping[str, int]) -> Iterator[ReadBack]:
    parts = []
    for link, pose in body.places.items():
        number = number_of[link]
        if number and (model.body_mass[number] or model.body_inertia[number].any()):
            w, x, y, z = (float(part) for part in model.body_iquat[number])
            turn = np.array(rotation_from_quaternion((w, x, y, z)))
            tensor = turn @ np.diag(model.body_inertia[number]) @ turn.T
            own = SpatialInertia.from_arrays(
                float(model.body_mass[number]), np.array(model.body_ipos[number]), tensor
            )
            parts.append(own.transform(pose))
    got = combine(parts)
    if not math.isclose(got.mass, body.mass, rel_tol=_CLOSE, abs_tol=1e-12):
        yield ReadBack("link", body.name, "mass", f"{body.mass:g} kg", f"{got.mass:g} kg")
    given = body.properties
    if given is None or not body.mass:
        return
    scale = max(map(abs, given.tensor))
    least, middle, most = compute_principal_moments(given.tensor)
    close = 1e-4 if most <= least + middle else TENSOR_ROUNDING
    if not np.allclose(got.tensor, given.tensor, rtol=1e-4, atol=close * scale + 1e-12):
        one, two = (
            " ".join(f"{value:.4g}" for value in compute_principal_moments(part.tensor))
            for part in (given, got)
        )
        yield ReadBack("link", body.name, "principal moments", f"{one} kg·m²", f"{two} kg·m²")
    if not np.allclose(got.com, given.com, atol=1e-6):
        one, two = (" ".join(f"{value:.4g}" for value in part.com) for part in (given, got))
        yield ReadBack("link", body.name, "center of mass", f"{one} m", f"{two} m")


_KINDS = {0: "floating", 1: "spherical", 2: "prismatic", 3: "revolute"}


def _list_joint(model: Any, body: RigidBody, number: int) -> Iterator[ReadBack]:
    joint = body.joint
    assert joint is not None
    if number < 0:
        yield ReadBack("joint", joint.name, "type", joint.kind, "fixed")
        return
    expected = 2 if joint.kind == "prismatic" else 3
    if model.jnt_type[number] != expected:
        got = _KINDS.get(int(model.jnt_type[number]), "another")
        yield ReadBack("joint", joint.name, "type", joint.kind, got)
        return
    limits = (joint.lower, joint.upper)
    if math.isfinite(joint.lower) and math.isfinite(joint.upper) and joint.lower < joint.upper:
        taken = model.jnt_range[number] if model.jnt_limited[number] else (-math.inf, math.inf)
        if not np.allclose(taken, limits, rtol=_CLOSE, atol=1e-6):
            one, two = (f"{part[0]:g} to {part[1]:g}" for part in (limits, taken))
            yield ReadBack("joint", joint.name, "limits", one, two)
    dof = int(model.jnt_dofadr[number])
    for row in RESISTANCE:
        if (value := joint.resistance.get(row.name)) is not None:
            loaded = float(np.ravel(getattr(model, f"dof_{row.mjcf_attribute}")[dof])[0])
            if not math.isclose(value, loaded, rel_tol=_CLOSE, abs_tol=1e-12):
                yield ReadBack("joint", joint.name, row.name, f"{value:g}", f"{loaded:g}")
    if not np.allclose(model.jnt_axis[number], joint.axis, atol=1e-5):
        one, two = (
            " ".join(f"{value:.4g}" for value in part)
            for part in (joint.axis, model.jnt_axis[number])
        )
        yield ReadBack("joint", joint.name, "axis", one, two)
