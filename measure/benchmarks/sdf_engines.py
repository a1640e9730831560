"""Two engines that have nothing of urdftool: pinocchio reads the URDF, Drake the SDF."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex

logging.getLogger("drake").setLevel(logging.ERROR)


@dataclass
class State:
    """What an engine says of a robot in one configuration, in the frame of its root link."""

    frames: dict[str, np.ndarray] = field(default_factory=dict)
    mass_matrix: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    weight: np.ndarray = field(default_factory=lambda: np.zeros(0))
    mass: float = 0.0
    center: np.ndarray = field(default_factory=lambda: np.zeros(3))
    inertia: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))


class Source:
    """A URDF in pinocchio: with a fixed base for the joints, with a free one for the whole."""

    def __init__(self, path: str | Path) -> None:
        self.model = pin.buildModelFromUrdf(str(path))
        self.free = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
        self.names = [str(name) for name in list(self.model.names)[1:]]

    def configurations(self, count: int) -> list[dict[str, float]]:
        random = np.random.default_rng(0)
        result: list[dict[str, float]] = [dict.fromkeys(self.names, 0.0)]
        for _ in range(count):
            q = {}
            for name in self.names:
                joint = self.model.joints[self.model.getJointId(name)]
                low, high = (
                    limit[joint.idx_q]
                    for limit in (self.model.lowerPositionLimit, self.model.upperPositionLimit)
                )
                if joint.nq == 2 or not np.isfinite([low, high]).all() or high - low > 1e6:
                    low, high = -np.pi, np.pi
                q[name] = float(random.uniform(low, high))
            result.append(q)
        return result

    def state(self, q: dict[str, float], names: list[str]) -> State:
        data, vector = self.model.createData(), self._vector(self.model, q)
        pin.framesForwardKinematics(self.model, data, vector)
        state = State()
        for index, frame in enumerate(self.model.frames):
            if frame.type == pin.FrameType.BODY:
                state.frames[frame.name] = data.oMf[index].homogeneous
        full = pin.crba(self.model, data, vector)
        full = np.triu(full) + np.triu(full, 1).T
        rows = [self.model.joints[self.model.getJointId(name)].idx_v for name in names]
        state.mass_matrix = full[np.ix_(rows, rows)]
        state.weight = pin.computeGeneralizedGravity(self.model, data, vector)[rows]
        self._whole(q, state)
        return state

    def limits(self, name: str) -> dict[str, float]:
        m, joint = self.model, self.model.joints[self.model.getJointId(name)]
        values = {
            "effort": m.upperEffortLimit[joint.idx_v],
            "velocity": m.upperVelocityLimit[joint.idx_v],
            "damping": m.damping[joint.idx_v],
            "friction": m.upperDryFrictionLimit[joint.idx_v],
        }
        if joint.nq == 1:
            values["lower"] = m.lowerPositionLimit[joint.idx_q]
            values["upper"] = m.upperPositionLimit[joint.idx_q]
        return {key: float(value) for key, value in values.items()}

    def _vector(self, model: pin.Model, q: dict[str, float]) -> np.ndarray:
        vector = pin.neutral(model)
        for name, value in q.items():
            joint = model.joints[model.getJointId(name)]
            if joint.nq == 2:
                vector[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
            else:
                vector[joint.idx_q] = value
        return vector

    def _whole(self, q: dict[str, float], state: State) -> None:
        data, vector = self.free.createData(), self._vector(self.free, q)
        pin.ccrba(self.free, data, vector, np.zeros(self.free.nv))
        state.mass, state.center = float(data.Ig.mass), np.array(data.com[0])
        state.inertia = np.array(data.Ig.inertia)


class Target:
    """An SDF in Drake, its base free and put where the source's root is."""

    def __init__(self, path: str | Path, root: str) -> None:
        self.plant = MultibodyPlant(0.0)
        Parser(self.plant).AddModels(str(path))
        self.plant.Finalize()
        self.context = self.plant.CreateDefaultContext()
        self.root = root
        self.joints = {
            joint.name(): joint
            for joint in map(self.plant.get_joint, self.plant.GetJointIndices())
            if joint.num_velocities() == 1
        }

    def state(self, q: dict[str, float], names: list[str], frames: list[str]) -> State:
        plant, context = self.plant, self.context
        for name, value in q.items():
            if name in self.joints:
                plant.SetPositions(context, *self._position(name, value))
        for index in plant.GetFloatingBaseBodies():
            body = plant.get_body(index)
            plant.SetFreeBodyPose(context, body, RigidTransform())
            offset = plant.GetFrameByName(self.root).CalcPoseInWorld(context)
            plant.SetFreeBodyPose(context, body, offset.inverse())
        state = State()
        for name in frames:
            if plant.HasFrameNamed(name):
                state.frames[name] = (
                    plant.GetFrameByName(name).CalcPoseInWorld(context).GetAsMatrix4()
                )
        rows = [self.joints[name].velocity_start() for name in names]
        state.mass_matrix = plant.CalcMassMatrix(context)[np.ix_(rows, rows)]
        state.weight = -plant.CalcGravityGeneralizedForces(context)[rows]
        state.mass = plant.CalcTotalMass(context)
        state.center = plant.CalcCenterOfMassPositionInWorld(context)
        bodies = [
            plant.get_body(index)
            for instance in range(2, plant.num_model_instances())
            for index in plant.GetBodyIndices(ModelInstanceIndex(instance))
        ]
        spatial = plant.CalcSpatialInertia(
            context, plant.world_frame(), [body.index() for body in bodies]
        )
        about = spatial.Shift(spatial.get_com())
        state.inertia = about.CalcRotationalInertia().CopyToFullMatrix3()
        return state

    def limits(self, name: str) -> dict[str, float]:
        """Range of a joint, and the force it has at most."""
        joint = self.joints[name]
        found = {}
        low, high = joint.position_lower_limit(), joint.position_upper_limit()
        found["lower"], found["upper"] = float(low), float(high)
        for index in self.plant.GetJointActuatorIndices():
            actuator = self.plant.get_joint_actuator(index)
            if actuator.joint().name() == name:
                found["effort"] = float(actuator.effort_limit())
        return found

    def _position(self, name: str, value: float) -> tuple:
        positions = self.plant.GetPositions(self.context)
        positions[self.joints[name].position_start()] = value
        return (positions,)
