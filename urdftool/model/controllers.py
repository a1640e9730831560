"""Controllers in YAML files of ros_control and ros2_control: type and parameters."""

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
"""Parameters that name velocity-controlled and position-controlled joints, by controller class."""

_JOINTS = ("joints", "joint", "dof_names", "dof_name", "command_joints")


@dataclass(frozen=True, eq=False)
class Controller:
    """Controller of a parameter file."""

    name: str
    type: Node
    parameters: Node

    @property
    def kind(self) -> str:
        """Return the class, such as ``DiffDriveController``."""
        return (self.type.text or "").rpartition("/")[2].rpartition(":")[2]

    @property
    def package(self) -> str:
        """Return the package of the class."""
        return (self.type.text or "").partition("/")[0]

    @property
    def joints(self) -> list[Node]:
        """Return the scalars that name joints, in the order of the parameter table."""
        wheels, steered = DRIVES.get(self.kind, ((), ()))
        return [one for name in (*wheels, *steered, *_JOINTS) for one in self.list_scalars(name)]

    def list_scalars(self, parameter: str) -> list[Node]:
        """Return the non-empty scalars of a parameter, which may be one scalar or a list."""
        node = (self.parameters.fields or {}).get(parameter)
        nodes = [] if node is None else [node] if node.items is None else node.items
        return [one for one in nodes if one.text]


def extract_joint(node: Node) -> str:
    """Return the joint that a scalar names, without a controller prefix."""
    return (node.text or "").rpartition("/")[2]


def list_controllers(root: Node) -> Iterator[Controller]:
    """Yield each controller with its parameters, which ROS 2 writes apart from its type."""
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
            continue  # not a controller class
        yield Controller(name, kind, parameters.get(name, node))
