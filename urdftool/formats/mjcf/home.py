"""The position in which the robot starts: where the joints are, and how high a free base stands."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from ...errors import ConfigError, ModelError
from ...model.elements import Joint, Origin, Robot, Vector
from ...model.kinematics import check_positions, link_poses, movable_joints
from ...model.pose import Pose, pose_of
from ...model.read import number, numbers
from ...model.start import allowed_positions, start_positions
from ..written import Written
from .shape_box import ShapeBoxes
from .srdf import Srdf
from .standing import ground_of
from .structure import Structure

NAMES = ("home", "default", "ready", "stand", "standing", "initial", "neutral")
"""Names of an SRDF's group states, in the order in which they are taken for the home position."""

NEAT = 1e-6
"""The step to which the height of a base is rounded down [m]."""


@dataclass(frozen=True)
class Home:
    """Where a robot starts.

    Attributes:
        positions: Of the joints that have one [rad, m].
        pose: The pose of the root with the joints there; a free one stands on the floor.
        start: The same with every joint at zero, or at its lock.
        floating: The poses of the bodies below floating joints, by the name of the joint.
    """

    positions: dict[str, float]
    pose: Pose
    start: Pose
    floating: dict[str, Pose]


def home_of(structure: Structure, boxes: ShapeBoxes, positions: dict[str, float]) -> Home:
    """Put a robot on the floor at z = 0, where its root is free; a held one stays as it is.

    A floating joint below a root that is the world is one of a free base, too: what it carries is
    lifted where it would reach below the floor.

    Args:
        structure: The tree.
        boxes: The boxes of its shapes.
        positions: Of the joints at home [rad, m].
    """
    root = pose_of(robot_origin(structure.robot))
    pose, start = root, root
    if structure.free:
        pose = lifted(structure, boxes, positions, root)
        start = lifted(structure, boxes, structure.locked, root)
    poses = link_poses(structure.robot, positions)
    floating = {
        joint.name: pose @ poses[joint.child]
        for joint in structure.moving
        if structure.kind(joint) == "free"
    }
    if structure.in_world and floating:
        ground = ground_of(structure, boxes, positions, root)
        depth = 0.0 if ground is None else min(ground.low, 0.0)
        above = Pose(translation=(0.0, 0.0, _neat(-depth)))
        floating = {name: above @ there for name, there in floating.items()}
    return Home(positions, pose, start, floating)


def home_positions(
    structure: Structure,
    pose: Mapping[str, float],
    state: str,
    srdf: Srdf | None,
    written: Written,
) -> dict[str, float]:
    """Choose the position [rad, m] of every joint that has one, within limits, mimics consistent.

    In this order, what is not given by one comes from the next: the user's pose, a group state of
    the SRDF, the initial values of ros2_control, and zero or the limit nearest to it.

    Args:
        structure: The tree.
        pose: Positions by joint, from the user.
        state: The name of a group state, from the user; empty for the first of ``NAMES``.
        srdf: The SRDF, if there is one.
        written: Takes positions that are beyond limits.

    Raises:
        ConfigError: The SRDF has no such state.
        ModelError: The joint does not exist, or it mimics another.
    """
    robot = structure.robot
    check_positions(robot, pose)
    leaders = _leaders(robot)
    for name in pose:
        if name in leaders:
            raise ModelError(
                f"joint '{name}' mimics '{leaders[name]}'; give a position of that joint instead"
            )
    found: dict[str, float] = {}
    for source, positions in (
        ("ros2_control", _initial_positions(robot)),
        ("the SRDF", _state(srdf, state)),
        ("--pose", pose),
    ):
        for name, value in positions.items():
            joint = robot.joint.get(name)
            if joint is not None and name not in leaders:
                found[name] = _within(robot, joint, value, source, written)
    return start_positions(robot, found)[0]


def _leaders(robot: Robot) -> dict[str, str]:
    """Whom each joint mimics that mimics another."""
    movable = movable_joints(robot)
    return {
        joint.name: joint.mimic.joint
        for joint in movable.values()
        if joint.mimic is not None and joint.mimic.joint in movable
    }


def _within(robot: Robot, joint: Joint, value: float, source: str, written: Written) -> float:
    lower, upper = allowed_positions(robot, joint.name)
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


def _initial_positions(robot: Robot) -> dict[str, float]:
    """The initial position [rad or m] of each joint for which ros2_control gives one."""
    found = {}
    for block in robot.ros2_controls:
        for component in block.joints:
            for interface in component.state_interfaces:
                value = number(interface.params.get("initial_value"))
                if interface.name == "position" and value is not None:
                    found[component.name] = value
            value = number(component.params.get("initial_position"))
            if value is not None:
                found.setdefault(component.name, value)
    return found


def _state(srdf: Srdf | None, name: str) -> Mapping[str, float]:
    """The positions of a group state, of all groups that have one of its name."""
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
    return next((states[known] for known in _candidates(states)), {})


def _candidates(states: Mapping[str, Mapping[str, float]]) -> Iterator[str]:
    """The names of states, the likeliest home position first."""
    lowered = {name.casefold(): name for name in reversed(list(states))}
    yield from (lowered[name] for name in NAMES if name in lowered)
    yield from states


def robot_origin(robot: Robot) -> Origin | None:
    """Return the pose of the whole robot in its world, which some readers take from ``<robot>``."""
    element = robot.element.child("origin")
    if element is None:
        return None
    zero: Vector = (0.0, 0.0, 0.0)
    xyz, rpy = numbers(element.get("xyz"), 3), numbers(element.get("rpy"), 3)
    return Origin(
        element,
        zero if xyz is None else (xyz[0], xyz[1], xyz[2]),
        zero if rpy is None else (rpy[0], rpy[1], rpy[2]),
    )


def lifted(
    structure: Structure, boxes: ShapeBoxes, positions: Mapping[str, float], root: Pose
) -> Pose:
    """Raise or lower the root so that the lowest point of what collides is at z = 0.

    Args:
        structure: The tree.
        boxes: The boxes of its shapes.
        positions: Of the joints [rad, m].
        root: The pose of the root as the description has it.
    """
    ground = ground_of(structure, boxes, positions, root)
    if ground is None:
        return root
    x, y, z = root.translation
    return Pose(root.rotation, (x, y, _neat(z - ground.low)))


def _neat(height: float) -> float:
    """Round a height [m] down to a number that is short to write, so that what touches, touches."""
    if not abs(height) < 1 / NEAT:  # of no robot; a double has no micrometers left there
        return height
    return math.floor(height / NEAT + 1e-3) / round(1 / NEAT)
