"""Load, step and sample a robot above a plane in PyBullet."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ....errors import ModelError
from ....extras import make_missing_error
from ...recording import Array, Contact, ReadBack
from ...rigid_bodies import RigidBody, RigidBodyModel
from ...settings import Settings
from ..base import Sample
from .contacts import NEARING, ContactReader, forget_contacts, is_lying, round_part
from .motors import Forces, Motors
from .urdf import NAME, compute_principal_frame

_ITERATIONS = 100
"""Iterations of the solver of PyBullet, twice its default of 50. Chosen, no source."""

_STOP = 1e9
"""N·m, N; the default, an impulse of 100 per step, does not hold a load of 5 t. Chosen, no source.
"""

_BREAKING = 0.005
"""M; contacts kept longer are behind a rolling body and accelerate it. Chosen, no source."""


def import_pybullet() -> Any:
    """Import PyBullet.

    Raises:
        MissingDependency: It is not installed.
    """
    try:
        import pybullet
    except ImportError:
        raise make_missing_error("pybullet", "--engine pybullet") from None
    return pybullet


class PyBulletWorld:
    """A robot above a plane, in PyBullet."""

    def __init__(self, p: Any, bodies: RigidBodyModel, settings: Settings, folder: Path) -> None:
        """Load the robot and set its initial state."""
        self.p, self.bodies, self.settings = p, bodies, settings
        p.connect(p.DIRECT)
        p.setTimeStep(settings.timestep)
        p.setPhysicsEngineParameter(
            numSolverIterations=_ITERATIONS,
            deterministicOverlappingPairs=1,
            contactBreakingThreshold=_BREAKING,
        )
        self.plane = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
        p.changeDynamics(self.plane, -1, lateralFriction=1.0, restitution=0.0)
        self.robot = self._load(folder)
        self._name_links()
        self.read_back = _read_back(p, self.robot, bodies, self.link_of)
        self._place()
        self._make_dynamics()
        self.touches = ContactReader(p, self.robot, self.plane, bodies, self.link_of)
        self.motors = Motors(p, self.robot, bodies, settings, self.indices)
        self.forces = Forces(p, self.robot, bodies, self.indices, self.touches.get_frame)
        self.gravity = settings.compute_gravity_at(0.0)
        self.capped = self.motors.capped
        self.version = str(p.getAPIVersion())
        self._rolling: list[int] = []

    def _load(self, folder: Path) -> int:
        p = self.p
        flags = p.URDF_USE_INERTIA_FROM_FILE | p.URDF_USE_IMPLICIT_CYLINDER
        flags |= p.URDF_MAINTAIN_LINK_ORDER
        if self.settings.self_collision:
            flags |= p.URDF_USE_SELF_COLLISION | p.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT
        try:
            number: int = p.loadURDF(
                str(folder / NAME), flags=flags, useFixedBase=self.bodies.fixed_base
            )
        except p.error as error:
            raise ModelError(f"PyBullet cannot load the robot: {error}") from None
        return number

    def _name_links(self) -> None:
        p = self.p
        self.link_of = {0: -1}
        for index in range(p.getNumJoints(self.robot)):
            self.link_of[int(p.getJointInfo(self.robot, index)[1][1:])] = index
        self.indices = [self.link_of[number] for number in range(1, len(self.bodies.bodies))]

    def _place(self) -> None:
        """Set the initial pose of the root's link frame and the initial joint positions."""
        p = self.p
        frame, _ = compute_principal_frame(self.bodies.bodies[0])
        at = self.bodies.start @ frame
        p.resetBasePositionAndOrientation(
            self.robot, at.translation, convert_quaternion(at.rotation)
        )
        for number, joint in zip(self.indices, self.bodies.joints, strict=True):
            p.resetJointState(self.robot, number, self.bodies.positions[joint.name], 0.0)

    def _check_friction(self, number: int, specified: float) -> None:
        body = self.bodies.bodies[number]
        loaded = self.p.getDynamicsInfo(self.robot, self.link_of[number])[1]
        if body.shapes and abs(loaded - specified) > 1e-9:
            name = body.name
            self.read_back.append(
                ReadBack("link", name, "friction", f"{specified:g}", f"{loaded:g}")
            )

    def _make_dynamics(self) -> None:
        p, settings = self.p, self.settings
        # for the whole robot, in separate calls: for a link, they reset the other options
        p.changeDynamics(self.robot, -1, linearDamping=0.0, angularDamping=0.0)
        p.changeDynamics(self.robot, -1, maxJointVelocity=1e6)
        for number, body in enumerate(self.bodies.bodies):
            surface = body.surface
            options: dict[str, float] = {
                "lateralFriction": surface.get("friction", settings.friction),
                "restitution": 0.0,
                "jointDamping": 0.0,
            }
            if "contact_stiffness" in surface:
                options["contactStiffness"] = surface["contact_stiffness"]
                options["contactDamping"] = surface.get("contact_damping") or 1.0
            p.changeDynamics(self.robot, self.link_of[number], **options)
            if number:
                p.changeDynamics(self.robot, self.link_of[number], jointLimitForce=_STOP)
            self._check_friction(number, options["lateralFriction"])

    def clear_ground(self) -> None:
        """Move the robot up, away from the plane."""
        at, turn = self.p.getBasePositionAndOrientation(self.robot)
        up = (at[0], at[1], at[2] + 10 * max(1.0, self.bodies.size))
        self.p.resetBasePositionAndOrientation(self.robot, up, turn)

    def set_joint_position(self, joint: int, value: float) -> None:
        """Set the position of a joint [rad, m], and of those that mimic it, without a step."""
        self.p.resetJointState(self.robot, self.indices[joint], value, 0.0)
        for link, leader, follower in self.motors.followers:
            if leader == self.indices[joint]:
                to = follower.multiplier * value + follower.offset
                self.p.resetJointState(self.robot, link, to, 0.0)
        self.p.performCollisionDetection()

    def list_contacts(self) -> list[Contact]:
        """List the contacts with the plane."""
        return self.touches.list_contacts()

    def find_overlaps(self, *, ground: bool = True) -> list[Contact]:
        """Find the interpenetration of each pair of bodies, whether or not contacts are enabled."""
        return self.touches.find_overlaps(ground=ground)

    def has_diverged(self) -> bool:
        """Return False: PyBullet does not report divergence, and the driver checks the values."""
        return False

    def set_gravity(self, gravity: tuple[float, float, float], poses: Array) -> None:
        """Set gravity, and find the links that may roll."""
        self._rolling = self._round_links(poses)
        self.p.setGravity(*gravity)
        self.gravity = gravity

    def step(self) -> None:
        """Advance by one timestep."""
        self.motors.drive()
        self.forces.apply(self.gravity)
        forget_contacts(self.p, self.robot, self.plane, self._rolling)
        self.p.stepSimulation()

    def _round_links(self, poses: Array) -> list[int]:
        """Find the links that may roll, at these poses of all bodies."""
        if not hasattr(self, "_round"):
            found = [(number, round_part(body)) for number, body in enumerate(self.bodies.bodies)]
            self._round = [(number, part) for number, part in found if part is not None]
        return [
            self.link_of[number]
            for number, (axes, reach) in self._round
            if poses[number, 2] < reach + NEARING and is_lying(axes, poses[number, 3:])
        ]

    def sample(self, time: float) -> Sample:
        """Measure one value for each column of the recording at a time [s]."""
        p = self.p
        bodies = self.bodies.bodies
        poses, velocities = np.zeros((len(bodies), 7)), np.zeros((len(bodies), 6))
        at, turn = p.getBasePositionAndOrientation(self.robot)
        linear, angular = p.getBaseVelocity(self.robot)
        back = p.getDynamicsInfo(self.robot, -1)
        inverse = p.invertTransform(back[3], back[4])
        where, how = p.multiplyTransforms(at, turn, *inverse)
        poses[0, :3], poses[0, 3:] = where, how
        velocities[0, :3], velocities[0, 3:] = linear, angular
        coms = np.zeros((len(bodies), 7))
        coms[0, :3], coms[0, 3:] = at, turn
        if self.indices:
            states = p.getLinkStates(self.robot, self.indices, computeLinkVelocity=1)
            for number, state in enumerate(states, 1):
                coms[number, :3], coms[number, 3:] = state[0], state[1]
                poses[number, :3], poses[number, 3:] = state[4], state[5]
                velocities[number, :3], velocities[number, 3:] = state[6], state[7]
            joints = np.array(
                [(a, b, d) for a, b, _, d in p.getJointStates(self.robot, self.indices)]
            )
            for link, effort in zip(self.motors.driven, self.motors.pids.efforts, strict=True):
                joints[self.indices.index(link), 2] = effort
        else:
            joints = np.zeros((0, 3))
        kinetic, potential = self._compute_energy(coms, velocities)
        potential -= self._compute_weightless_energy(poses)
        potential += self.bodies.compute_spring_energy(joints[:, 0])
        touching = p.getContactPoints(bodyA=self.robot, bodyB=self.plane)
        return {
            "times": time,
            "poses": poses,
            "velocities": velocities,
            "positions": joints[:, 0],
            "rates": joints[:, 1],
            "efforts": joints[:, 2],
            "kinetic": kinetic,
            "potential": potential,
            "depths": max((-point[8] for point in touching), default=-math.inf),
        }

    def _compute_energy(self, coms: Array, velocities: Array) -> tuple[float, float]:
        """Compute kinetic and potential energy [J] from the frames of the centers of mass."""
        if not hasattr(self, "_masses"):
            frames = [compute_principal_frame(body) for body in self.bodies.bodies]
            self._masses = np.array([body.mass for body in self.bodies.bodies])
            self._moments = np.array([moments for _, moments in frames])
            self._up = -np.array(self.settings.compute_gravity_at(math.inf))
        q, w = coms[:, 3:6], velocities[:, 3:]
        # ω in the principal frame: the conjugate quaternion turns it
        t = 2 * np.cross(-q, w)
        local = w + coms[:, 6:] * t + np.cross(-q, t)
        kinetic = 0.5 * float(self._masses @ (velocities[:, :3] ** 2).sum(axis=1))
        kinetic += 0.5 * float((self._moments * local**2).sum())
        return kinetic, float(self._masses @ (coms[:, :3] @ self._up))

    def _compute_weightless_energy(self, poses: Array) -> float:
        """Compute the potential energy [J] of the mass on which gravity does not act."""
        up, total = -np.array(self.settings.compute_gravity_at(math.inf)), 0.0
        for body, pose in zip(self.bodies.bodies, poses, strict=True):
            part = body.weightless
            if part is not None:
                center, _ = self.p.multiplyTransforms(
                    pose[:3].tolist(), pose[3:].tolist(), tuple(part.com), (0, 0, 0, 1)
                )
                total += part.mass * float(np.array(center) @ up)
        return total


