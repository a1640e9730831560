"""Joints between two links, and the poses of both at joint positions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import Array
from ..model.elements import Joint, Robot
from ..model.kinematics import find_movable_joints, follow_mimic_chain, get_limits
from ..model.pose import IDENTITY, Pose, make_pose


@dataclass(frozen=True)
class Coordinate:
    """One coordinate of a pair: a joint that others may follow.

    Attributes:
        joint: Name of the leading joint.
        lower: Smallest value [rad, m].
        upper: Largest value [rad, m].
    """

    joint: str
    lower: float
    upper: float


@dataclass(frozen=True, eq=False)
class Step:
    """A joint on the path.

    Attributes:
        before: Pose of the joint in the frame after the previous joint of its side.
        axis: Unit axis, shape (3,).
        slide: Translation along the axis for each unit of the position [m/rad, 1]; 0 of a hinge.
        turn: Rotation for each unit of the position: 1, or 0 of a prismatic joint.
        column: Index of its coordinate.
        scale: Factor of the coordinate.
        offset: Added to the scaled coordinate [rad, m].
    """

    before: tuple[Array, Array]
    axis: Array
    slide: float
    turn: float
    column: int
    scale: float
    offset: float


@dataclass(frozen=True, eq=False)
class Chain:
    """Joints between two links A and B.

    Attributes:
        sides: Moving joints from the common ancestor to A, and to B.
        ends: Poses of A and of B in the frames after their last joints.
        coordinates: Coordinates of the pair.
        obstacle: Why joint values cannot be enclosed in boxes; empty if they can.
    """

    sides: tuple[tuple[Step, ...], tuple[Step, ...]]
    ends: tuple[tuple[Array, Array], tuple[Array, Array]]
    coordinates: tuple[Coordinate, ...]
    obstacle: str = ""

    @property
    def steps(self) -> list[Step]:
        """Return the joints in the order from A to B."""
        return [*self.sides[0][::-1], *self.sides[1]]


@dataclass(frozen=True, eq=False)
class Placement:
    """Both bodies at n joint positions, in the frame of the common ancestor.

    Attributes:
        rotations: Of A and of B, each of shape (n, 3, 3).
        translations: Of A and of B [m], each of shape (n, 3).
        points: A point of each axis from A to B [m], each of shape (n, 3).
        axes: Direction of each axis, each of shape (n, 3).
    """

    rotations: tuple[Array, Array]
    translations: tuple[Array, Array]
    points: list[Array]
    axes: list[Array]


def find_chain(robot: Robot, a: str, b: str) -> Chain:
    """Find the joints between two links that a common root reaches."""
    above_a, above_b = ([name, *robot.tree.list_ancestors(name)] for name in (a, b))
    common = next((name for name in above_a if name in set(above_b)), None)
    leaders: dict[str, int] = {}
    bounds: list[Coordinate] = []
    obstacles: list[str] = []
    if common is None:
        obstacles.append("no joints connect the two")
    sides, ends = [], []
    for path in (above_a, above_b):
        links = path[: path.index(common)] if common is not None else []
        steps, end = _list_steps(robot, links[::-1], leaders, bounds, obstacles)
        sides.append(steps)
        ends.append(_as_arrays(end))
    reason = obstacles[0] if obstacles else ""
    return Chain((sides[0], sides[1]), (ends[0], ends[1]), tuple(bounds), reason)


def _list_steps(
    robot: Robot,
    links: Sequence[str],
    leaders: dict[str, int],
    bounds: list[Coordinate],
    obstacles: list[str],
) -> tuple[tuple[Step, ...], Pose]:
    """List the moving joints above links, topmost first, and the pose after the last one."""
    movable = robot.memo.get("movable joints", lambda: find_movable_joints(robot))
    pose, steps = IDENTITY, []
    for name in links:
        joint = robot.tree.get_parent_joint(name)
        assert joint is not None
        if len(robot.tree.joints_of_child[name]) > 1:
            obstacles.append(f"link '{name}' is the child of several joints")
        pose = pose @ make_pose(joint.origin)
        if joint.is_fixed:
            continue
        axis = _get_axis(joint)
        if joint.name not in movable or axis is None:
            obstacles.append(f"joint '{joint.name}' is {joint.type or 'without a type'}")
            continue
        leader, scale, offset = follow_mimic_chain(joint, movable)
        if leader not in leaders:
            leaders[leader] = len(bounds)
            bounds.append(_bound(robot, movable[leader], obstacles))
        slide = 1.0 if joint.type == "prismatic" else (joint.thread_pitch or 0.0) / math.tau
        turn = 0.0 if joint.type == "prismatic" else 1.0
        column = leaders[leader]
        steps.append(Step(_as_arrays(pose), axis, slide, turn, column, scale, offset))
        pose = IDENTITY
    return tuple(steps), pose


def _get_axis(joint: Joint) -> Array | None:
    """Return the unit axis; None for a zero axis."""
    axis = np.array(joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0))
    length = float(np.linalg.norm(axis))
    return axis / length if length and math.isfinite(length) else None


def _bound(robot: Robot, joint: Joint, obstacles: list[str]) -> Coordinate:
    """Bound a joint: one turn for a rotation without limits that no other joint follows."""
    lower, upper = get_limits(joint)
    valid = math.isfinite(lower) and math.isfinite(upper) and lower <= upper
    turns = joint.type in ("revolute", "continuous") and not _is_followed(robot, joint)
    if turns and (not valid or upper - lower > math.tau):
        return Coordinate(joint.name, -math.pi, math.pi)
    if not valid:
        obstacles.append(f"joint '{joint.name}' has no limits that enclose a range")
        return Coordinate(joint.name, 0.0, 0.0)
    return Coordinate(joint.name, lower, upper)


def _is_followed(robot: Robot, joint: Joint) -> bool:
    """Tell whether another joint follows a joint, so that one turn is not all positions."""
    followed = robot.memo.get(
        "followed joints", lambda: {j.mimic.joint for j in robot.joints if j.mimic is not None}
    )
    return joint.name in followed


def _as_arrays(pose: Pose) -> tuple[Array, Array]:
    return np.array(pose.rotation, dtype=np.float64), np.array(pose.translation, dtype=np.float64)


def place(chain: Chain, values: Array) -> Placement:
    """Compute the poses of both bodies and of the axes.

    Args:
        chain: Joints.
        values: Values of the coordinates [rad, m], shape (n, number of coordinates).
    """
    rotations, translations, points, axes = [], [], [], []
    for steps, end in zip(chain.sides, chain.ends, strict=True):
        rotation = np.broadcast_to(np.eye(3), (len(values), 3, 3))
        translation = np.zeros((len(values), 3))
        of_side = []
        for step in steps:
            translation = translation + rotation @ step.before[1]
            rotation = rotation @ step.before[0]
            axis = rotation @ step.axis
            of_side.append((translation, axis))
            position = step.scale * values[:, step.column] + step.offset
            if step.slide:
                translation = translation + (step.slide * position)[:, None] * axis
            if step.turn:
                rotation = rotation @ _rotate(step.axis, position)
        translations.append(translation + rotation @ end[1])
        rotations.append(rotation @ end[0])
        if steps is chain.sides[0]:
            of_side.reverse()
        points += [point for point, _ in of_side]
        axes += [axis for _, axis in of_side]
    return Placement((rotations[0], rotations[1]), (translations[0], translations[1]), points, axes)


def _rotate(axis: Array, angle: Array) -> Array:
    """Return the rotations about an axis by angles [rad], shape (n, 3, 3): Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, versine = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    rotations: Array = np.eye(3) + sine * cross + versine * (cross @ cross)
    return rotations
