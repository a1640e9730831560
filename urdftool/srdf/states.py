"""Named states of planning groups: joint positions within their limits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from ..model.elements import Joint, Robot
from ..model.kinematics import compute_link_poses
from ..model.semantic import GroupState, StateJoint
from ..model.start import compute_allowed_range, list_initial_positions
from .body_tree import BodyTree
from .grippers import Gripper

MOVED = 1e-3
"""Least difference between the spreads of an open and a closed gripper [m]; chosen, no source."""


def make_chain_states(robot: Robot, group: str, joints: Sequence[Joint]) -> Iterator[GroupState]:
    """Make the states of a chain.

    The state is ``zero`` if all joints may be at 0; else it is ``default``, where a joint that may
    not be at 0 is at the middle of its range, as in MoveIt. ``home`` has the initial values of
    ros2_control, if these are others. Joints with crossed limits have no state.
    """
    values = {joint.name: get_default_position(robot, joint) for joint in joints}
    positions = {name: value for name, value in values.items() if value is not None}
    if positions:
        yield make_state("default" if any(positions.values()) else "zero", group, positions)
    initial = list_initial_positions(robot)
    home = {name: initial.get(name, positions[name]) for name in positions}
    if home != positions and all(is_within(robot, name, value) for name, value in home.items()):
        yield make_state("home", group, home)


def get_default_position(robot: Robot, joint: Joint) -> float | None:
    """Return 0 if a joint may be there, else the middle of its range; None for crossed limits."""
    lower, upper = compute_allowed_range(robot, joint.name)
    if not lower <= upper:
        return None
    if lower <= 0.0 <= upper:
        return 0.0
    middle = float(f"{(lower + upper) / 2:.6g}")
    return middle if lower <= middle <= upper else (lower + upper) / 2


def is_within(robot: Robot, name: str, value: float) -> bool:
    """Tell whether a position [rad, m] is within the limits of a joint."""
    lower, upper = compute_allowed_range(robot, name)
    return lower <= value <= upper


def make_state(name: str, group: str, positions: Mapping[str, float]) -> GroupState:
    """Make a state from joint positions [rad, m]."""
    joints = [StateJoint(None, joint, value) for joint, value in positions.items()]
    return GroupState(None, name, group, joints)


def make_gripper_states(tree: BodyTree, group: str, gripper: Gripper) -> Iterator[GroupState]:
    """Make the states of a gripper: all its joints at one limit, and at the other.

    They are ``open`` and ``close`` where the centers of mass of the fingers are farther from one
    another, and nearer; ``lower`` and ``upper`` where that does not differ.
    """
    robot = tree.robot
    ends = [_list_limits(tree, gripper, end) for end in (0, 1)]
    if not ends[0] or ends[0] == ends[1]:
        return
    spreads = [_measure_spread(tree, gripper, positions) for positions in ends]
    if abs(spreads[0] - spreads[1]) < MOVED:
        names = ("lower", "upper")
    else:
        names = ("open", "close") if spreads[0] > spreads[1] else ("close", "open")
    states = dict(zip(names, ends, strict=True))
    for name in sorted(states, key=("open", "close", "lower", "upper").index):
        inside = all(is_within(robot, joint, value) for joint, value in states[name].items())
        if inside:
            yield make_state(name, group, states[name])


def _list_limits(tree: BodyTree, gripper: Gripper, end: int) -> dict[str, float]:
    """Return one end of the range [rad, m] of each actuated joint that has one."""
    found = {}
    for joint in gripper.joints:
        if tree.is_active(joint):
            limits = compute_allowed_range(tree.robot, joint.name)
            if all(map(math.isfinite, limits)) and limits[0] < limits[1]:
                found[joint.name] = limits[end]
    return found


def _measure_spread(tree: BodyTree, gripper: Gripper, positions: Mapping[str, float]) -> float:
    """Measure the sum of distances between the centers of mass of the fingers [m].

    A single finger is compared with the palm.
    """
    robot = tree.robot
    poses = compute_link_poses(robot, positions)
    ends = [j.child for j in gripper.joints if not tree.get_joints_below(j.child)]
    links = ends if len(ends) > 1 else [gripper.palm, *ends]
    centers = []
    for name in links:
        inertial = robot.link[name].inertial
        origin = inertial.origin if inertial is not None else None
        centers.append(poses[name].transform(origin.xyz if origin is not None else (0.0, 0.0, 0.0)))
    return sum(math.dist(one, two) for i, one in enumerate(centers) for two in centers[:i])
