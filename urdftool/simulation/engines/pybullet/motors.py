"""What holds and drives joints in PyBullet: motors within their effort, damping, gains."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...bodies import Bodies, JointOf
from ...control import Pids, driven
from ...settings import Settings
from ..base import UNLIMITED_EFFORT


class Motors:
    """Of one robot.

    Attributes:
        followers: The link of each joint that mimics another, that one's, and the joint.
        driven: Links of joints that gains drive.
        pids: Those gains.
        damped: The damping that each joint gets [N·m·s/rad, N·s/m].
        capped: Of those joints whose damping is less than the file says.
    """

    def __init__(
        self, p: Any, robot: int, bodies: Bodies, settings: Settings, indices: list[int]
    ) -> None:
        """Take the engine's number of a robot and of the link of each joint, and set them up."""
        self.p, self.robot, self.indices = p, robot, indices
        self.bodies, self.settings = bodies, settings
        self._make()

    def _make(self) -> None:
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
                    force=joint.effort if joint.effort is not None else UNLIMITED_EFFORT,
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

    def drive(self) -> None:
        """What is to be done before each step."""
        if self.followers:
            self._follow()
        if self.driven:
            self._push()

    def _push(self) -> None:
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
        try:
            moved = self._inertias()
        except (self.p.error, SystemError):  # it takes rounding for a tensor that is none
            moved = self._added_inertias()
        return {
            joint.name: min(joint.damping, 0.5 * inertia / self.settings.timestep)
            for joint, inertia in zip(self.bodies.joints, moved, strict=True)
        }

    def _inertias(self) -> list[float]:
        """What each joint moves, at the start [kg·m², kg]: the diagonal of the mass matrix."""
        starts = [self.bodies.positions[joint.name] for joint in self.bodies.joints]
        matrix = np.array(self.p.calculateMassMatrix(self.robot, self._in_order(starts)))
        first = len(matrix) - len(starts)
        return [float(matrix[first + r, first + r]) for r in np.argsort(np.argsort(self.indices))]

    def _added_inertias(self) -> list[float]:
        """The same, added up from the bodies below each joint."""
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

    def _in_order(self, values: list[float]) -> list[float]:
        """Values by joint as the engine numbers its links."""
        return [value for _, value in sorted(zip(self.indices, values, strict=True))]

    def _follow(self) -> None:
        """Send each joint that mimics another where that one is."""
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
