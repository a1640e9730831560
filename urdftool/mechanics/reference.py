"""Reference kinematics and dynamics of a URDF robot, for comparison with an export.

The module shares no code with the exporters: frames are 4 × 4 matrices composed of elementary
rotations, and the mass matrix is a sum over the Jacobians of the links' centers of mass. Joints
other than hinges and slides stay at zero.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from ..model.elements import Joint, Link, Origin, Robot

Array = npt.NDArray[np.float64]

GRAVITY = np.array([0.0, 0.0, -9.81])
"""Acceleration [m/s²] in the root's frame."""

TURNING = ("revolute", "continuous")
SLIDING = ("prismatic",)


class Mechanics:
    """Frames, masses and forces of a robot with a fixed base.

    Attributes:
        joints: Hinges and slides, in file order.
    """

    def __init__(self, robot: Robot) -> None:
        """Index the joints of a robot that is a tree."""
        self.robot = robot
        self.root = robot.tree.roots[0].name
        self._below: dict[str, list[Joint]] = {}
        for joint in robot.joints:
            self._below.setdefault(joint.parent, []).append(joint)
        self.joints = [
            j for j in robot.joints if j.type in TURNING + SLIDING and _compute_length(j) > 1e-6
        ]
        self._column = {joint.name: index for index, joint in enumerate(self.joints)}

    def compute_frames(self, positions: Mapping[str, float]) -> dict[str, Array]:
        """Compute the pose of every link in the root's frame, 4 × 4.

        Args:
            positions: Joint positions by name [rad or m]; zero for joints that are not given.
        """
        frames = {self.root: np.eye(4)}
        todo = [self.root]
        while todo:
            parent = todo.pop()
            for joint in self._below.get(parent, ()):
                moved = frames[parent] @ get_origin_matrix(joint.origin)
                if joint.name in self._column:
                    moved = moved @ _compute_motion(joint, positions.get(joint.name, 0.0))
                frames[joint.child] = moved
                todo.append(joint.child)
        return frames

    def compute_mass_matrix(self, positions: Mapping[str, float]) -> Array:
        """Compute the joint-space mass matrix [kg·m², kg·m, kg]."""
        size = len(self.joints)
        matrix = np.zeros((size, size))
        for mass, tensor, linear, angular in self._compute_jacobians(positions):
            matrix += mass * linear.T @ linear + angular.T @ tensor @ angular
        return matrix

    def compute_gravity(
        self, positions: Mapping[str, float], rotation: Array | None = None
    ) -> Array:
        """Compute the force [N·m or N] that each joint needs to hold the robot against gravity.

        Args:
            positions: Joint positions by name [rad or m].
            rotation: Rotation of the root in the world, 3 × 3; None for the identity.
        """
        down = GRAVITY if rotation is None else rotation.T @ GRAVITY
        force = np.zeros(len(self.joints))
        for mass, _, linear, _ in self._compute_jacobians(positions):
            force -= mass * linear.T @ down
        return force

    def compute_centroid(self, positions: Mapping[str, float]) -> tuple[float, Array, Array]:
        """Compute mass [kg], center of mass [m] and inertia about it [kg·m²], in the root frame."""
        frames = self.compute_frames(positions)
        bodies = [
            properties
            for link in self.robot.links
            if link.name in frames
            if (properties := compute_mass_properties(link, frames[link.name])) is not None
        ]
        mass = math.fsum(body[0] for body in bodies)
        if mass == 0:
            return 0.0, np.zeros(3), np.zeros((3, 3))
        com = sum((m * c for m, c, _ in bodies), np.zeros(3)) / mass
        tensor = np.zeros((3, 3))
        for m, c, inertia in bodies:
            arm = c - com
            tensor += inertia + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return mass, com, tensor

    def _compute_jacobians(
        self, positions: Mapping[str, float]
    ) -> list[tuple[float, Array, Array, Array]]:
        """Compute mass, tensor, and linear and angular Jacobian of each link's center of mass."""
        frames = self.compute_frames(positions)
        axes = {
            joint.name: frames[joint.child][:3, :3]
            @ (_compute_axis(joint) / _compute_length(joint))
            for joint in self.joints
            if joint.child in frames
        }
        moving: dict[str, list[Joint]] = {self.root: []}
        jacobians = []
        for name in frames:
            if name != self.root:
                joint = next(j for j in self.robot.joints if j.child == name)
                own = [joint] if joint.name in self._column else []
                moving[name] = moving[joint.parent] + own
            properties = compute_mass_properties(self.robot.link[name], frames[name])
            if properties is None:
                continue
            mass, com, tensor = properties
            linear = np.zeros((3, len(self.joints)))
            angular = np.zeros((3, len(self.joints)))
            for joint in moving[name]:
                column, axis = self._column[joint.name], axes[joint.name]
                if joint.type in TURNING:
                    linear[:, column] = np.cross(axis, com - frames[joint.child][:3, 3])
                    angular[:, column] = axis
                else:
                    linear[:, column] = axis
            jacobians.append((mass, tensor, linear, angular))
        return jacobians


def get_origin_matrix(origin: Origin | None) -> Array:
    """Return the 4 × 4 pose of an ``<origin>``."""
    pose = np.eye(4)
    if origin is None:
        return pose
    if origin.quaternion is not None:
        vector, scalar = np.array(origin.quaternion[:3]), origin.quaternion[3]
        size = math.hypot(*origin.quaternion)
        angle = 2 * math.atan2(float(np.linalg.norm(vector)), scalar) if size else 0.0
        pose[:3, :3] = turn(vector, angle)
    elif any(origin.rpy):
        for axis, angle in zip(np.eye(3), origin.rpy, strict=True):
            pose[:3, :3] = turn(axis, angle) @ pose[:3, :3]
    pose[:3, 3] = origin.xyz
    return pose


def turn(axis: Array, angle: float) -> Array:
    """Compute the rotation matrix for an axis and an angle [rad] (Rodrigues' formula)."""
    length = float(np.linalg.norm(axis))
    if length == 0:
        return np.eye(3)
    x, y, z = axis / length
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation: Array = np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew
    return rotation


def _compute_axis(joint: Joint) -> Array:
    return np.array(joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))


def _compute_length(joint: Joint) -> float:
    return float(np.linalg.norm(_compute_axis(joint)))


def _compute_motion(joint: Joint, position: float) -> Array:
    pose = np.eye(4)
    if joint.type in TURNING:
        pose[:3, :3] = turn(_compute_axis(joint), position)
    else:
        pose[:3, 3] = _compute_axis(joint) / _compute_length(joint) * position
    return pose


def compute_mass_properties(link: Link, frame: Array) -> tuple[float, Array, Array] | None:
    """Return mass, center of mass and inertia tensor of a link in the root's frame."""
    inertial = link.inertial
    if inertial is None:
        return None
    pose = frame @ get_origin_matrix(inertial.origin)
    tensor = np.zeros((3, 3))
    if inertial.inertia is not None:
        i = inertial.inertia
        tensor = np.array(
            [[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]], dtype=float
        )
    mass = inertial.mass or 0.0
    if not (mass or tensor.any()):
        return None
    return mass, pose[:3, 3], pose[:3, :3] @ tensor @ pose[:3, :3].T
