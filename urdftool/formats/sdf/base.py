"""The base that a user chooses: SDF fixes a model by a joint between the world and its root."""

from __future__ import annotations

from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mechanism import Base
from ...model.start import start_positions
from ...model.world import WORLD, find_model_origin, weld_base
from ..common.base import decide_base
from ..common.rigid_tree import group_rigid_links
from ..common.shape_box import ShapeBoxes
from ..written import Written
from .options import ChosenBase


def apply_base(robot: Robot, base: ChosenBase, written: Written) -> Robot:
    """Return the robot with a joint to the world if its base is fixed by ``base``.

    Args:
        robot: The source; without a choice, or with several roots, it is returned as it is.
        base: The choice; ``auto`` decides as exports to MJCF and USD do.
        written: Receives a note about the joint, or about a base that is free.
    """
    roots = robot.tree.roots
    if base == "" or base == "free" or len(roots) != 1 or roots[0].name == WORLD:
        return robot
    tree = group_rigid_links(robot, lambda joint: not joint.is_fixed)
    home, _ = start_positions(robot)
    is_free, reason = decide_base(tree, base, None, ShapeBoxes(robot), home, written)
    if is_free:
        return robot
    written.report_loss(
        "welded-base",
        f"root link '{roots[0].name}' is fixed to the world: {reason}",
        roots[0].place,
        kind="link",
        name=roots[0].name,
        severity=Severity.INFO,
    )
    return weld_base(replace(robot, base=Base(robot.provenance, False, find_model_origin(robot))))
