"""Robots whose description has y up: the base of a robot on legs is turned so that it stands.

URDF defines z up. Some meshes and robots come from tools with y up, and lie on their side then.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Origin, Robot, Vector
from ...model.mechanism import Base
from ..written import Written
from .base_pose import get_robot_origin
from .legs import find_legs
from .rigid_tree import RigidGroups, RigidTree
from .shape_box import ShapeBoxes
from .standing import LEVEL, describe_feet, find_leg_chains, measure_ground
from .standing_pose import MARGIN, compute_standing_margin, compute_standing_positions

Y_UP: Vector = (math.pi / 2, 0.0, 0.0)
"""Roll, pitch, yaw [rad] of a base whose y axis points up."""


def turn_upright(
    tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float], written: Written
) -> Robot:
    """Return the robot; with a turned base if it stands on its legs with y up, and not with z up.

    A pose of the base in the description, or another format than URDF, defines what is up.
    """
    robot = tree.robot
    if robot.format != "urdf" or get_robot_origin(robot) is not None:
        return robot
    if _can_stand(tree, boxes, positions):
        return robot
    base = Base(robot.provenance, True, Origin(robot.provenance, rpy=Y_UP))
    turned = replace(robot, base=base)
    groups = RigidGroups(turned, tree.root, tree.moving, tree.group, tree.members)
    if not _can_stand(groups, boxes, positions):
        return robot
    written.report_loss(
        "y-up",
        f"root link '{tree.root.name}' is turned by 90° about x: the robot lies with z up and "
        'stands on its legs with y up; <origin rpy="0 0 0"/> in <robot> keeps z up',
        tree.root.place,
        kind="link",
        name=tree.root.name,
        severity=Severity.INFO,
    )
    return turned


def _can_stand(tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float]) -> bool:
    """Tell whether a robot stands on the ends of all its legs, as it is or with bent legs."""
    ends, ground = find_leg_chains(tree, boxes, positions), measure_ground(tree, boxes, positions)
    if ground is None or len(ends) < 2:
        return False
    is_level = set(ends) <= set(ground.get_near(LEVEL))
    if is_level and describe_feet(tree, boxes, positions) is not None:
        return True
    legs = find_legs(tree, boxes, positions)
    if len(legs) < len(ends):
        return False
    found = compute_standing_positions(tree, boxes, legs, positions)
    return found is not None and compute_standing_margin(tree, boxes, found) >= MARGIN
