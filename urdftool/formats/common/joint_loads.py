"""What each joint moves and holds at home, for the choice of gains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import numpy.typing as npt

from ...mechanics.spatial_inertia import SpatialInertia
from ...model.elements import Joint
from ...model.kinematics import MOVABLE, link_poses
from ...model.pose import IDENTITY, Pose
from .rigid_tree import RigidTree
from .standing import CLEARANCE, Ground

Array = npt.NDArray[np.float64]

GRAVITY = 9.81
"""Gravity [m/s²], MuJoCo's default."""

LEVEL_AXIS = 0.7
"""Largest vertical component of the axis of a hinge about which a robot can tip; chosen, no
source."""

_RESERVE = 2.0
"""Ratio of stiffness to the m·g·h at which an inverted pendulum tips; chosen, no source."""


WHEEL = 0.05
"""Distance of the center of mass of a wheel from its axis, relative to its height, at most; chosen,
no source."""

SINGULAR = 1e-3
"""Ratio of these inertias below which nothing with mass is between two axes; chosen, no source."""

_LEAST_EIGENVALUE = 1e-12  # of the mass matrix with a diagonal of ones, above its rounding

STABLE = 2.56
"""Largest ratio of the inertia that bounds a gain to that with the other joints free: (4/2.5)²,
which ``servo_gains.LONGER`` derives from the longest step at which servos must not diverge."""

LEAST_REDUCED = 0.1
"""Least ratio of the inertia with the other joints free to that with them held; chosen, no source.

Two axes on one line with a link without mass between them would give zero.
"""


@dataclass(frozen=True)
class JointLoad:
    """What a joint moves and holds while the other joints do not move.

    Attributes:
        inertia: Inertia that it moves [kg·m² or kg].
        reduced: Inertia that it moves while the other joints are free, which bounds its stiffness;
            ``inertia`` if the ground carries what it moves.
        force: Torque or force with which it holds the robot against gravity [N·m or N].
        stiffness: Stiffness [N·m/rad] below which a robot above its feet may tip; 0 for none.
        is_carried: Whether the ground carries what the joint moves.
        free: Inertia that it moves while the other joints are free, carried or not.
        is_singular: Whether the joint and another can turn against each other without moving mass.
        is_followed: Whether mimic joints follow it.
    """

    inertia: float = 0.0
    reduced: float = 0.0
    force: float = 0.0
    stiffness: float = 0.0
    is_carried: bool = False
    free: float = 0.0
    is_singular: bool = False
    is_followed: bool = False

    def add_armature(self, armature: float) -> JointLoad:
        """Return the load with a rotor inertia at the joint [kg·m² or kg]."""
        return replace(
            self,
            inertia=self.inertia + armature,
            reduced=self.reduced + armature,
            free=self.free + armature,
        )


def compute_joint_loads(
    tree: RigidTree,
    masses: Mapping[str, SpatialInertia],
    positions: Mapping[str, float],
    root: Pose = IDENTITY,
    ground: Ground | None = None,
) -> dict[str, JointLoad]:
    """Compute inertia and static load of each joint with one degree of freedom.

    The ground carries a free robot at the corners of the boxes of its lowest bodies, by the forces
    of the least sum of squares that balance its weight.

    ``ground`` is the geometry near the ground, for a free root.

    Returns:
        The loads by joint name; an inertia is the diagonal element of the mass matrix.
    """
    poses = {name: root @ pose for name, pose in link_poses(tree.robot, positions).items()}
    names = [name for name in masses if name in poses]
    bodies = _Bodies(
        [tree.group[name] for name in names],
        np.array([masses[name].mass for name in names]),
        np.array([poses[name].transform(masses[name].com) for name in names]).reshape(-1, 3),
        np.array([masses[name].transform(poses[name]).inertia for name in names]).reshape(-1, 3, 3),
    )
    carriers, points = _list_contacts(ground)
    forces = _compute_forces(bodies, points)
    below = _get_bodies_below(tree)
    found = {}
    joints = [j for j in tree.moving if j.type in MOVABLE]
    ratios = _compute_ratios(tree, joints, poses, bodies, below)
    leaders = {joint.mimic.joint for joint in tree.moving if joint.mimic is not None}
    for joint in joints:
        moved = below[tree.group[joint.child]]
        held = np.array([carrier in moved for carrier in carriers], dtype=bool)
        load = _compute_load(
            joint, poses[joint.child], bodies.select(moved), points[held], forces[held]
        )
        ratio = ratios[joint.name]
        part = min(max(ratio, LEAST_REDUCED), 1.0)
        if ratio >= SINGULAR:  # others get an armature
            part = min(part, STABLE * ratio)
        load = replace(load, free=part * load.inertia)
        if held.any():
            stiffness = _compute_stiffness(joint, poses[joint.child], bodies, bodies.select(moved))
            load = replace(load, stiffness=stiffness, is_carried=True)
        else:
            load = replace(load, reduced=load.free)
        found[joint.name] = replace(
            load,
            is_singular=ratio < SINGULAR,
            is_followed=joint.name in leaders,
        )
    return found


