"""Rules on YAML files of a MoveIt configuration, next to the SRDF."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ...model.elements import Robot
from ...model.moveit_parameters import ACTIONS, MANAGER
from ...source.description import Description
from ...source.nearby_files import read_optional_file
from ...source.packages import shorten_path
from ...source.yaml_tree import Node
from ..fix import FixContext, Proposal, Span, safe, unsafe
from ..rule import ERROR, SAFE, UNSAFE, WARNING, Problem, rule
from ..unread_files import read_parameters
from ..words import join_some, suggest_joint, suggest_name
from .semantic import has_srdf

_ON = ("moveit",)
_LIMITS = (
    ("has_velocity_limits", ("max_velocity",)),
    ("has_acceleration_limits", ("max_acceleration",)),
    ("has_jerk_limits", ("max_jerk",)),
    ("", ("max_position", "min_position")),
)
"""Parameters that MoveIt reads as doubles, each with the parameter that enables it."""


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": "move_group of ROS 2 stops with an exception: expected [double] got [integer]",
    },
)
def moveit_parameter_type(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """A number in a MoveIt configuration is an integer, but MoveIt 2 requires a double.

    ROS 2 does not convert parameter types. In YAML ``2`` is an integer, and MoveIt nodes stop if
    they read it as a double. The setup assistant writes such numbers too. ``5e-3`` is text in YAML,
    because it has no decimal point; write ``5.0e-3``. ROS 1 converts integers. Checked are
    ``joint_limits.yaml``, ``kinematics.yaml`` and ``pilz_cartesian_limits.yaml`` next to the
    description and its SRDF. One finding lists all numbers of a file.
    """
    if "ros1" in targets and "ros2" not in targets:
        return
    for name in _FILES:
        wrong = find_non_doubles(robot, description, name)
        if wrong:
            of, node = wrong[0]
            names = [f"{one.key} of {other}" for other, one in wrong[1:]]
            more = f"; the same applies to {join_some(names, 'numbers', 3)}" if names else ""
            yield Problem(
                robot,
                f"{node.key} of {of} is {node.described}, which YAML reads as "
                f"{'an integer' if node.kind == 'int' else 'text'}; "
                f"write {_write_double(node) or 'a number with a point'}{more}",
                at=node.place,
            )


@moveit_parameter_type.fix(SAFE)
def write_doubles(problem: Problem, context: FixContext) -> Proposal | None:
    """Write each of the numbers with a decimal point."""
    name = problem.place.path.replace("\\", "/").rpartition("/")[2]
    spans = [
        Span(node.file, node.start, node.end, text.encode())
        for _, node in find_non_doubles(context.robot, context.description, name)
        if (text := _write_double(node))
    ]
    return safe("write doubles", *spans) if spans else None


_FILES = ("joint_limits.yaml", "kinematics.yaml", "pilz_cartesian_limits.yaml")


def find_non_doubles(robot: Robot, description: Description, name: str) -> list[tuple[str, Node]]:
    """List the numbers in a file that MoveIt requires as doubles, each with its owner."""
    root = read_next_to_srdf(robot, description, name)
    if root is None:
        return []
    read = {
        _FILES[0]: _find_limits,
        _FILES[1]: _find_solver_parameters,
        _FILES[2]: _find_cartesian_limits,
    }[name]
    return [(of, node) for of, node in read(robot, root) if node.text and node.kind != "float"]


def _find_limits(robot: Robot, root: Node) -> Iterator[tuple[str, Node]]:
    limits = root.find("joint_limits")
    for name, entry in ((limits.fields if limits is not None else None) or {}).items():
        joint = robot.joint.get(name)
        if joint is None or joint.is_fixed or entry.fields is None:
            continue
        for switch, keys in _LIMITS:
            if not switch or _is_true(entry.fields.get(switch)):
                yield from _select_fields(f"joint '{name}'", entry, keys)


def _find_solver_parameters(robot: Robot, root: Node) -> Iterator[tuple[str, Node]]:
    for name, group in (root.fields or {}).items():
        yield from _select_fields(
            f"group '{name}'",
            group,
            ("kinematics_solver_timeout", "kinematics_solver_search_resolution"),
        )


def _find_cartesian_limits(robot: Robot, root: Node) -> Iterator[tuple[str, Node]]:
    limits = root.find("cartesian_limits")
    if limits is not None:
        keys = ("max_trans_vel", "max_trans_acc", "max_trans_dec", "max_rot_vel")
        yield from _select_fields("cartesian_limits", limits, keys)


def _select_fields(of: str, node: Node, keys: tuple[str, ...]) -> Iterator[tuple[str, Node]]:
    fields = node.fields or {}
    return ((of, fields[key]) for key in keys if key in fields)


def _write_double(node: Node) -> str:
    """Write a number as a YAML double; empty if it is not a finite number."""
    from ...srdf.moveit.yaml_text import format_double

    text = node.text or ""
    if node.kind == "int":
        return f"{text}.0" if re.fullmatch(r"[+-]?\d+", text) else ""
    try:
        return format_double(float(text))
    except ValueError:
        return ""


def _is_true(node: Node | None) -> bool:
    return node is not None and (node.text or "").lower() in ("true", "yes", "on")


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": (
            "logs an error and continues without the controller; it plans trajectories but "
            "cannot execute them"
        ),
    },
)
def moveit_controller_incomplete(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller in the MoveIt configuration has no action, type or joints.

    Each name in ``controller_names`` requires a section with ``action_ns``, ``type`` and
    ``joints``; MoveIt ignores a controller without them. Planning works, but execution fails with
    "Unable to identify any set of controllers that can actuate the specified joints". The setup
    assistant omits ``action_ns``.
    """
    for manager in find_managers(robot, description):
        fields = manager.fields or {}
        names = fields.get("controller_names")
        for node in (names.items if names is not None else None) or []:
            controller = fields.get(node.text or "")
            if controller is None:
                known = [key for key, value in fields.items() if value.fields is not None]
                yield Problem(
                    robot,
                    f"MoveIt controller '{node.text}' has no section with its type and joints"
                    + suggest_name(node.text or "", known),
                    at=node.place,
                )
                continue
            wrong = _describe_defect(controller)
            if wrong:
                yield Problem(robot, f"MoveIt controller '{node.text}' {wrong}", at=node.place)


