"""The home configuration: joint positions, and the height of a floating base."""

from __future__ import annotations

from dataclasses import dataclass

from ...model.kinematics import link_poses
from ...model.pose import Pose, make_pose
from ..common.base_pose import get_robot_origin
from ..common.floor import lift_to_floor, round_neat
from ..common.shape_box import ShapeBoxes
from ..common.standing import measure_ground
from .structure import Structure


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
    """Place a robot with a free root on the floor at z = 0.

    A fixed root, and that of an MJCF, keeps its pose. A floating joint below a world root
    counts as a floating base: the bodies that such joints carry are lifted together if they would
    reach below the floor.
    """
    root = make_pose(get_robot_origin(structure.robot))
    pose, start = root, root
    if structure.free and structure.robot.format != "mjcf":  # whose author chose the height
        pose = lift_to_floor(structure, boxes, positions, root)
        start = lift_to_floor(structure, boxes, structure.locked, root)
    poses = link_poses(structure.robot, positions)
    floating = {
        joint.name: pose @ poses[joint.child]
        for joint in structure.moving
        if structure.get_kind(joint) == "free"
    }
    if structure.in_world and floating and structure.robot.format != "mjcf":
        ground = measure_ground(structure, boxes, positions, root)
        lows = map(ground.get_lowest, _list_carried(structure)) if ground is not None else ()
        above = Pose(translation=(0.0, 0.0, round_neat(-min((*lows, 0.0)))))
        floating = {name: above @ there for name, there in floating.items()}
    return Home(positions, pose, start, floating)


def _list_carried(structure: Structure) -> list[str]:
    """List the topmost links of the rigid bodies that floating joints carry."""
    carried: dict[str, None] = {}
    for joint in structure.joints:
        if structure.get_kind(joint) == "free" or structure.group[joint.parent] in carried:
            carried[structure.group[joint.child]] = None
    return list(carried)
