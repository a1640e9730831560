"""Initial joint positions: zero, or the nearest value within the limits."""

from __future__ import annotations

import math
from collections.abc import Mapping

from .elements import Joint, Robot
from .kinematics import add_mimic_positions, find_movable_joints, follow_mimic_chain, get_limits
from .numbers import number


def start_positions(
    robot: Robot, positions: Mapping[str, float] | None = None
) -> tuple[dict[str, float], dict[str, float]]:
    """Return an initial position for every joint that has one, consistent with ``<mimic>``.

    A joint starts at zero or at its limit nearest to zero; a joint that others mimic at a value
    that is also within their limits, if possible.

    Args:
        robot: The robot.
        positions: Positions by joint name [rad, m], used unchanged.

    Returns:
        The positions [rad, m], and those that a limit moves away from zero.
    """
    given = dict(positions or {})
    clamped = {}
    reaches = _compute_ranges(robot)
    for name, (lower, upper) in reaches.items():
        if name not in given and lower <= upper and not lower <= 0.0 <= upper:
            given[name] = clamped[name] = lower if lower > 0 else upper
    found = add_mimic_positions(robot, given)
    for joint in robot.joints:
        lower, upper = get_limits(joint)
        if joint.mimic is not None and joint.name not in given and lower < upper:
            found[joint.name] = min(max(found.get(joint.name, 0.0), lower), upper)
    return found, clamped


def list_initial_positions(robot: Robot) -> dict[str, float]:
    """Return the initial joint positions of ros2_control [rad, m], by joint name.

    They are ``initial_value`` of the position interface, else the parameter ``initial_position``.
    """
    initial_positions: dict[str, float] = {}
    for block in robot.ros2_controls:
        for component in block.joints:
            for interface in component.state_interfaces:
                value = number(interface.params.get("initial_value"))
                if interface.name == "position" and value is not None:
                    initial_positions[component.name] = value
            value = number(component.params.get("initial_position"))
            if value is not None:
                initial_positions.setdefault(component.name, value)
    return initial_positions


def compute_allowed_range(robot: Robot, name: str) -> tuple[float, float]:
    """Return the range of positions [rad, m] of a joint, narrowed by the joints that mimic it."""
    return _compute_ranges(robot).get(name, (-math.inf, math.inf))


def _compute_ranges(robot: Robot) -> dict[str, tuple[float, float]]:
    """Return the limits [rad, m] of each leading joint, narrowed by the joints that mimic it."""
    movable = find_movable_joints(robot)
    reaches = {joint.name: get_limits(joint) for joint in movable.values() if joint.mimic is None}
    for joint in movable.values():
        if joint.mimic is None or not _is_limited(joint):
            continue
        leader, scale, shift = follow_mimic_chain(joint, movable)
        if leader not in reaches or not scale:
            continue
        lower, upper = sorted((bound - shift) / scale for bound in get_limits(joint))
        own = reaches[leader]
        both = max(lower, own[0]), min(upper, own[1])
        if both[0] <= both[1]:
            reaches[leader] = both
    return reaches


def _is_limited(joint: Joint) -> bool:
    lower, upper = get_limits(joint)
    return joint.is_limited and lower < upper
