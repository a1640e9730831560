"""PyBullet, without its silent habits: the one file that knows this engine.

Undone are: tensors computed from shapes instead of read, a motor that holds every joint, damping of
bodies and joints that nobody wrote, cylinders made of flat sides, a base without mass that is
nailed down unasked (``Bodies.nailed`` says it), joints without limits taken for locked.
"""

from __future__ import annotations

import math
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from ..errors import MissingDependency, ModelError
from .bodies import Bodies, JointOf
from .bullet_read import read_back
from .bullet_rolling import NEARING, forget_contacts, is_lying, round_part
from .control import Pids, driven
from .recording import GROUND, Array, Contact, ReadBack, Recording
from .settings import Settings
from .stillness import PATIENCE, Stillness
from .urdf import NAME, principal_frame

SAMPLE = 1 / 30
"""Time between samples, as near as the timestep allows [s]."""

MOST_JOINTS = 120
"""Its messages have room for 128 degrees of freedom, of which the root takes seven."""

UNBOUND = 1e6
"""The effort of a motor for whose joint the file says none [N·m, N]."""

RUNAWAY = 1e3  # m/s or sizes away
_ITERATIONS = 100
_NEAR = 1e-4  # m; of two boxes it finds nothing when it is asked for a distance of zero
_BREAKING = 0.005  # m; contacts kept longer lag behind what rolls, and push it on


def bullet_module() -> Any:
    """PyBullet.

    Raises:
        MissingDependency: It is not installed.
    """
    try:
        import pybullet
    except ImportError:
        raise MissingDependency(
            "PyBullet is not installed; it has wheels up to Python 3.11 only: use one of those, "
            "or 'pip install urdftool[mujoco]' and --engine mujoco"
        ) from None
    return pybullet


def run(bodies: Bodies, settings: Settings, folder: Path) -> Recording:
    """Spawn a robot and let it settle.

    Args:
        bodies: The robot; ``folder`` holds it as ``urdf.write_folder`` wrote it.
        settings: How, and for how long.
        folder: Where the URDF is.

    Raises:
        MissingDependency: PyBullet is not installed.
        ModelError: It does not read the robot.
    """
    if len(bodies.joints) > MOST_JOINTS:
        raise ModelError(
            f"the robot has {len(bodies.joints)} moving joints; PyBullet takes at most "
            f"{MOST_JOINTS}"
        )
    world = World(bullet_module(), bodies, settings, folder)
    return world.settle()