@dataclass(frozen=True)
class _Bodies:
    """Masses [kg], centers of mass [m] and tensors [kg·m²] of links, and their rigid bodies."""

    groups: Sequence[str]
    masses: Array
    centers: Array
    tensors: Array

    def select(self, groups: set[str]) -> _Bodies:
        """Return the links of some rigid bodies."""
        rows = [index for index, name in enumerate(self.groups) if name in groups]
        return _Bodies(
            [self.groups[row] for row in rows],
            self.masses[rows],
            self.centers[rows],
            self.tensors[rows],
        )


def _get_axis(joint: Joint, pose: Pose) -> Array:
    """Return the unit axis of a joint in the world; zero without a direction."""
    xyz = (1.0, 0.0, 0.0) if joint.axis is None else joint.axis.xyz
    axis: Array = np.array(pose.rotation) @ np.array(xyz)
    length = float(np.linalg.norm(axis))
    return axis / length if length else axis


def _compute_load(
    joint: Joint, pose: Pose, moved: _Bodies, points: Array, forces: Array
) -> JointLoad:
    axis = _get_axis(joint, pose)
    if joint.type == "prismatic":
        pull = (forces.sum() - GRAVITY * moved.masses.sum()) * axis[2]
        mass = float(moved.masses.sum())
        return JointLoad(mass, mass, float(abs(pull)))
    start = np.array(pose.translation)
    arms = np.cross(axis, moved.centers - start)
    about = np.einsum("i,nij,j->n", axis, moved.tensors, axis)
    inertia = float((about + moved.masses * (arms**2).sum(axis=1)).sum())
    torque = -GRAVITY * float(moved.masses @ arms[:, 2])
    torque += float(forces @ np.cross(axis, points - start)[:, 2])
    return JointLoad(inertia, inertia, abs(torque))


def _compute_ratios(
    tree: RigidTree,
    joints: Sequence[Joint],
    poses: Mapping[str, Pose],
    bodies: _Bodies,
    below: Mapping[str, set[str]],
) -> dict[str, float]:
    """Compute the inertia of each joint with the others free, relative to that with them held.

    The base is fixed. The inertia is the reciprocal of the diagonal element of the inverse mass
    matrix M. An element of M is the generalized momentum of one joint for the unit velocity of the
    other below it. A joint that moves no mass has the ratio 1.
    """
    size = len(joints)
    matrix = np.zeros((size, size))
    screws = [_get_screw(joint, poses[joint.child]) for joint in joints]
    for column, joint in enumerate(joints):
        moved = below[tree.group[joint.child]]
        momentum = _compute_momentum(bodies.select(moved), screws[column])
        for row, other in enumerate(joints):
            if tree.group[joint.child] in below[tree.group[other.child]]:
                matrix[row, column] = matrix[column, row] = float(screws[row] @ momentum)
    known = np.flatnonzero(np.diag(matrix) > 0)
    scale = 1 / np.sqrt(np.diag(matrix)[known])
    scaled = matrix[np.ix_(known, known)] * np.outer(scale, scale)
    values, vectors = np.linalg.eigh(scaled)
    inverse = (vectors**2 / np.maximum(values, _LEAST_EIGENVALUE)).sum(axis=1)
    found = dict.fromkeys((joint.name for joint in joints), 1.0)
    for number, element in zip(known, inverse, strict=True):
        found[joints[int(number)].name] = 1 / float(element)
    return found


