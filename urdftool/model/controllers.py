"""The controllers in YAML of ros_control and ros2_control: type and parameters of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..source.yaml_tree import Node

DRIVES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "DiffDriveController": (
        ("left_wheel", "right_wheel", "left_wheel_names", "right_wheel_names"), ()
    ),
    "FourWheelSteeringController": (
        ("front_wheel", "rear_wheel"), ("front_steering", "rear_steering")
    ),
    "AckermannSteeringController": (
        ("rear_wheel", "rear_wheels_names", "traction_joints_names"),
        ("front_steer", "front_wheels_names", "steering_joints_names"),
    ),
    "TricycleController": (("traction_joint_name",), ("steering_joint_name",)),
    "TricycleSteeringController": (
        ("rear_wheels_names", "traction_joints_names"),
        ("front_wheels_names", "steering_joints_names"),
    ),
    "BicycleSteeringController": (
        ("rear_wheels_names", "traction_joints_names"),
        ("front_wheels_names", "steering_joints_names"),
    ),
    "MecanumDriveController": (
        ("front_left_wheel_command_joint_name", "front_right_wheel_command_joint_name",
         "rear_left_wheel_command_joint_name", "rear_right_wheel_command_joint_name"), ()
    ),
}  # fmt: skip
"""By class, the parameters with joints that are driven by velocity, and by position."""


@dataclass(frozen=True, eq=False)
class Controller:
    """A controller.

    Attributes:
        name: Its name, without namespaces.
        type: The scalar with its type.
        parameters: The mapping with its parameters.
    """

    name: str
    type: Node
    parameters: Node

    @property
    def kind(self) -> str:
        """Its class, such as ``DiffDriveController``."""
        return (self.type.text or "").rpartition("/")[2].rpartition(":")[2]

    @property
    def package(self) -> str:
        """The package of its class."""
        return (self.type.text or "").partition("/")[0]


def controllers_in(root: Node) -> Iterator[Controller]:
    """Each controller with its parameters, which in ROS 2 stand apart from its type."""
    parameters: dict[str, Node] = {}
    for path, node in root.walk():
        if path and path[-1] == "ros__parameters" and len(path) > 1:
            parameters.setdefault(path[-2].rpartition("/")[2], node)
    for path, node in root.walk():
        kind = (node.fields or {}).get("type")
        if kind is None or not path or kind.text is None:
            continue
        own = path[-2] if path[-1] == "ros__parameters" and len(path) > 1 else path[-1]
        name = own.rpartition("/")[2]
        if "/" not in kind.text and "::" not in kind.text:
            continue  # another thing with a type
        yield Controller(name, kind, parameters.get(name, node))