class World:
    """A robot above a plane, in PyBullet.

    Attributes:
        p: The library.
        robot: Its number of the robot.
        plane: Its number of the plane.
        link_of: The engine's link of each body; -1 is the root.
    """

    def __init__(self, p: Any, bodies: Bodies, settings: Settings, folder: Path) -> None:
        """Set the scene; nothing moves yet."""
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
        self.read_back = read_back(p, self.robot, bodies, self.link_of)
        self._place()
        self._make_dynamics()
        self._make_motors()

    def _load(self, folder: Path) -> int:
        p = self.p
        flags = p.URDF_USE_INERTIA_FROM_FILE | p.URDF_USE_IMPLICIT_CYLINDER
        flags |= p.URDF_MAINTAIN_LINK_ORDER
        flags |= p.URDF_USE_SELF_COLLISION | p.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT
        try:
            number: int = p.loadURDF(
                str(folder / NAME), flags=flags, useFixedBase=self.bodies.nailed
            )
        except p.error as error:
            raise ModelError(f"PyBullet does not read the robot: {error}") from None
        return number

    def _name_links(self) -> None:
        p = self.p
        self.link_of = {0: -1}
        for index in range(p.getNumJoints(self.robot)):
            self.link_of[int(p.getJointInfo(self.robot, index)[1][1:])] = index
        self.body_of = {link: body for body, link in self.link_of.items()}
        self.indices = [self.link_of[number] for number in range(1, len(self.bodies.bodies))]

    def _place(self) -> None:
        """Put the root's link frame where it starts, and each joint."""
        p = self.p
        frame, _ = principal_frame(self.bodies.bodies[0])
        at = self.bodies.start @ frame
        p.resetBasePositionAndOrientation(self.robot, at.translation, quaternion(at.rotation))
        for number, joint in zip(self.indices, self.bodies.joints, strict=True):
            p.resetJointState(self.robot, number, self.bodies.positions[joint.name], 0.0)

    def _check_friction(self, number: int, said: float) -> None:
        body = self.bodies.bodies[number]
        got = self.p.getDynamicsInfo(self.robot, self.link_of[number])[1]
        if body.shapes and abs(got - said) > 1e-9:
            name = body.name
            self.read_back.append(ReadBack("link", name, "friction", f"{said:g}", f"{got:g}"))

    def _make_dynamics(self) -> None:
        p, settings = self.p, self.settings
        # of the whole robot, and in calls of their own: for a link they undo what comes with them
        p.changeDynamics(self.robot, -1, linearDamping=0.0, angularDamping=0.0)
        p.changeDynamics(self.robot, -1, maxJointVelocity=1e6)
        for number, body in enumerate(self.bodies.bodies):
            surface = body.surface
            options: dict[str, float] = {
                "lateralFriction": settings.friction
                if surface.friction is None
                else surface.friction,
                "restitution": 0.0,
                "jointDamping": 0.0,
            }
            if surface.stiffness is not None:
                options["contactStiffness"] = surface.stiffness
                options["contactDamping"] = surface.damping or 1.0
            p.changeDynamics(self.robot, self.link_of[number], **options)
            self._check_friction(number, options["lateralFriction"])
        if not settings.self_collision:
            count = len(self.bodies.bodies)
            for one in range(count):
                for other in range(one):
                    p.setCollisionFilterPair(
                        self.robot, self.robot, self.link_of[one], self.link_of[other], 0
                    )

    def _make_motors(self) -> None:
        p = self.p
        held = set(self.bodies.held)
        self.followers: list[tuple[int, int, JointOf]] = []
        numbers = {
            joint.name: link for link, joint in zip(self.indices, self.bodies.joints, strict=True)
        }
        self.damped = self._stable_damping()
        self.capped: dict[str, float] = {}
        for link, joint in zip(self.indices, self.bodies.joints, strict=True):
            if joint.leader is not None and joint.leader in numbers:
                self.followers.append((link, numbers[joint.leader], joint))
            elif joint.name in held and not driven(self.settings.controls, joint.name):
                p.setJointMotorControl2(
                    self.robot,
                    link,
                    p.POSITION_CONTROL,
                    targetPosition=self.bodies.positions[joint.name],
                    force=joint.effort if joint.effort is not None else UNBOUND,
                )
            else:
                p.setJointMotorControl2(
                    self.robot, link, p.VELOCITY_CONTROL, targetVelocity=0, force=joint.friction
                )
                p.changeDynamics(self.robot, link, jointDamping=self.damped[joint.name])
                if self.damped[joint.name] < joint.damping:
                    self.capped[joint.name] = self.damped[joint.name]
        self._follow()
        self._make_pids()

    def _make_pids(self) -> None:
        """The joints that gains of a file drive, by their torque."""
        controls = self.settings.controls or {}
        some = [
            (link, joint)
            for link, joint in zip(self.indices, self.bodies.joints, strict=True)
            if joint.name in self.bodies.held and driven(controls, joint.name)
        ]
        self.driven = [link for link, _ in some]
        self.pids = Pids(
            [controls[joint.name] for _, joint in some],
            [self.bodies.positions[joint.name] for _, joint in some],
            [joint.effort for _, joint in some],
            [joint.kind == "continuous" for _, joint in some],
            self.settings.timestep,
        )

    def _drive(self) -> None:
        """Give each joint that gains drive its effort for the next step."""
        p = self.p
        states = np.array([s[:2] for s in p.getJointStates(self.robot, self.driven)])
        efforts = self.pids.step(states[:, 0], states[:, 1])
        if np.isfinite(efforts).all():
            p.setJointMotorControlArray(
                self.robot, self.driven, p.TORQUE_CONTROL, forces=efforts.tolist()
            )

    def _stable_damping(self) -> dict[str, float]:
        """The damping of each joint, no more than its explicit integration bears.

        Beyond half of inertia over timestep it would drive the joint instead of braking it; what is
        left still stops it within two steps.
        """
        if not any(joint.damping for joint in self.bodies.joints):
            return dict.fromkeys((joint.name for joint in self.bodies.joints), 0.0)
        zeros = [self.bodies.positions[joint.name] for joint in self.bodies.joints]
        matrix = np.array(self.p.calculateMassMatrix(self.robot, self._in_order(zeros)))
        first = len(matrix) - len(zeros)
        ranks = np.argsort(np.argsort(self.indices))
        return {
            joint.name: min(
                joint.damping, 0.5 * matrix[first + rank, first + rank] / self.settings.timestep
            )
            for joint, rank in zip(self.bodies.joints, ranks, strict=True)
        }

    def _in_order(self, values: list[float]) -> list[float]:
        """Values by joint as the engine numbers its links."""
        return [value for _, value in sorted(zip(self.indices, values, strict=True))]

    def _follow(self) -> None:
        """Send each joint that mimics another where that one is."""
        p = self.p
        for link, leader, joint in self.followers:
            position = p.getJointState(self.robot, leader)[0]
            p.setJointMotorControl2(
                self.robot,
                link,
                p.POSITION_CONTROL,
                targetPosition=min(
                    max(joint.multiplier * position + joint.offset, joint.lower), joint.upper
                ),
                force=joint.effort if joint.effort is not None else UNBOUND,
            )

    def lift(self) -> None:
        """Take the robot off the plane, which is not to matter."""
        at, turn = self.p.getBasePositionAndOrientation(self.robot)
        up = (at[0], at[1], at[2] + 10 * max(1.0, self.bodies.size))
        self.p.resetBasePositionAndOrientation(self.robot, up, turn)

    def put(self, joint: int, value: float) -> None:
        """Put a joint somewhere, with those that mimic it, without a step."""
        self.p.resetJointState(self.robot, self.indices[joint], value, 0.0)
        for link, leader, follower in self.followers:
            if leader == self.indices[joint]:
                to = follower.multiplier * value + follower.offset
                self.p.resetJointState(self.robot, link, to, 0.0)
        self.p.performCollisionDetection()

    def settle(self) -> Recording:
        """Step until nothing moves, the time is over, or the robot is lost."""
        p, settings = self.p, self.settings
        every = max(1, round(SAMPLE / settings.timestep))
        steps = max(1, round(settings.duration / settings.timestep))
        watch = Stillness(self.bodies.size, every * settings.timestep)
        start_contacts = self.overlaps()
        samples = [self._sample(0.0)]
        began = perf_counter()
        still: float | None = None
        ended, done = "time", 0
        while done < steps and ended == "time":
            rolling = self._rolling(samples[-1]["poses"])
            p.setGravity(*settings.gravity_at(done * settings.timestep))
            for _ in range(min(every, steps - done)):
                if self.followers:
                    self._follow()
                if self.driven:
                    self._drive()
                forget_contacts(p, self.robot, self.plane, rolling)
                p.stepSimulation()
                done += 1
            sample = self._sample(done * settings.timestep)
            samples.append(sample)
            if not self._is_sane(sample):
                ended = "lost"
                break
            still = watch.add(sample["times"], sample["poses"], sample["positions"])
            if still is not None and sample["times"] > PATIENCE:
                ended = "still"
        seconds = perf_counter() - began
        columns = {name: np.array([sample[name] for sample in samples]) for name in samples[0]}
        columns["potential"] = columns["potential"] - columns["potential"][0]
        return Recording(
            engine=f"PyBullet {p.getAPIVersion()}",
            bodies=tuple(body.name for body in self.bodies.bodies),
            joints=tuple(joint.name for joint in self.bodies.joints),
            **columns,
            held=self.bodies.held,
            targets={name: self.bodies.positions[name] for name in self.bodies.held},
            start_contacts=start_contacts,
            contacts=self._contacts() + self.overlaps(ground=False),
            read_back=self.read_back,
            capped=self.capped,
            still_since=still,
            ended=ended,
            seconds=seconds,
            steps=done,
        )

    def _rolling(self, poses: Array) -> list[int]:
        """The links that may roll, at these poses of all bodies."""
        if not hasattr(self, "_round"):
            found = [(number, round_part(body)) for number, body in enumerate(self.bodies.bodies)]
            self._round = [(number, part) for number, part in found if part is not None]
        return [
            self.link_of[number]
            for number, (axes, reach) in self._round
            if poses[number, 2] < reach + NEARING and is_lying(axes, poses[number, 3:])
        ]

    def _is_sane(self, sample: dict[str, Any]) -> bool:
        poses = sample["poses"]
        far = RUNAWAY * max(1.0, self.bodies.size)
        return bool(
            np.isfinite(poses).all()
            and np.isfinite(sample["kinetic"])
            and np.abs(poses[:, :2]).max() < far
        )

    def _sample(self, time: float) -> dict[str, Any]:
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
            for link, effort in zip(self.driven, self.pids.efforts, strict=True):
                joints[self.indices.index(link), 2] = effort
        else:
            joints = np.zeros((0, 3))
        kinetic, potential = self._energy(coms, velocities)
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

    def _energy(self, coms: Array, velocities: Array) -> tuple[float, float]:
        """Kinetic and potential energy [J] from the frames of the centres of mass."""
        if not hasattr(self, "_masses"):
            frames = [principal_frame(body) for body in self.bodies.bodies]
            self._masses = np.array([body.mass for body in self.bodies.bodies])
            self._moments = np.array([moments for _, moments in frames])
            self._up = -np.array(self.settings.gravity_at(math.inf))
        q, w = coms[:, 3:6], velocities[:, 3:]
        # ω in the principal frame: the conjugate quaternion turns it
        t = 2 * np.cross(-q, w)
        local = w + coms[:, 6:] * t + np.cross(-q, t)
        kinetic = 0.5 * float(self._masses @ (velocities[:, :3] ** 2).sum(axis=1))
        kinetic += 0.5 * float((self._moments * local**2).sum())
        return kinetic, float(self._masses @ (coms[:, :3] @ self._up))

    def _contacts(self) -> list[Contact]:
        """What touches the plane now."""
        return [
            self._contact(point, GROUND)
            for point in self.p.getContactPoints(bodyA=self.robot, bodyB=self.plane)
        ]

    def _contact(self, point: Any, other: str) -> Contact:
        return Contact(
            self._link(self.body_of[point[3]], point[5]),
            other,
            -point[8],
            point[9],
            tuple(point[6]),
            tuple(point[7]),
        )

    def _link(self, number: int, at: tuple[float, float, float]) -> str:
        """Which link of a body has the shape that is nearest to a point in the world."""
        body = self.bodies.bodies[number]
        if len({shape.link for shape in body.shapes}) < 2:
            return body.shapes[0].link if body.shapes else body.name
        where, turn = self._frame(number)
        local, _ = self.p.multiplyTransforms(*self.p.invertTransform(where, turn), at, (0, 0, 0, 1))

        def distance(shape: Any) -> float:
            low, high = shape.bounds()
            outside = np.maximum(0.0, np.maximum(low - local, np.array(local) - high))
            return float(np.linalg.norm(outside))

        return min(body.shapes, key=distance).link

    def _frame(self, number: int) -> tuple[Any, Any]:
        if number:
            state = self.p.getLinkState(self.robot, self.link_of[number])
            return state[4], state[5]
        at, turn = self.p.getBasePositionAndOrientation(self.robot)
        back = self.p.getDynamicsInfo(self.robot, -1)
        where: tuple[Any, Any] = self.p.multiplyTransforms(
            at, turn, *self.p.invertTransform(back[3], back[4])
        )
        return where

    def overlaps(self, *, ground: bool = True) -> list[Contact]:
        """The deepest place of each two bodies that are in each other, whether they push or not."""
        p, found = self.p, []
        solid = [n for n, body in enumerate(self.bodies.bodies) if body.shapes]
        boxes = {n: np.array(p.getAABB(self.robot, self.link_of[n])) for n in solid}
        for position, one in enumerate(solid):
            for other in solid[:position]:
                a, b = boxes[one], boxes[other]
                if (a[0] > b[1]).any() or (b[0] > a[1]).any():
                    continue
                points = p.getClosestPoints(
                    self.robot, self.robot, _NEAR, self.link_of[one], self.link_of[other]
                )
                if points and min(point[8] for point in points) < 0:
                    deepest = min(points, key=lambda point: point[8])
                    name = self._link(other, deepest[6])
                    found.append(self._contact(deepest, name))
            if ground and boxes[one][0][2] < 0:
                points = p.getClosestPoints(self.robot, self.plane, _NEAR, self.link_of[one], -1)
                if points:
                    found.append(self._contact(min(points, key=lambda point: point[8]), GROUND))
        return found


def quaternion(rotation: Any) -> tuple[float, float, float, float]:
    """The quaternion x, y, z, w of a rotation matrix."""
    from ..model.pose import quaternion_of_rpy, rpy_of_rotation

    w, x, y, z = quaternion_of_rpy(rpy_of_rotation(rotation))
    return x, y, z, w
