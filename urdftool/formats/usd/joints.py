"""Joints of a stage: frames, limits, drives, friction, and what only Newton or PhysX read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from pxr import Gf, Sdf, Usd, UsdPhysics

from ...diagnostic import Severity
from ...model.elements import BALL_TYPES, Joint, Vector
from ...model.kinematics import MOVABLE, get_limits
from ...model.numbers import remove_noise
from ...model.pose import (
    IDENTITY,
    Pose,
    Rotation,
    compute_cross,
    compute_dot,
    compute_norm,
    rotation_from_quaternion,
)
from ...model.settings import LOST_SETTINGS, RESISTANCE, SPRING
from ..common.missing_bounds import explain_default_bounds, explain_missing_bounds
from ..common.remarks import report_negative_dynamics
from ..common.unexpressed import report_resistance
from ..written import Written
from .bodies import Bodies
from .joint_values import JointValues
from .names import Names
from .options import Options
from .physx import write_physx_mimic, write_physx_values
from .stage import (
    PHYSICS,
    PHYSX,
    StageBuilder,
    apply,
    compute_quaternion,
    set_targets,
    set_value,
    store_name,
)

_AXES: dict[Vector, str] = {(1, 0, 0): "X", (0, 1, 0): "Y", (0, 0, 1): "Z"}

_LOCKED, _FREE = (1.0, -1.0), (-math.inf, math.inf)


@dataclass(frozen=True)
class JointWriter:
    """Writes the joints of a robot.

    Attributes:
        builder: The stage.
        bodies: Bodies of the robot.
        names: Prim names.
        options: Options of the export.
        values: Values of the joints with one degree of freedom.
        positions: Positions of the joints at home [rad or m], by name.
        written: Receives the losses.
    """

    builder: StageBuilder
    bodies: Bodies
    names: Names
    options: Options
    values: Mapping[str, JointValues]
    positions: Mapping[str, float]
    written: Written

    def get_path(self, joint: str) -> Sdf.Path:
        """Return the path of a joint's prim."""
        return self.builder.root.AppendPath(f"joints/{self.names.joint[joint]}")

    def get_body_path(self, link: str) -> Sdf.Path:
        """Return the path of the body that carries a link; empty for the world."""
        body = self.bodies.carrier[link]
        return self.builder.root.AppendChild(self.names.link[body]) if body else Sdf.Path()

    def write(self) -> None:
        """Write the fixed joint of the base, and all joints between bodies."""
        with self.builder.edit_layer(PHYSICS):
            stage = self.builder.stage
            stage.DefinePrim(self.builder.root.AppendChild("joints"), "Scope")
            if self.bodies.base and not self.bodies.free:
                self._write_root_joint()
            for joint in self.bodies.joints:
                if joint.type != "floating":
                    self._write_joint(joint)

    def _write_root_joint(self) -> None:
        path = self.builder.root.AppendPath("joints/root_joint")
        joint = UsdPhysics.FixedJoint.Define(self.builder.stage, path)
        joint.CreateBody1Rel().SetTargets([self.get_body_path(self.bodies.base)])
        _set_frames(joint, self.bodies.poses[self.bodies.base], IDENTITY)

    def _write_joint(self, joint: Joint) -> None:
        turn, axis = choose_joint_frame(joint)
        prim = self._create_prim(joint, axis)
        store_name(prim, "joint", joint.name)
        if self.bodies.carrier[joint.parent] != joint.parent:
            prim.SetCustomDataByKey("urdf:parent", joint.parent)
        usd = UsdPhysics.Joint(prim)
        parent = self.get_body_path(joint.parent)
        if parent:
            usd.CreateBody0Rel().SetTargets([parent])
        usd.CreateBody1Rel().SetTargets([self.get_body_path(joint.child)])
        _set_frames(usd, self.bodies.compute_parent_frame(joint) @ turn, turn)
        if joint.type in MOVABLE and self.bodies.is_movable(joint):
            self._write_limits(prim, joint)
            self._write_dynamics(prim, joint)
        elif self.bodies.is_movable(joint):
            report_resistance(joint, RESISTANCE, self.written)

    def _create_prim(self, joint: Joint, axis: str) -> Usd.Prim:
        """Create the prim of a joint with its type and axis."""
        stage, path = self.builder.stage, self.get_path(joint.name)
        if not self.bodies.is_movable(joint):
            if not joint.is_fixed:
                self.written.report_loss(
                    "joint-type",
                    f"joint '{joint.name}' of type {joint.type} is written as a fixed joint",
                    joint.place,
                    kind="joint",
                    name=joint.name,
                )
            return UsdPhysics.FixedJoint.Define(stage, path).GetPrim()
        if joint.type in BALL_TYPES:
            return UsdPhysics.SphericalJoint.Define(stage, path).GetPrim()
        if joint.type == "planar":
            prim = UsdPhysics.Joint.Define(stage, path).GetPrim()
            for name in ("transX", "transY", "rotZ"):
                _set_limit(prim, name, _FREE)
            for name in ("transZ", "rotX", "rotY"):
                _set_limit(prim, name, _LOCKED)
            return prim
        schema = (
            UsdPhysics.PrismaticJoint if joint.type == "prismatic" else UsdPhysics.RevoluteJoint
        )
        usd = schema.Define(stage, path)
        usd.CreateAxisAttr(axis)
        return usd.GetPrim()

    def _write_limits(self, prim: Usd.Prim, joint: Joint) -> None:
        text = explain_default_bounds(joint)
        if joint.turns_freely and joint.type != "continuous":
            text = explain_missing_bounds(joint)
        if text:
            self.written.report_loss(
                "limit-missing", text, joint.place, kind="joint", name=joint.name
            )
        lower, upper = get_limits(joint)
        for name, bound in (("lowerLimit", lower), ("upperLimit", upper)):
            if math.isfinite(bound):
                set_value(prim, f"physics:{name}", "float", convert_position(joint, bound))
        drive = UsdPhysics.DriveAPI.Apply(prim, drive_name(joint))
        drive.CreateTypeAttr("force")
        values = self.values[joint.name]
        drive.CreateStiffnessAttr(convert_gain(joint, values.kp))
        drive.CreateDampingAttr(convert_gain(joint, values.kd))
        if values.effort is not None:
            drive.CreateMaxForceAttr(values.effort)
        self._write_home(prim, joint, drive)

    def _write_home(self, prim: Usd.Prim, joint: Joint, drive: UsdPhysics.DriveAPI) -> None:
        """Write the position of a joint at home, and as target of its servo."""
        position = convert_position(joint, self.positions.get(joint.name, 0.0))
        if not position:
            return
        if self.values[joint.name].kp:
            drive.CreateTargetPositionAttr(position)
        set_value(prim, f"state:{drive_name(joint)}:physics:position", "float", position)
        if self.options.has_physx:
            with self.builder.edit_layer(PHYSX):
                apply(prim, f"PhysicsJointStateAPI:{drive_name(joint)}")

    def _write_dynamics(self, prim: Usd.Prim, joint: Joint) -> None:
        """Write velocity limit and dynamics for Newton and PhysX."""
        report_negative_dynamics(joint, "which is written as 0", self.written)
        values = _convert_values(joint, self.values[joint.name])
        if joint.limit is not None and joint.limit.velocity == 0:
            self.written.report_loss(
                "velocity",
                f"velocity limit 0 of joint '{joint.name}' is left out: the schemas require a "
                "limit above 0",
                joint.limit.place,
                kind="joint",
                name=joint.name,
            )
        if values:
            apply(prim, "NewtonJointAPI")
        for name, value in values.items():
            set_value(prim, f"newton:{name}", "float", value)
        if self.options.has_physx and values:
            with self.builder.edit_layer(PHYSX):
                write_physx_values(
                    prim, drive_name(joint), values, old_names=self.options.target == "isaac"
                )

    def write_mimic(self, joint: Joint, leader: str, factor: float, offset: float) -> None:
        """Write that a joint follows: position = factor · leader + offset [rad or m]."""
        if is_angular(joint) != is_angular(self.bodies.robot.joint[leader]):
            self.written.report_loss(
                "mimic-types",
                f"joint '{joint.name}' follows '{leader}' of another type, which the schema does "
                "not define; Newton uses the factor in radians and meters",
                joint.place,
                kind="joint",
                name=joint.name,
                severity=Severity.INFO,
            )
        with self.builder.edit_layer(PHYSICS):
            prim = self.builder.stage.GetPrimAtPath(self.get_path(joint.name))
            apply(prim, "NewtonMimicAPI")
            set_targets(prim, "newton:mimicJoint", [self.get_path(leader)])
            set_value(prim, "newton:mimicCoef0", "float", convert_position(joint, offset))
            set_value(prim, "newton:mimicCoef1", "float", factor)
        if self.options.has_physx:
            self._write_physx_mimic(prim, joint, self.bodies.robot.joint[leader], factor, offset)

    def _write_physx_mimic(
        self, prim: Usd.Prim, joint: Joint, leader: Joint, factor: float, offset: float
    ) -> None:
        """Write a mimic joint of PhysX, and report joints whose missing limits prevent it."""
        endless = [part.name for part in (joint, leader) if is_angular(part)
                   and not all(map(math.isfinite, get_limits(part)))]  # fmt: skip
        if endless:
            names = " and ".join(f"'{name}'" for name in endless)
            self.written.report_loss(
                "physx-mimic",
                f"PhysX ignores <mimic> of joint '{joint.name}': a rotating joint in it needs "
                f"limits, which {names} lacks; Newton reads it",
                joint.place,
                kind="joint",
                name=joint.name,
            )
        if self.options.target == "isaac":
            ratio = 1.0
            if is_angular(joint) != is_angular(leader):
                ratio = math.degrees(1.0) if is_angular(joint) else math.radians(1.0)
            with self.builder.edit_layer(PHYSX):
                path = self.get_path(leader.name)
                write_physx_mimic(prim, path, -factor * ratio, -convert_position(joint, offset))


