"""A home that the servos hold: joints whose effort limit is too low at home start elsewhere."""

from __future__ import annotations

from collections.abc import Mapping

from ...diagnostic import Severity
from ...mechanics.spatial_inertia import SpatialInertia, link_inertia
from ...model.elements import Joint
from ...model.pose import Pose, make_pose
from ...model.start import compute_allowed_range, start_positions
from ..written import Written
from .base_pose import get_robot_origin
from .home_positions import HomePositions
from .joint_loads import JointLoad, compute_joint_loads
from .rigid_tree import RigidTree
from .servo_gains import drop_unlimited
from .shape_box import ShapeBoxes
from .standing import measure_ground
from .standing_pose import MARGIN, compute_standing_margin

RESERVE = 0.8
"""Largest load relative to the effort limit at the position that is chosen; chosen, no source."""

FARTHEST = 0.5
"""Largest change of a position [rad]; chosen, no source."""

_STEPS = 25  # in each direction; chosen


def choose_holding_positions(
    tree: RigidTree,
    boxes: ShapeBoxes,
    home: HomePositions,
    positions: Mapping[str, float],
    written: Written,
) -> dict[str, float]:
    """Choose positions of a free robot at which the effort limits carry the load.

    A revolute joint that would move at home gets the nearest position that it holds, if the center
    of mass stays above the support polygon. Positions that the user or a file gives are kept.
    """
    found = dict(positions)
    masses = {link.name: link_inertia(link) for link in tree.robot.links if link.mass > 0}
    loads = _compute_loads(tree, boxes, masses, found)
    for joint in tree.moving:
        effort = _get_effort(joint)
        load = loads.get(joint.name, JointLoad())
        if not effort or joint.mimic is not None or joint.name in home.given:
            continue
        if joint.type != "revolute" or load.force <= effort:
            continue
        nearest = _find_nearest(tree, boxes, masses, found, joint)
        if nearest is not None:
            _report_moved(joint, load.force, nearest[joint.name], written)
            found = nearest
    return found


def _get_effort(joint: Joint) -> float | None:
    """Return the effort limit [N·m]; None without one."""
    return drop_unlimited(joint.get_magnitude("effort"))


def _find_nearest(
    tree: RigidTree,
    boxes: ShapeBoxes,
    masses: Mapping[str, SpatialInertia],
    positions: Mapping[str, float],
    joint: Joint,
) -> dict[str, float] | None:
    """Find the nearest position of a joint that its effort limit holds; None if there is none."""
    most, start = RESERVE * (_get_effort(joint) or 0.0), positions.get(joint.name, 0.0)
    lower, upper = compute_allowed_range(tree.robot, joint.name)
    steps = [
        sign * FARTHEST * number / _STEPS for number in range(1, _STEPS + 1) for sign in (1, -1)
    ]
    for step in steps:
        value = start + step
        if not lower <= value <= upper:
            continue
        moved = start_positions(tree.robot, {**_list_leading(tree, positions), joint.name: value})[
            0
        ]
        load = _compute_loads(tree, boxes, masses, moved)[joint.name]
        if load.force <= most and compute_standing_margin(tree, boxes, moved) >= MARGIN:
            return moved
    return None


def _list_leading(tree: RigidTree, positions: Mapping[str, float]) -> dict[str, float]:
    """Return the positions of joints that mimic no other."""
    joints = tree.robot.joint
    return {
        name: value
        for name, value in positions.items()
        if name in joints and joints[name].mimic is None
    }


def _compute_loads(
    tree: RigidTree,
    boxes: ShapeBoxes,
    masses: Mapping[str, SpatialInertia],
    positions: Mapping[str, float],
) -> dict[str, JointLoad]:
    root = Pose(make_pose(get_robot_origin(tree.robot)).rotation)
    ground = measure_ground(tree, boxes, positions, root)
    return compute_joint_loads(tree, masses, positions, root, ground)


def _report_moved(joint: Joint, force: float, value: float, written: Written) -> None:
    effort = _get_effort(joint) or 0.0
    written.report_loss(
        "weak-joint",
        f"joint '{joint.name}' requires {force:.3g} N·m at home, and its effort limit is "
        f"{effort:.3g} N·m: the home position has {value:.3g}, which it holds; --pose "
        "JOINT=VALUE sets another",
        joint.place if joint.limit is None else joint.limit.place,
        kind="joint",
        name=joint.name,
        severity=Severity.INFO,
        data={"force": force, "effort": effort, "position": value},
    )
