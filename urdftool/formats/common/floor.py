"""The height at which a robot stands on the floor."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ...model.pose import Pose
from .rigid_tree import RigidTree
from .shape_box import ShapeBoxes
from .standing import measure_ground

NEAT = 1e-6
"""Step [m] to which the height of a base is rounded down."""


def lift_to_floor(
    tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float], root: Pose
) -> Pose:
    """Shift the root vertically so that the lowest point of the collision geometry is at z = 0."""
    ground = measure_ground(tree, boxes, positions, root)
    if ground is None:
        return root
    x, y, z = root.translation
    return Pose(root.rotation, (x, y, round_neat(z - ground.low)))


def round_neat(height: float) -> float:
    """Round a height [m] down to micrometers, so that contacts at the floor are kept."""
    if not abs(height) < 1 / NEAT:  # a double has no micrometer resolution there
        return height
    return math.floor(height / NEAT + 1e-3) / round(1 / NEAT)