def convert_quaternion(rotation: Any) -> tuple[float, float, float, float]:
    """Convert a rotation matrix to a quaternion x, y, z, w."""
    from ....model.pose import quaternion_from_rpy, rpy_from_rotation

    w, x, y, z = quaternion_from_rpy(rpy_from_rotation(rotation))
    return x, y, z, w


_CLOSE = 1e-5
"""Relative difference of a value from what was written that rounding explains. Chosen, no source.
"""


def _read_back(
    p: Any, robot: int, bodies: RigidBodyModel, link_of: Mapping[int, int]
) -> list[ReadBack]:
    """List the differences in mass, center of mass, principal moments, joint and shapes."""
    found: list[ReadBack] = []
    for number, body in enumerate(bodies.bodies):
        if number not in link_of:
            found.append(ReadBack("link", body.name, "link", "a body", "nothing"))
            continue
        link = link_of[number]
        found += _list_mass(p.getDynamicsInfo(robot, link), body, bodies.fixed_base and number == 0)
        if body.joint is not None:
            found += _list_joint(p.getJointInfo(robot, link), body)
        count = sum(len(shape.pieces) or 1 for shape in body.shapes)
        shapes = p.getCollisionShapeData(robot, link)
        if bool(shapes) != bool(body.shapes):
            found.append(
                ReadBack("link", body.name, "collision shapes", str(count), str(len(shapes)))
            )
    return found


