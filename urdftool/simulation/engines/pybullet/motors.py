"""Apply motors, damping, gains and joint springs in PyBullet, and bodies without gravity."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...control import Pids, is_driven
from ...rigid_bodies import RigidBodyJoint, RigidBodyModel
from ...settings import Settings
from ..base import UNLIMITED_EFFORT

Frame = Callable[[int], tuple[Any, Any]]
"""Position [m] and quaternion x, y, z, w of a body's link frame in the world, by its index."""


class Motors:
    """The motors of a robot's joints.

    Attributes:
        followers: Child link of each mimic joint, that of its leader, and the mimic joint.
        driven: Child links of joints with PID gains.
        pids: PID loops of these joints.
        damped: Simulated damping of each joint by name [N·m·s/rad, N·s/m].
        capped: Simulated damping of joints for which it is less than in the file.
    """

    def __init__(
        self, p: Any, robot: int, bodies: RigidBodyModel, settings: Settings, indices: list[int]
    ) -> None:
        """Set up the motors by the engine's indices of a robot and of the child link of joints."""
        self.p, self.robot, self.indices = p, robot, indices
        self.bodies, self.settings = bodies, settings
        self._make()

    def _make(self) -> None:
        p = self.p
        held = set(self.bodies.held)
        self.followers: list[tuple[int, int, RigidBodyJoint]] = []
        numbers = {
            joint.name: link for link, joint in zip(self.indices, self.bodies.joints, strict=True)
        }
        self.damped = self._limit_stable_damping()
        self.capped: dict[str, float] = {}
        for link, joint in zip(self.indices, self.bodies.joints, strict=True):
            if joint.leader is not None and joint.leader in numbers:
                self.followers.append((link, numbers[joint.leader], joint))
            elif joint.name in held and not is_driven(self.settings.controls, joint.name):
                p.setJointMotorControl2(
                    self.robot,
                    link,
                    p.POSITION_CONTROL,
                    targetPosition=self.bodies.positions[joint.name],
                    force=joint.effort if joint.effort is not None else UNLIMITED_EFFORT,
                )
            else:
                p.setJointMotorControl2(
                    self.robot,
                    link,
                    p.VELOCITY_CONTROL,
                    targetVelocity=0,
                    force=joint.resistance["friction"],
                )
                p.changeDynamics(self.robot, link, jointDamping=self.damped[joint.name])
                if self.damped[joint.name] < joint.resistance["damping"]:
                    self.capped[joint.name] = self.damped[joint.name]
        self._follow()
        self._make_pids()

    def _make_pids(self) -> None:
        """Make the PID loops of the joints with gains of a controller file."""
        controls = self.settings.controls or {}
        some = [
            (link, joint)
            for link, joint in zip(self.indices, self.bodies.joints, strict=True)
            if joint.name in self.bodies.held and is_driven(controls, joint.name)
        ]
        self.driven = [link for link, _ in some]
        self.pids = Pids(
            [controls[joint.name] for _, joint in some],
            [self.bodies.positions[joint.name] for _, joint in some],
            [joint.effort for _, joint in some],
            [joint.kind == "continuous" for _, joint in some],
            self.settings.timestep,
        )

    def drive(self) -> None:
        """Set the motors for the next step."""
        if self.followers:
            self._follow()
        if self.driven:
            self._push()

    def _push(self) -> None:
        """Set the effort of joints with PID gains for the next step."""
        p = self.p
        states = np.array([s[:2] for s in p.getJointStates(self.robot, self.driven)])
        efforts = self.pids.step(states[:, 0], states[:, 1])
        if np.isfinite(efforts).all():
            p.setJointMotorControlArray(
                self.robot, self.driven, p.TORQUE_CONTROL, forces=efforts.tolist()
            )

    def _limit_stable_damping(self) -> dict[str, float]:
        """Limit the damping of each joint to what its explicit integration allows.

        Damping above half of inertia over time step is unstable; the limit still stops the joint
        within two steps.
        """
        if not any(joint.resistance["damping"] for joint in self.bodies.joints):
            return dict.fromkeys((joint.name for joint in self.bodies.joints), 0.0)
        try:
            moved = self._get_inertias()
        except (self.p.error, SystemError):  # it rejects some tensors because of rounding
            moved = self._compute_added_inertias()
        return {
            joint.name: min(joint.resistance["damping"], 0.5 * inertia / self.settings.timestep)
            for joint, inertia in zip(self.bodies.joints, moved, strict=True)
        }

    def _get_inertias(self) -> list[float]:
        """Return the diagonal of the mass matrix at the start [kg·m², kg], by joint."""
        starts = [self.bodies.positions[joint.name] for joint in self.bodies.joints]
        matrix = np.array(self.p.calculateMassMatrix(self.robot, self._sort_by_engine(starts)))
        first = len(matrix) - len(starts)
        return [float(matrix[first + r, first + r]) for r in np.argsort(np.argsort(self.indices))]

    def _compute_added_inertias(self) -> list[float]:
        """Compute the inertia at each joint from the bodies below it [kg·m², kg]."""
        p, bodies = self.p, self.bodies.bodies
        states = [p.getLinkState(self.robot, n, computeForwardKinematics=1) for n in self.indices]
        found = [0.0] * len(states)
        for below, (number, state) in enumerate(zip(self.indices, states, strict=True), 1):
            mass, _, moments = p.getDynamicsInfo(self.robot, number)[:3]
            turn = np.reshape(p.getMatrixFromQuaternion(state[1]), (3, 3))
            above = below
            while above > 0:
                joint, frame = bodies[above].joint, states[above - 1]
                assert joint is not None
                found[above - 1] += mass
                if joint.kind != "prismatic":
                    axes = np.reshape(p.getMatrixFromQuaternion(frame[5]), (3, 3))
                    axis = axes @ np.array(joint.axis)
                    arm = np.cross(axis, np.subtract(state[0], frame[4]))
                    tensor = float(np.array(moments) @ (turn.T @ axis) ** 2)
                    found[above - 1] += mass * (float(arm @ arm) - 1.0) + tensor
                above = bodies[above].parent
        return found

    def _sort_by_engine(self, values: list[float]) -> list[float]:
        """Sort values of joints by the engine's index of the child link."""
        return [value for _, value in sorted(zip(self.indices, values, strict=True))]

    def _follow(self) -> None:
        """Set the target of each mimic joint from the position of its leader."""
        if not self.followers:
            return
        p = self.p
        leaders = p.getJointStates(self.robot, [leader for _, leader, _ in self.followers])
        p.setJointMotorControlArray(
            self.robot,
            [link for link, _, _ in self.followers],
            p.POSITION_CONTROL,
            targetPositions=[
                min(max(joint.multiplier * state[0] + joint.offset, joint.lower), joint.upper)
                for state, (_, _, joint) in zip(leaders, self.followers, strict=True)
            ],
            forces=[
                joint.effort if joint.effort is not None else UNLIMITED_EFFORT
                for _, _, joint in self.followers
            ],
        )