def _get_screw(joint: Joint, pose: Pose) -> Array:
    """Return angular and linear velocity of the origin, shape (6,), for the unit velocity."""
    axis = _get_axis(joint, pose)
    if joint.type == "prismatic":
        return np.concatenate([np.zeros(3), axis])
    return np.concatenate([axis, np.cross(np.array(pose.translation), axis)])


def _compute_momentum(moved: _Bodies, screw: Array) -> Array:
    """Return angular momentum about the origin and momentum, shape (6,), of moved links."""
    speeds = screw[3:] + np.cross(screw[:3], moved.centers)
    linear = moved.masses[:, None] * speeds
    angular = moved.tensors @ screw[:3] + np.cross(moved.centers, linear)
    return np.concatenate([angular.sum(axis=0), linear.sum(axis=0)])


def _compute_stiffness(joint: Joint, pose: Pose, bodies: _Bodies, moved: _Bodies) -> float:
    """Return twice m·g·h [N·m/rad] of the robot above a hinge that is not upright, else 0.

    A wheel, with its center of mass on the axis, needs none.
    """
    total, axis = float(bodies.masses.sum()), _get_axis(joint, pose)
    is_upright = abs(axis[2]) > LEVEL_AXIS
    if joint.type == "prismatic" or is_upright or not total or not moved.masses.sum():
        return 0.0
    if joint.type == "continuous":
        center = moved.masses @ moved.centers / moved.masses.sum() - np.array(pose.translation)
        reach = float(np.linalg.norm(moved.centers - np.array(pose.translation), axis=1).max())
        if np.linalg.norm(np.cross(axis, center)) <= WHEEL * max(reach, abs(pose.translation[2])):
            return 0.0
    height = float(bodies.masses @ bodies.centers[:, 2]) / total - pose.translation[2]
    return _RESERVE * total * GRAVITY * max(height, 0.0)


def _list_contacts(ground: Ground | None) -> tuple[list[str], Array]:
    """Return the bodies that the ground carries, and the points [m] where, shape (n, 3)."""
    if ground is None:
        return [], np.zeros((0, 3))
    top = ground.low + CLEARANCE * ground.size
    found = [
        (body, (x, y, low[2]))
        for body in ground.get_near(CLEARANCE)
        for low, high in ground.boxes[body]
        if low[2] <= top
        for x, y in product((low[0], high[0]), (low[1], high[1]))
    ]
    points = np.array([point for _, point in found], dtype=np.float64).reshape(-1, 3)
    return [body for body, _ in found], points


def _compute_forces(bodies: _Bodies, points: Array) -> Array:
    """Return the vertical forces [N] at points that carry the weight, shape (n,)."""
    total = float(bodies.masses.sum())
    if not len(points) or not total or not np.isfinite(points).all():
        return np.zeros(len(points))
    center = bodies.masses @ bodies.centers[:, :2] / total
    rows = np.vstack([np.ones(len(points)), (points[:, :2] - center).T])
    forces: Array = np.linalg.lstsq(rows, np.array([GRAVITY * total, 0.0, 0.0]), rcond=None)[0]
    return forces


def _get_bodies_below(tree: RigidTree) -> dict[str, set[str]]:
    """Return for each rigid body itself and those that move with it; floating ones do not."""
    below = {name: {name} for name in tree.members}
    for joint in reversed(tree.moving):
        if joint.type != "floating":
            below[tree.group[joint.parent]] |= below[tree.group[joint.child]]
    return below