def _list_mass(info: Any, body: RigidBody, fixed_base: bool) -> Iterator[ReadBack]:
    frame, moments = compute_principal_frame(body)
    if fixed_base:
        return
    if not math.isclose(info[0], body.mass, rel_tol=_CLOSE, abs_tol=1e-12):
        yield ReadBack("link", body.name, "mass", f"{body.mass:g} kg", f"{info[0]:g} kg")
    if not body.mass:
        return
    scale = max(map(abs, moments))
    if not np.allclose(info[2], moments, rtol=_CLOSE, atol=_CLOSE * scale):
        given, got = (" ".join(f"{value:.4g}" for value in part) for part in (moments, info[2]))
        yield ReadBack("link", body.name, "principal moments", f"{given} kg·m²", f"{got} kg·m²")
    if not np.allclose(info[3], frame.translation, atol=1e-6):
        given, got = (" ".join(f"{value:.4g}" for value in p) for p in (frame.translation, info[3]))
        yield ReadBack("link", body.name, "center of mass", f"{given} m", f"{got} m")


def _list_joint(info: Any, body: RigidBody) -> Iterator[ReadBack]:
    joint = body.joint
    assert joint is not None
    kind = 1 if joint.kind == "prismatic" else 0
    if info[2] != kind:
        names = {0: "revolute", 1: "prismatic", 4: "fixed"}
        got = names.get(info[2], str(info[2]))
        yield ReadBack("joint", joint.name, "type", joint.kind, got)
        return
    if math.isfinite(joint.lower) and math.isfinite(joint.upper):
        if not np.allclose(info[8:10], (joint.lower, joint.upper), atol=1e-6):
            yield ReadBack(
                "joint",
                joint.name,
                "limits",
                f"{joint.lower:g} to {joint.upper:g}",
                f"{info[8]:g} to {info[9]:g}",
            )
    frame, _ = compute_principal_frame(body)
    axis = np.array(frame.rotation).T @ np.array(joint.axis)
    if not np.allclose(info[13], axis, atol=1e-5):
        given, got = (" ".join(f"{value:.4g}" for value in part) for part in (axis, info[13]))
        yield ReadBack("joint", joint.name, "axis", given, got)
