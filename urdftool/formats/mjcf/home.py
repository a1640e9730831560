"""The home configuration: joint positions, and the height of a floating base."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from ...errors import ConfigError, ModelError
from ...model.elements import Joint, Origin, Robot, Vector
from ...model.kinematics import check_positions, find_movable_joints, link_poses
from ...model.pose import Pose, make_pose
from ...model.read import parse_numbers
from ...model.start import (
    compute_allowed_range,
    list_initial_positions,
    start_positions,
)
from ..common.shape_box import ShapeBoxes
from ..common.srdf import Srdf
from ..common.standing import measure_ground
from ..written import Written
from .structure import Structure

NAMES = ("home", "default", "ready", "stand", "standing", "initial", "neutral")
"""Names of SRDF group states, in order of preference for the home configuration."""

NEAT = 1e-6
"""Step [m] to which the height of a base is rounded down."""


@dataclass(frozen=True)
class Home:
    """Initial configuration of a robot.

    Attributes:
        positions: Joint positions [rad, m].
        pose: Pose of the root at these positions; a free root stands on the floor.
        start: Pose of the root with every joint at zero or at its locked position.
        floating: Poses of the bodies below floating joints, by joint name.
    """

    positions: dict[str, float]
    pose: Pose
    start: Pose
    floating: dict[str, Pose]


def place_home(structure: Structure, boxes: ShapeBoxes, positions: dict[str, float]) -> Home:
    """Place a robot with a free root on the floor at z = 0; a fixed one keeps its pose.

    A floating joint below a world root counts as a floating base: the bodies that it carries are
    lifted if they would reach below the floor.

    Args:
        structure: The kinematic tree.
        boxes: Boxes of its shapes.
        positions: Joint positions at home [rad, m].
    """
    root = make_pose(get_robot_origin(structure.robot))
    pose, start = root, root
    if structure.free:
        pose = shift_lifted(structure, boxes, positions, root)
        start = shift_lifted(structure, boxes, structure.locked, root)
    poses = link_poses(structure.robot, positions)
    floating = {
        joint.name: pose @ poses[joint.child]
        for joint in structure.moving
        if structure.get_kind(joint) == "free"
    }
    if structure.in_world and floating:
        ground = measure_ground(structure, boxes, positions, root)
        depth = 0.0 if ground is None else min(ground.low, 0.0)
        above = Pose(translation=(0.0, 0.0, _round_neat(-depth)))
        floating = {name: above @ there for name, there in floating.items()}
    return Home(positions, pose, start, floating)


def choose_home_positions(
    structure: Structure,
    pose: Mapping[str, float],
    state: str,
    srdf: Srdf | None,
    written: Written,
) -> dict[str, float]:
    """Choose joint positions [rad, m] at home, within limits and consistent with mimic joints.

    Sources in order of precedence: the user's pose, a group state of the SRDF, the initial values
    of ros2_control, and zero or the limit nearest to it.

    Args:
        structure: The kinematic tree.
        pose: Positions by joint, from the user.
        state: Name of a group state, from the user; empty for the first of ``NAMES``.
        srdf: The SRDF, if there is one.
        written: Receives the positions beyond limits.

    Raises:
        ConfigError: The SRDF has no such state.
        ModelError: A joint of ``pose`` does not exist or mimics another.
    """
    robot = structure.robot
    check_positions(robot, pose)
    leaders = _get_leaders(robot)
    for name in pose:
        if name in leaders:
            raise ModelError(
                f"joint '{name}' mimics '{leaders[name]}'; give a position of that joint instead"
            )
    found: dict[str, float] = {}
    for source, positions in (
        ("ros2_control", list_initial_positions(robot)),
        ("the SRDF", _state(srdf, state)),
        ("--pose", pose),
    ):
        for name, value in positions.items():
            joint = robot.joint.get(name)
            if joint is not None and name not in leaders:
                found[name] = _compute_within(robot, joint, value, source, written)
    return start_positions(robot, found)[0]


def _get_leaders(robot: Robot) -> dict[str, str]:
    """Return the leader of each movable mimic joint, by name."""
    movable = find_movable_joints(robot)
    return {
        joint.name: joint.mimic.joint
        for joint in movable.values()
        if joint.mimic is not None and joint.mimic.joint in movable
    }


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


def _state(srdf: Srdf | None, name: str) -> Mapping[str, float]:
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


def get_robot_origin(robot: Robot) -> Origin | None:
    """Return the pose of the root in the world; ``<origin>`` of ``<robot>`` in URDF."""
    if robot.base is not None:
        return robot.base.origin
    element = robot.find_child_xml("origin")
    if element is None:
        return None
    zero: Vector = (0.0, 0.0, 0.0)
    xyz, rpy = parse_numbers(element.get("xyz"), 3), parse_numbers(element.get("rpy"), 3)
    return Origin(
        element,
        zero if xyz is None else (xyz[0], xyz[1], xyz[2]),
        zero if rpy is None else (rpy[0], rpy[1], rpy[2]),
    )


def shift_lifted(
    structure: Structure, boxes: ShapeBoxes, positions: Mapping[str, float], root: Pose
) -> Pose:
    """Shift the root vertically so that the lowest point of the collision geometry is at z = 0.

    Args:
        structure: The kinematic tree.
        boxes: Boxes of its shapes.
        positions: Joint positions [rad, m].
        root: Pose of the root in the description.
    """
    ground = measure_ground(structure, boxes, positions, root)
    if ground is None:
        return root
    x, y, z = root.translation
    return Pose(root.rotation, (x, y, _round_neat(z - ground.low)))


def _round_neat(height: float) -> float:
    """Round a height [m] down to micrometers, so that contacts at the floor are kept."""
    if not abs(height) < 1 / NEAT:  # a double has no micrometer resolution there
        return height
    return math.floor(height / NEAT + 1e-3) / round(1 / NEAT)
