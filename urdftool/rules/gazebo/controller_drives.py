"""Find the wheels and parameters of ``diff_drive_controller`` in YAML files."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.controllers import Controller, extract_joint
from ...model.elements import Robot
from ...model.kinematics import link_poses
from ...model.pose import Pose
from ...model.read import number
from ...source.description import Description
from ...source.yaml_tree import Node
from ..control.controller_files import get_package
from .drive_wheels import ConfiguredLength, Drive, get_wheel


def find_controller_drives(
    robot: Robot, description: Description, poses: dict[str, Pose]
) -> Iterator[Drive]:
    """Yield the controllers with known wheels, from the controller files of a robot.

    Args:
        robot: The robot.
        description: Its description.
        poses: Poses of its links in the frame of the root; empty if not computed yet.
    """
    for file in get_package(robot, description).controller_files:
        for controller in file.controllers:
            if controller.kind == "DiffDriveController":
                poses = poses or link_poses(robot)
                yield from _make_drive(robot, controller, poses)


def _make_drive(robot: Robot, controller: Controller, poses: dict[str, Pose]) -> Iterator[Drive]:
    sides = [
        [
            (node, get_wheel(robot, poses, extract_joint(node)))
            for end in ("_names", "")
            for node in controller.list_scalars(f"{side}_wheel{end}")
        ]
        for side in ("left", "right")
    ]
    pairs = [
        (left, right)
        for (_, left), (_, right) in zip(*sides, strict=False)
        if left is not None and right is not None
    ]
    if not pairs:
        return
    yield Drive(
        f"controller '{controller.name}'",
        pairs[0][0].joint,
        pairs,
        sides[0][0][0].place,
        len(pairs) > 1 or (_read_value(controller, "wheels_per_side") or 1) > 1,
        _is_simulated(robot),
        [
            (length, pairs[0])
            for length in _read_length(
                controller, "wheel_separation", "wheel_separation_multiplier"
            )
        ],
        [
            (length, pairs[0][0])
            for length in _read_length(
                controller,
                "wheel_radius",
                "wheel_radius_multiplier",
                "left_wheel_radius_multiplier",
            )
        ],
    )


def _read_length(
    controller: Controller, name: str, *multipliers: str
) -> Iterator[ConfiguredLength]:
    for node in controller.list_scalars(name):
        value = _read_number(node)
        if value is not None:
            scaled = value * math.prod(_read_value(controller, word) or 1.0 for word in multipliers)
            yield ConfiguredLength(name, value, scaled, node.place)


def _read_value(controller: Controller, name: str) -> float | None:
    return next((_read_number(node) for node in controller.list_scalars(name)), None)


def _read_number(node: Node) -> float | None:
    return None if node.quoted else number(node.text or "")


def _is_simulated(robot: Robot) -> bool:
    """Tell whether a simulator turns the wheels about their axes, unlike real hardware."""
    return any("_ros2_control/" in (block.plugin or "") for block in robot.ros2_controls) or any(
        "gazebo_ros_control" in plugin.filename for plugin in robot.plugins
    )
