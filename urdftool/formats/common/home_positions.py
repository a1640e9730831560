"""Joint positions at home: of the user, an SRDF, ros2_control, or zero within the limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from types import MappingProxyType

from ...errors import ConfigError, ModelError
from ...model.elements import Joint, Robot
from ...model.kinematics import check_positions, find_movable_joints
from ...model.start import compute_allowed_range, list_initial_positions, start_positions
from ..written import Written
from .srdf import Srdf

NAMES = ("home", "default", "ready", "stand", "standing", "initial", "neutral")
"""Names of SRDF group states, in order of preference for the home configuration."""

STAND = "stand"
"""Word of ``--pose`` for a pose in which the robot stands."""


@dataclass(frozen=True)
class HomePositions:
    """Joint positions of the home configuration.

    Attributes:
        values: Position of each joint [rad, m].
        given: Joints whose position the user, an SRDF or ros2_control gives.
        clamped: Joints that start at a limit, because zero is outside of their range.
        stands: Whether the user asks for a pose in which the robot stands.
    """

    values: dict[str, float]
    given: frozenset[str] = frozenset()
    clamped: frozenset[str] = frozenset()
    stands: bool = False


def choose_home_positions(
    robot: Robot,
    pose: Mapping[str, float],
    state: str,
    srdf: Srdf | None,
    written: Written,
    described: Mapping[str, float] = MappingProxyType({}),
) -> HomePositions:
    """Choose joint positions [rad, m] at home, within limits and consistent with mimic joints.

    Sources in order of precedence: the user's pose, a group state of the SRDF, the initial values
    of ros2_control, the home of the description, and zero or the limit nearest to it.

    Args:
        robot: The robot.
        pose: Positions by name of a joint or pattern, from the user.
        state: Name of a group state, from the user; empty for the first of ``NAMES``. ``STAND``
            without such a state is a pose in which the robot stands.
        srdf: The SRDF, if there is one.
        written: Receives the positions beyond limits.
        described: Positions of the home of the description, by joint.

    Raises:
        ConfigError: The SRDF has no such state.
        ModelError: A joint of ``pose`` does not exist, or mimics another that moves it elsewhere.
    """
    pose = _match_joints(robot, pose)
    check_positions(robot, pose)
    mimics = _list_mimics(robot)
    stands = state == STAND and (srdf is None or state not in srdf.states)
    found: dict[str, float] = {}
    for source, positions in (
        ("its description", described),
        ("ros2_control", list_initial_positions(robot)),
        ("the SRDF", _get_state(srdf, "" if stands else state)),
        ("--pose", pose),
    ):
        for name, value in positions.items():
            joint = robot.joint.get(name)
            if joint is not None and name not in mimics:
                found[name] = _compute_within(robot, joint, value, source, written)
    values, clamped = start_positions(robot, found)
    return HomePositions(values, frozenset(found), frozenset(clamped), stands)


def _match_joints(robot: Robot, pose: Mapping[str, float]) -> dict[str, float]:
    """Return positions by joint; a name counts more than a pattern, a later pattern more.

    Raises:
        ModelError: No joint matches a pattern.
    """
    movable = find_movable_joints(robot)
    mimics = _list_mimics(robot)
    found: dict[str, float] = {}
    for pattern, value in pose.items():
        if pattern in movable or not set(pattern) & set("*?["):
            continue
        fitting = [n for n in movable if fnmatchcase(n, pattern) and n not in mimics]
        if not fitting:
            names = ", ".join(movable) or "none"
            raise ModelError(f"no joint that moves matches '{pattern}'; there are {names}")
        found |= dict.fromkeys(fitting, value)
    own = {name: value for name, value in pose.items()
           if name in movable or not set(name) & set("*?[")}  # fmt: skip
    return found | own


def _list_mimics(robot: Robot) -> set[str]:
    """Return the names of the movable joints that mimic another."""
    movable = find_movable_joints(robot)
    return {n for n, joint in movable.items() if joint.mimic and joint.mimic.joint in movable}


def _compute_within(
    robot: Robot, joint: Joint, value: float, source: str, written: Written
) -> float:
    lower, upper = compute_allowed_range(robot, joint.name)
    if lower > upper or lower <= value <= upper:
        return value
    near = min(max(value, lower), upper)
    written.report_loss(
        "home",
        f"position {value:g} of joint '{joint.name}' in {source} is beyond its limits; the "
        f"home position has {near:g}",
        joint.place if joint.limit is None else joint.limit.place,
        kind="joint",
        name=joint.name,
    )
    return near


def _get_state(srdf: Srdf | None, name: str) -> Mapping[str, float]:
    """Return the joint positions of a group state, merged over all groups that define it."""
    states = {} if srdf is None else srdf.states
    if name:
        if name in states:
            return states[name]
        known = f"it has {', '.join(states)}" if states else "it has none"
        where = f"the SRDF has no group state '{name}'; {known}"
        raise ConfigError(
            where if srdf is not None else f"--pose {name} is a group state of an SRDF; add --srdf",
            path=None if srdf is None else srdf.path,
        )
    return next((states[known] for known in _list_candidates(states)), {})


def _list_candidates(states: Mapping[str, Mapping[str, float]]) -> Iterator[str]:
    """Yield the names of states, the likeliest home configuration first."""
    lowered = {name.casefold(): name for name in reversed(list(states))}
    yield from (lowered[name] for name in NAMES if name in lowered)
    yield from states