def get_action(controller: Node) -> str:
    """Get the action of a ros2_control controller, by its MoveIt type."""
    kind = (controller.fields or {}).get("type")
    return ACTIONS.get((kind.text or "") if kind is not None else "", "gripper_cmd")


def find_controllers_without_action(
    robot: Robot, description: Description
) -> Iterator[tuple[Node, Node]]:
    """Yield controllers that lack only ``action_ns``: the name in the list, and the section."""
    for manager in find_managers(robot, description):
        fields = manager.fields or {}
        names = fields.get("controller_names")
        for node in (names.items if names is not None else None) or []:
            controller = fields.get(node.text or "")
            if controller is not None and _get_missing_keys(controller) == ["action_ns"]:
                yield node, controller


@moveit_controller_incomplete.fix(UNSAFE)
def add_action(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the action of the controller's type, as the first line of its section."""
    for name, section in find_controllers_without_action(context.robot, context.description):
        if name.place.start != problem.place.start or name.file.path != problem.place.path:
            continue
        data, at = section.file.data, section.start
        text = f"action_ns: {get_action(section)}".encode()
        if data[at : at + 1] == b"{":
            at, text = at + 1, text + b", "
        else:
            text += b"\n" + data[data.rfind(b"\n", 0, at) + 1 : at]  # with the same indentation
        return unsafe("write the action of its type", Span(section.file, at, at, text))
    return None


def _get_missing_keys(controller: Node) -> list[str]:
    fields = controller.fields or {}
    missing = [key for key in ("action_ns", "type") if key not in fields]
    joints = fields.get("joints")
    return missing if joints is not None and joints.items else [*missing, "joints"]


def _describe_defect(controller: Node) -> str:
    kind = (controller.fields or {}).get("type")
    name = "" if kind is None else kind.text or ""
    if kind is not None and name not in ACTIONS:
        remedy = suggest_name(name, ACTIONS) or "; write FollowJointTrajectory or GripperCommand"
        return f"has type '{name}', which is not in MoveIt{remedy}"
    missing = _get_missing_keys(controller)
    remedy = f"; write action_ns: {get_action(controller)}" if missing == ["action_ns"] else ""
    return f"has no {' and no '.join(missing)}{remedy}" if missing else ""


@rule(
    ERROR,
    on=_ON,
    effects={"moveit": "finds no controller for the intended joint, and executes nothing"},
)
def moveit_controller_unknown_joint(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller in the MoveIt configuration refers to a joint that does not exist.

    MoveIt selects controllers that together have all joints of a trajectory. The intended joint is
    in none of them, so MoveIt executes nothing.
    """
    for manager in find_managers(robot, description):
        for name, controller in (manager.fields or {}).items():
            joints = (controller.fields or {}).get("joints")
            for node in (joints.items if joints is not None else None) or []:
                if node.text and node.text not in robot.joint:
                    yield Problem(
                        robot,
                        f"MoveIt controller '{name}' refers to joint '{node.text}', which the "
                        "robot "
                        f"does not have{suggest_joint(robot, node.text)}",
                        at=node.place,
                    )


@rule(
    WARNING,
    on=_ON,
    effects={
        "moveit": "cannot time a trajectory: no acceleration limit was defined",
    },
)
def missing_acceleration_limits(robot: Robot, description: Description) -> Iterator[Problem]:
    """A joint has no acceleration limit.

    URDF has no acceleration limits; MoveIt reads them from ``joint_limits.yaml`` next to the SRDF.
    Without them MoveIt cannot time trajectories. Nothing is reported if the file does not exist.
    """
    root = read_next_to_srdf(robot, description, "joint_limits.yaml")
    limits = None if root is None else root.find("joint_limits")
    if root is None or limits is None or limits.fields is None:
        return
    for joint in robot.moving_joints:
        entry = limits.fields.get(joint.name)
        if joint.mimic is not None or not joint.has_axis:
            continue
        if entry is None or not _is_true((entry.fields or {}).get("has_acceleration_limits")):
            yield Problem(
                joint,
                f"joint '{joint.name}' has no acceleration limit in {root.file.path}; "
                "MoveIt cannot time its motion",
            )


def find_managers(robot: Robot, description: Description) -> Iterator[Node]:
    """Yield the sections of MoveIt's simple controller manager, in the format of ROS 2."""
    for name in _OF_MANAGERS:
        root = read_next_to_srdf(robot, description, name)
        manager = None if root is None else root.find(MANAGER)
        if manager is not None:
            yield manager


def read_next_to_srdf(robot: Robot, description: Description, name: str) -> Node | None:
    """Read a YAML file next to the description and its SRDF; None if there is none."""
    if not has_srdf(robot, description):
        return None
    path = Path(description.path).parent / name
    workspace = description.workspace
    file = read_optional_file(workspace, shorten_path(path)) if workspace.is_file(path) else None
    case = "controllers" if name == _OF_ROS2_CONTROL else "parameters of MoveIt"
    return None if file is None else read_parameters(robot, file, case)


_OF_MANAGERS = ("moveit_controllers.yaml", "moveit_simple_controllers.yaml", "controllers.yaml")
_OF_ROS2_CONTROL = "ros2_controllers.yaml"
_BESIDE_SRDF = (*_FILES, _OF_ROS2_CONTROL, *_OF_MANAGERS)


def read_configuration(robot: Robot, description: Description) -> None:
    """Read all files of a MoveIt configuration that rules check, to learn which are unreadable."""
    for name in _BESIDE_SRDF:
        read_next_to_srdf(robot, description, name)