def report_unwritten_spring(joint: Joint, written: Written) -> None:
    """Report a spring, for which the schemas have no attribute."""
    if joint.spring is not None:
        written.report_loss(
            "joint-spring",
            f"spring of joint '{joint.name}' is dropped",
            joint.settings["spring_stiffness"].place,
            kind="joint",
            name=joint.name,
            data={LOST_SETTINGS: SPRING},
        )


def is_angular(joint: Joint) -> bool:
    """Tell whether the position of a joint is an angle."""
    return joint.type != "prismatic"


def drive_name(joint: Joint) -> str:
    """Return the name of a joint's drive: ``angular`` or ``linear``."""
    return "angular" if is_angular(joint) else "linear"


def convert_position(joint: Joint, value: float) -> float:
    """Convert a position or velocity of a joint to the unit of the stage."""
    return math.degrees(value) if is_angular(joint) else value


def convert_gain(joint: Joint, value: float) -> float:
    """Convert a gain of a joint to the unit of the stage."""
    return math.radians(value) if is_angular(joint) else value


def _convert_values(joint: Joint, values: JointValues) -> dict[str, float]:
    """Return the values of Newton's schema that a joint has, by name, in its units."""
    found = {
        "velocityLimit": convert_position(joint, values.velocity or 0.0),
    }
    for row in RESISTANCE:
        value = values.resistance[row.name]
        name = row.usd.partition(":")[2]
        found[name] = convert_gain(joint, value) if "/rad" in row.unit else value
    return {name: value for name, value in found.items() if value}


