"""The start of a simulation: the home of ``export mjcf``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..model.elements import Robot
from ..model.kinematics import find_movable_joints
from ..model.pose import make_pose, rpy_from_rotation
from ..model.start import start_positions

if TYPE_CHECKING:
    from ..finding import Finding
    from ..simulation.settings import Settings


def choose_start(robot: Robot, settings: Settings) -> tuple[Settings, list[Finding]]:
    """Choose the positions at which ``export mjcf`` starts a robot, for joints without a position.

    Args:
        robot: The robot.
        settings: Settings of the simulation; its pose comes first.

    Returns:
        The settings with the positions that differ from zero within the limits and the rotation of
        the root in the description, and notes on them.
    """
    from ..formats.common.base import decide_base
    from ..formats.common.base_pose import get_robot_origin
    from ..formats.common.holding_pose import choose_holding_positions
    from ..formats.common.home_positions import choose_home_positions
    from ..formats.common.shape_box import ShapeBoxes
    from ..formats.common.standing_pose import choose_standing_positions
    from ..formats.common.upright import turn_upright
    from ..formats.mjcf.structure import create_structure
    from ..formats.written import Written
    from ..simulation.rigid_bodies import has_fixed_base

    leading = {n for n, joint in find_movable_joints(robot).items() if joint.mimic is None}
    is_tree = len(robot.tree.roots) == 1 and not robot.tree.detached
    if not is_tree or not settings.pose.keys() <= leading:
        return settings, []  # which is refused
    written = Written("")
    tree, boxes = create_structure(robot), ShapeBoxes(robot)
    home = choose_home_positions(robot, settings.pose, "", None, written)
    is_free, reason = decide_base(tree, "auto", None, boxes, home.values, Written(""))
    if not is_free and not settings.fixed_base and not has_fixed_base(robot, tree.root):
        settings = replace(settings, fixed_in_exports=reason)
    is_free = is_free and not settings.fixed_base
    positions = home.values
    if is_free:
        tree = replace(tree, robot=turn_upright(tree, boxes, positions, written))
        positions = choose_standing_positions(tree, boxes, home, written)
        positions = choose_holding_positions(tree, boxes, home, positions, written)
    origin = get_robot_origin(tree.robot)
    turn = rpy_from_rotation(make_pose(origin).rotation)
    plain = start_positions(robot)[0]
    pose = {n: v for n, v in positions.items() if n in leading and v != plain.get(n, 0.0)}
    settings = replace(settings, pose=pose | settings.pose)
    if not any(settings.upright_rpy):
        settings = replace(settings, upright_rpy=turn)
    return settings, written.losses
