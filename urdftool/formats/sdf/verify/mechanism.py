"""Numeric representation of bodies, joints, frames and shapes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass
class Body:
    """A rigid body: mass [kg], center of mass [m] and inertia about it [kg·m²], in its frame."""

    name: str
    mass: float = 0.0
    center: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))


@dataclass
class Hinge:
    """A joint between two bodies.

    Attributes:
        name: Name of the joint.
        kind: ``revolute``, ``prismatic``, ``planar``, ``fixed``, ``free`` or ``ball``.
        parent: Parent body.
        child: Child body.
        before: Pose of the joint's frame in the parent body.
        after: Pose of the joint's frame in the child body.
        axis: Unit axis in the joint's frame.
        limits: ``lower``, ``upper``, ``effort``, ``velocity``, ``damping``, ``friction``.
        mimic: Leader, multiplier and offset.
    """

    name: str
    kind: str
    parent: str
    child: str
    before: Array
    after: Array
    axis: Array
    limits: dict[str, float] = field(default_factory=dict)
    mimic: tuple[str, float, float] | None = None

    @property
    def moves(self) -> bool:
        """Tell whether the joint has one degree of freedom."""
        return self.kind in ("revolute", "prismatic")


@dataclass
class Shape:
    """A visual or collision: link, body, pose in the body, geometry, color and texture.

    Attributes:
        part: Source of the shape: an element of the file, or a part of the robot.
    """

    link: str
    body: str
    pose: Array
    what: tuple[Any, ...]
    rgba: tuple[float, ...] | None = None
    picture: str | None = None
    part: Any = None


@dataclass
class Mechanism:
    """A robot.

    Attributes:
        bodies: Bodies by name, without ``world``.
        joints: Joints between the bodies.
        frames: Body and pose in it, by frame name; the body ``world`` is the model's frame.
        collisions: Collision geometry.
        visuals: Visual geometry.
    """

    bodies: dict[str, Body] = field(default_factory=dict)
    joints: list[Hinge] = field(default_factory=list)
    frames: dict[str, tuple[str, Array]] = field(default_factory=dict)
    collisions: list[Shape] = field(default_factory=list)
    visuals: list[Shape] = field(default_factory=list)

    def sort_joints(self) -> list[Hinge]:
        """Return the joints, parents before children; the first joint of each child body counts."""
        by_parent: dict[str, list[Hinge]] = {}
        hung: set[str] = set()
        for joint in self.joints:
            if joint.child not in hung:
                hung.add(joint.child)
                by_parent.setdefault(joint.parent, []).append(joint)
        order: list[Hinge] = []
        todo = ["world", *(name for name in self.bodies if name not in hung)]
        while todo:
            for joint in by_parent.pop(todo.pop(0), []):
                order.append(joint)
                todo.append(joint.child)
        return order


def rotate_by_angles(rpy: Any) -> Array:
    """Compute the rotation matrix of fixed-axis angles about x, then y, then z [rad]."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy), np.cos(rpy)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    product: Array = about_z @ about_y @ about_x
    return product


def rotate_by_quaternion(x: float, y: float, z: float, w: float) -> Array:
    """Compute the rotation matrix of a quaternion of any length: v + 2 w q × v + 2 q × (q × v)."""
    x, y, z, w = np.array([x, y, z, w]) / np.linalg.norm([x, y, z, w])
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation: Array = np.eye(3) + 2 * w * cross + 2 * cross @ cross
    return rotation


def make_pose(rotation: Array, translation: Any) -> Array:
    """Return the 4 × 4 matrix of a rotation and a translation."""
    pose = np.eye(4)
    pose[:3, :3] = rotation
    pose[:3, 3] = translation
    return pose


def invert_pose(pose: Array) -> Array:
    """Return the inverse of a pose."""
    back = np.eye(4)
    back[:3, :3] = pose[:3, :3].T
    back[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return back