def choose_joint_frame(joint: Joint) -> tuple[Pose, str]:
    """Return the rotation of the joint frame in the frame of the child, and its axis.

    The frame is not rotated if the axis is exactly that of a coordinate; otherwise its X is the
    axis. The frame of a planar joint has the normal as Z.
    """
    if not joint.has_axis:
        return IDENTITY, "X"
    xyz = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = compute_norm(xyz)
    if length < 1e-6:
        return IDENTITY, "X"
    x, y, z = (part / length + 0.0 for part in xyz)
    if joint.type == "planar":
        return Pose(_rotate_between((0.0, 0.0, 1.0), (x, y, z))), "Z"
    if (x, y, z) in _AXES:
        return IDENTITY, _AXES[x, y, z]
    return Pose(_rotate_between((1.0, 0.0, 0.0), (x, y, z))), "X"


def _rotate_between(start: Vector, end: Vector) -> Rotation:
    """Return the shortest rotation of a unit vector to another."""
    cosine = compute_dot(start, end)
    if cosine > 1 - 1e-15:
        return IDENTITY.rotation
    if cosine < -1 + 1e-15:
        return rotation_from_quaternion((0.0, 0.0, 1.0, 0.0) if start[0] else (0.0, 1.0, 0.0, 0.0))
    x, y, z = compute_cross(start, end)
    return rotation_from_quaternion((1.0 + cosine, x, y, z))


def _set_frames(joint: UsdPhysics.Joint, first: Pose, second: Pose) -> None:
    joint.CreateLocalPos0Attr(Gf.Vec3f(*remove_noise(first.translation)))
    joint.CreateLocalRot0Attr(Gf.Quatf(*compute_quaternion(first.rotation)))
    joint.CreateLocalPos1Attr(Gf.Vec3f(*remove_noise(second.translation)))
    joint.CreateLocalRot1Attr(Gf.Quatf(*compute_quaternion(second.rotation)))


def _set_limit(prim: Usd.Prim, name: str, bounds: tuple[float, float]) -> None:
    limit = UsdPhysics.LimitAPI.Apply(prim, name)
    limit.CreateLowAttr(bounds[0])
    limit.CreateHighAttr(bounds[1])
