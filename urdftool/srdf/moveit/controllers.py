"""Controllers of a MoveIt configuration: of ros2_control, and MoveIt's list of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ...model.controllers import extract_joint, list_controllers
from ...model.elements import Joint, Robot
from ...model.moveit_parameters import ACTIONS, MANAGER, get_action_type
from ...source.yaml_tree import Node
from ..name_parts import make_identifier
from .configuration import Configuration
from .yaml_text import Tree, Value

TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"

UPDATE_RATE = 100
"""Rate of the controller manager [Hz], the default of MoveIt's Setup Assistant."""

_COMMANDS = (("position",), ("velocity",), ("effort",))
_STATES = ("position", "velocity")


@dataclass(frozen=True)
class PlannedController:
    """Controller of some joints."""

    name: str
    kind: str
    type: str
    joints: list[str]
    commands: tuple[str, ...] = ("position",)
    states: tuple[str, ...] = _STATES


def plan_controllers(configuration: Configuration) -> list[PlannedController]:
    """Plan a controller for each group with joints that no other has."""
    planned: list[PlannedController] = []
    used: set[str] = set()
    groups = sorted(configuration.groups.values(), key=lambda group: bool(group.groups))
    for group in groups:
        joints = configuration.list_group_joints(group)
        free = [joint for joint in joints if joint.name not in used]
        if not free or group.groups:
            continue
        used |= {joint.name for joint in free}
        name = f"{make_identifier(group.name) or 'group'}_controller"
        taken = {one.name for one in planned}
        number = 2
        while name in taken:
            name, number = f"{make_identifier(group.name)}_{number}_controller", number + 1
        planned.append(_plan(configuration, name, free, is_gripper=configuration.is_gripper(group)))
    return planned


def _plan(
    configuration: Configuration, name: str, joints: list[Joint], *, is_gripper: bool
) -> PlannedController:
    names = [joint.name for joint in joints]
    commands, states = find_interfaces(configuration.robot, names)
    if is_gripper and len(joints) == 1 and commands == ("position",):
        kind = configuration.distribution.gripper_controller
        return PlannedController(name, kind, configuration.distribution.gripper_type, names)
    return PlannedController(name, TRAJECTORY, "FollowJointTrajectory", names, commands, states)


def find_interfaces(robot: Robot, names: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Find the interfaces of a trajectory controller that ros2_control has for all joints.

    Joints without ros2_control get a position interface from mock hardware. Without a command
    interface that all have, it is ``position``.

    Returns:
        The command interfaces and the state interfaces.
    """
    found = [one for block in robot.ros2_controls for one in block.joints if one.name in names]
    commands = [{one.name for one in joint.command_interfaces} for joint in found]
    states = [{one.name for one in joint.state_interfaces} for joint in found]
    if len({joint.name for joint in found}) < len(set(names)):
        commands.append({"position"})
    shared = next((c for c in _COMMANDS if all(set(c) <= one for one in commands)), _COMMANDS[0])
    read = tuple(name for name in _STATES if all(name in one for one in states))
    return shared, read if "position" in read else _STATES[:1]


def make_moveit_controllers(controllers: Sequence[PlannedController]) -> Tree:
    """Make the content of ``moveit_controllers.yaml``."""
    listed: dict[str, Value] = {"controller_names": [one.name for one in controllers]}
    for one in controllers:
        listed[one.name] = {
            "action_ns": ACTIONS[one.type],
            "type": one.type,
            "default": True,
            "joints": one.joints,
        }
    return {
        "moveit_controller_manager": f"{MANAGER}/MoveItSimpleControllerManager",
        "trajectory_execution": {
            "allowed_execution_duration_scaling": 1.2,
            "allowed_goal_duration_margin": 0.5,
            "allowed_start_tolerance": 0.01,
        },
        MANAGER: listed,
    }


def make_ros2_controllers(controllers: Sequence[PlannedController]) -> Tree:
    """Make the content of ``ros2_controllers.yaml``."""
    manager: dict[str, Value] = {"update_rate": UPDATE_RATE}
    manager |= {one.name: {"type": one.kind} for one in controllers}
    manager["joint_state_broadcaster"] = {"type": BROADCASTER}
    tree: dict[str, Value] = {"controller_manager": {"ros__parameters": manager}}
    tree |= {one.name: {"ros__parameters": _make_parameters(one)} for one in controllers}
    return tree


def _make_parameters(controller: PlannedController) -> Tree:
    if controller.kind != TRAJECTORY:
        return {"joint": controller.joints[0]}
    return {
        "joints": controller.joints,
        "command_interfaces": list(controller.commands),
        "state_interfaces": list(controller.states),
    }


def read_ros2_controllers(root: Node) -> Iterator[PlannedController]:
    """Yield the controllers of arms and grippers in an existing ``ros2_controllers.yaml``."""
    for one in list_controllers(root):
        kind = one.type.text or ""
        action = get_action_type(kind)
        if one.joints and action:
            names = [extract_joint(node) for node in one.joints]
            yield PlannedController(one.name, kind, action, names)


def read_moveit_controllers(root: Node, kind: str) -> Iterator[PlannedController]:
    """Yield the controllers in an existing ``moveit_controllers.yaml``."""
    for name, section in get_sections(root).items():
        fields = section.fields or {}
        type_ = fields["type"].text or "" if "type" in fields else "FollowJointTrajectory"
        names = [node.text for node in (fields["joints"].items or [])] if "joints" in fields else []
        if type_ in ACTIONS:
            chosen = TRAJECTORY if type_ == "FollowJointTrajectory" else kind
            yield PlannedController(name, chosen, type_, [one for one in names if one])


def get_sections(root: Node) -> dict[str, Node]:
    """Get the sections of the controllers in an existing ``moveit_controllers.yaml``."""
    manager = root.find(MANAGER)
    fields = (manager.fields if manager is not None else None) or {}
    return {name: node for name, node in fields.items() if node.fields is not None}


def add_missing(
    known: Iterable[PlannedController], planned: Iterable[PlannedController]
) -> list[PlannedController]:
    """List known controllers, and the planned ones whose name and joints these do not have."""
    found = list(known)
    for one in planned:
        used = {joint for other in found for joint in other.joints}
        if one.name not in {other.name for other in found} and not used & set(one.joints):
            found.append(one)
    return found