class Forces:
    """Forces of Gazebo extensions for which PyBullet has no setting.

    Gravity acts on all bodies, so a link without gravity gets an upward force equal to its weight.
    A joint spring is an effort in addition to that of the motor.
    """

    def __init__(
        self, p: Any, robot: int, bodies: RigidBodyModel, indices: list[int], frame: Frame
    ) -> None:
        """Store the engine's indices of a robot and of the child link of joints, and its frames."""
        self.p, self.robot, self._frame = p, robot, frame
        self._lifted = [
            (number, indices[number - 1] if number else -1, body.weightless)
            for number, body in enumerate(bodies.bodies)
            if body.weightless is not None and not (number == 0 and bodies.fixed_base)
        ]
        springs = [
            (link, joint.stiffness, joint.spring_rest)
            for link, joint in zip(indices, bodies.joints, strict=True)
            if joint.stiffness
        ]
        self._sprung = [link for link, _, _ in springs]
        self._stiffness = np.array([stiffness for _, stiffness, _ in springs])
        self._rest = np.array([rest for _, _, rest in springs])

    def apply(self, gravity: tuple[float, float, float]) -> None:
        """Apply the forces of the next step, under gravity [m/s²]."""
        p = self.p
        for number, link, part in self._lifted:
            center, _ = p.multiplyTransforms(*self._frame(number), tuple(part.com), (0, 0, 0, 1))
            force = [-part.mass * along for along in gravity]
            p.applyExternalForce(self.robot, link, force, center, p.WORLD_FRAME)
        if self._sprung:
            states = p.getJointStates(self.robot, self._sprung)
            away = self._rest - np.array([state[0] for state in states])
            p.setJointMotorControlArray(
                self.robot, self._sprung, p.TORQUE_CONTROL, forces=(self._stiffness * away).tolist()
            )
