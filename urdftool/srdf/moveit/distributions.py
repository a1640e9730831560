"""What differs between the ROS 2 distributions for a MoveIt configuration."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Distribution:
    """Distribution of ROS 2."""

    name: str
    gripper_controller: str
    gripper_package: str
    gripper_type: str


_SINGLE = (
    "position_controllers/GripperActionController",
    "gripper_controllers",
    "GripperCommand",
)
_PARALLEL = (
    "parallel_gripper_action_controller/GripperActionController",
    "parallel_gripper_controller",
    "ParallelGripperCommand",
)

DISTRIBUTIONS = {
    "humble": Distribution("humble", *_SINGLE),
    "jazzy": Distribution("jazzy", *_SINGLE),
    "kilted": Distribution("kilted", *_PARALLEL),
    "rolling": Distribution("rolling", *_PARALLEL),
}
"""Distributions by name. Kilted removed the controller of Jazzy (ros2_controllers,
``doc/migration.html``); MoveIt knows the action of the new one from Kilted on."""

DEFAULT = "jazzy"
