"""Recognize mechanisms, whose links overlap by design: a pin, a telescope, or a piston.

URDF is a tree, so a mechanism that closes a loop is written as branches that mimic one joint.
Where the branches meet, in a pin or a cylinder, their links overlap equally at all positions of the
joint. The overlap of misplaced links varies with the position.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...model.elements import Robot
from ...model.kinematics import compute_link_poses
from ..overlap import measure_triangle_penetration
from ..recording import Array
from ..rigid_bodies import RigidBody, RigidBodyJoint
from ..state import StateSnapshot

_STEPS = 5
"""Number of positions of a joint at which its mechanism is measured. Chosen, no source."""

_WIDE = 1.0
"""Rad: range to each side of a joint without limits. Chosen, no source."""


def find_mechanism(
    robot: Robot, start: StateSnapshot, links: tuple[str, str], between: Sequence[int]
) -> str:
    """Describe the mechanism to which two links belong that overlap at the start; empty if none."""
    bodies = start.bodies.bodies
    ends = start.get_body(links[0]), start.get_body(links[1])
    joints = [joint for number in between if (joint := bodies[number].joint) is not None]
    if _is_serial(bodies, ends):
        if _slides(start, between):
            return "the links are parts of a telescope, connected by parallel prismatic joints"
    elif _is_coaxial(start, ends):
        return "the links are on a common axis, as a piston and its cylinder"
    if len(joints) > 1 and _keeps_overlap(robot, start, links, joints):
        return "the overlap is equal at all positions of the joint that moves both, as at a pin"
    return ""


def _is_serial(bodies: Sequence[RigidBody], ends: tuple[int, int]) -> bool:
    """Tell whether one of two bodies carries the other."""
    for number, other in (ends, ends[::-1]):
        while number >= 0:
            if number == other:
                return True
            number = bodies[number].parent
    return False


def _slides(start: StateSnapshot, between: Sequence[int]) -> bool:
    """Tell whether all joints between two bodies slide along one direction."""
    axes = []
    for number in between:
        joint = start.bodies.bodies[number].joint
        if joint is None or joint.kind != "prismatic":
            return False
        axes.append(np.array(start.get_pose(number).rotation) @ np.array(joint.axis))
    return len(axes) > 1 and all(
        abs(float(axis @ axes[0])) > math.cos(start.thresholds.rod_angle) for axis in axes
    )


def _is_coaxial(start: StateSnapshot, ends: tuple[int, int]) -> bool:
    """Tell whether two bodies are elongated, on one axis, and one is thinner than the other."""
    found = [_find_long_axis(start, number) for number in ends]
    if found[0] is None or found[1] is None:
        return False
    (middle, along, width), (other, direction, thickness) = found[0], found[1]
    if abs(float(along @ direction)) < math.cos(start.thresholds.rod_angle):
        return False
    if min(width, thickness) > start.thresholds.rod_width * max(width, thickness):
        return False
    off = np.linalg.norm(np.cross(other - middle, along))
    return bool(off < start.thresholds.rod_offset * min(width, thickness))


def _find_long_axis(start: StateSnapshot, number: int) -> tuple[Array, Array, float] | None:
    """Find center, long axis and width of a body's collision geometry, in the world [m].

    None if it is not clearly longer than wide.
    """
    corners = []
    for shape in start.bodies.bodies[number].shapes:
        points = shape.get_corners()
        turn, at = np.array(shape.pose.rotation), np.array(shape.pose.translation)
        corners.append(points @ turn.T + at)
    if not corners:
        return None
    points = np.concatenate(corners)
    turn, at = (
        np.array(start.get_pose(number).rotation),
        np.array(start.get_pose(number).translation),
    )
    points = points @ turn.T + at
    _, axes = np.linalg.eigh(np.cov((points - points.mean(axis=0)).T))
    low, high = (points @ axes).min(axis=0), (points @ axes).max(axis=0)
    edges = high - low
    longest = int(edges.argmax())
    width = float(np.delete(edges, longest).max())
    if edges[longest] < start.thresholds.rod_length * width:
        return None
    return axes @ ((low + high) / 2), axes[:, longest], width


def _keeps_overlap(
    robot: Robot, start: StateSnapshot, links: tuple[str, str], joints: Sequence[RigidBodyJoint]
) -> bool:
    """Tell whether the penetration depth is equal at all positions of the joint that moves both."""
    leaders = {_find_leader(start, joint).name for joint in joints}
    if len(leaders) != 1:
        return False
    leader = _find_leader(start, joints[0])
    here = start.bodies.positions[leader.name]
    lower, upper = max(leader.lower, here - _WIDE), min(leader.upper, here + _WIDE)
    if not lower < upper:
        return False
    depths = []
    for value in (here, *np.linspace(lower, upper, _STEPS).tolist()):
        positions = {**start.bodies.positions, leader.name: value}
        for joint in start.bodies.joints:
            if joint.leader is not None:
                positions.pop(joint.name, None)  # computed from its leader
        poses = compute_link_poses(robot, positions)
        depth = measure_triangle_penetration(robot, poses, *links)
        if depth is None:
            return False
        depths.append(depth)
    bounds = start.thresholds
    varies = max(bounds.mechanism_variation * max(depths), bounds.mechanism_depth)
    return min(depths) > 0 and max(depths) - min(depths) <= varies


def _find_leader(start: StateSnapshot, joint: RigidBodyJoint) -> RigidBodyJoint:
    """Find the joint at the end of a chain of mimic joints."""
    known = {one.name: one for one in start.bodies.joints}
    while joint.leader is not None and joint.leader in known:
        joint = known[joint.leader]
    return joint
