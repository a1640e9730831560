"""Rules on YAML files of a MoveIt configuration, next to the SRDF."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path

from ...errors import ConfigError
from ...model.elements import Robot
from ...source.description import Description
from ...source.nearby import file_at
from ...source.packages import shown_path
from ...source.yaml_tree import Node, yaml_of
from ..fix import FixContext, Proposal, Span, safe, unsafe
from ..rule import ERROR, SAFE, UNSAFE, Problem, rule
from ..words import did_you_mean, some_of
from .semantic import semantics

_ON = ("moveit",)
_LIMITS = (
    ("has_velocity_limits", ("max_velocity",)),
    ("has_acceleration_limits", ("max_acceleration",)),
    ("has_jerk_limits", ("max_jerk",)),
    ("", ("max_position", "min_position")),
)
"""Parameters that MoveIt reads as doubles, each with the parameter that enables it."""
_MANAGER = "moveit_simple_controller_manager"
_TYPES = ("FollowJointTrajectory", "GripperCommand", "ParallelGripperCommand")


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
        wrong = not_doubles(robot, description, name)
        if wrong:
            of, node = wrong[0]
            names = [f"{one.key} of {other}" for other, one in wrong[1:]]
            more = f"; the same applies to {some_of(names, 'numbers', 3)}" if names else ""
            yield Problem(
                robot,
                f"{node.key} of {of} is {node.said}, which YAML reads as "
                f"{'an integer' if node.kind == 'int' else 'text'}; "
                f"write {as_double(node) or 'a number with a point'}{more}",
                at=node.place,
            )


@moveit_parameter_type.fix(SAFE)
def write_doubles(problem: Problem, context: FixContext) -> Proposal | None:
    """Write each of the numbers with a decimal point."""
    name = problem.place.path.replace("\\", "/").rpartition("/")[2]
    spans = [
        Span(node.file, node.start, node.end, text.encode())
        for _, node in not_doubles(context.robot, context.description, name)
        if (text := as_double(node))
    ]
    return safe("write doubles", *spans) if spans else None


_FILES = ("joint_limits.yaml", "kinematics.yaml", "pilz_cartesian_limits.yaml")


def not_doubles(robot: Robot, description: Description, name: str) -> list[tuple[str, Node]]:
    """List the numbers in a file that MoveIt requires as doubles, each with its owner."""
    root = _read_beside(robot, description, name)
    if root is None:
        return []
    read = {_FILES[0]: _limits_of, _FILES[1]: _solvers_of, _FILES[2]: _cartesian_of}[name]
    return [(of, node) for of, node in read(robot, root) if node.text and node.kind != "float"]


def _limits_of(robot: Robot, root: Node) -> Iterator[tuple[str, Node]]:
    limits = root.find("joint_limits")
    for name, entry in ((limits.fields if limits is not None else None) or {}).items():
        joint = robot.joint.get(name)
        if joint is None or joint.is_fixed or entry.fields is None:
            continue
        for switch, keys in _LIMITS:
            if not switch or _is_true(entry.fields.get(switch)):
                yield from _named(f"joint '{name}'", entry, keys)


def _solvers_of(robot: Robot, root: Node) -> Iterator[tuple[str, Node]]:
    for name, group in (root.fields or {}).items():
        yield from _named(
            f"group '{name}'",
            group,
            ("kinematics_solver_timeout", "kinematics_solver_search_resolution"),
        )


def _cartesian_of(robot: Robot, root: Node) -> Iterator[tuple[str, Node]]:
    limits = root.find("cartesian_limits")
    if limits is not None:
        keys = ("max_trans_vel", "max_trans_acc", "max_trans_dec", "max_rot_vel")
        yield from _named("cartesian_limits", limits, keys)


def _named(of: str, node: Node, keys: tuple[str, ...]) -> Iterator[tuple[str, Node]]:
    fields = node.fields or {}
    return ((of, fields[key]) for key in keys if key in fields)


def as_double(node: Node) -> str:
    """Format a number as a YAML double; empty if it is not a finite number."""
    text = node.text or ""
    if node.kind == "int":
        return f"{text}.0" if re.fullmatch(r"[+-]?\d+", text) else ""
    try:
        value = float(text)
    except ValueError:
        return ""
    if not math.isfinite(value):
        return ""
    mantissa, exponent, power = repr(value).partition("e")
    return mantissa + (".0" if "." not in mantissa else "") + exponent + power


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
    for manager in _managers(robot, description):
        fields = manager.fields or {}
        names = fields.get("controller_names")
        for node in (names.items if names is not None else None) or []:
            controller = fields.get(node.text or "")
            if controller is None:
                known = [key for key, value in fields.items() if value.fields is not None]
                yield Problem(
                    robot,
                    f"MoveIt controller '{node.text}' has no section with its type and joints"
                    + did_you_mean(node.text or "", known),
                    at=node.place,
                )
                continue
            wrong = _what_is_wrong(controller)
            if wrong:
                yield Problem(robot, f"MoveIt controller '{node.text}' {wrong}", at=node.place)


def action_of(controller: Node) -> str:
    """Get the action of a ros2_control controller, by its MoveIt type."""
    kind = (controller.fields or {}).get("type")
    name = None if kind is None else kind.text
    return "follow_joint_trajectory" if name == "FollowJointTrajectory" else "gripper_cmd"


def without_action(robot: Robot, description: Description) -> Iterator[tuple[Node, Node]]:
    """Yield controllers that lack only ``action_ns``: the name in the list, and the section."""
    for manager in _managers(robot, description):
        fields = manager.fields or {}
        names = fields.get("controller_names")
        for node in (names.items if names is not None else None) or []:
            controller = fields.get(node.text or "")
            if controller is not None and _missing(controller) == ["action_ns"]:
                yield node, controller


@moveit_controller_incomplete.fix(UNSAFE)
def add_action(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the action of the controller's type, as the first line of its section."""
    for name, section in without_action(context.robot, context.description):
        if name.place.start != problem.place.start or name.file.path != problem.place.path:
            continue
        data, at = section.file.data, section.start
        text = f"action_ns: {action_of(section)}".encode()
        if data[at : at + 1] == b"{":
            at, text = at + 1, text + b", "
        else:
            text += b"\n" + data[data.rfind(b"\n", 0, at) + 1 : at]  # with the same indentation
        return unsafe("write the action of its type", Span(section.file, at, at, text))
    return None


def _missing(controller: Node) -> list[str]:
    fields = controller.fields or {}
    missing = [key for key in ("action_ns", "type") if key not in fields]
    joints = fields.get("joints")
    return missing if joints is not None and joints.items else [*missing, "joints"]


def _what_is_wrong(controller: Node) -> str:
    kind = (controller.fields or {}).get("type")
    name = "" if kind is None else kind.text or ""
    if kind is not None and name not in _TYPES:
        remedy = did_you_mean(name, _TYPES) or "; write FollowJointTrajectory or GripperCommand"
        return f"has type '{name}', which is not in MoveIt{remedy}"
    missing = _missing(controller)
    remedy = f"; write action_ns: {action_of(controller)}" if missing == ["action_ns"] else ""
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
    for manager in _managers(robot, description):
        for name, controller in (manager.fields or {}).items():
            joints = (controller.fields or {}).get("joints")
            for node in (joints.items if joints is not None else None) or []:
                if node.text and node.text not in robot.joint:
                    yield Problem(
                        robot,
                        f"MoveIt controller '{name}' refers to joint '{node.text}', which the "
                        "robot "
                        f"does not have{did_you_mean(node.text, robot.joint)}",
                        at=node.place,
                    )


def _managers(robot: Robot, description: Description) -> Iterator[Node]:
    """Yield the sections of MoveIt's simple controller manager, in the format of ROS 2."""
    for name in ("moveit_controllers.yaml", "moveit_simple_controllers.yaml", "controllers.yaml"):
        root = _read_beside(robot, description, name)
        manager = None if root is None else root.find(_MANAGER)
        if manager is not None:
            yield manager


def _read_beside(robot: Robot, description: Description, name: str) -> Node | None:
    """Read a YAML file next to the description and its SRDF; None if there is none."""
    if not semantics(robot, description):
        return None
    path = Path(description.path).parent / name
    workspace = description.workspace
    file = file_at(workspace, shown_path(path)) if workspace.is_file(path) else None
    try:
        return None if file is None else yaml_of(file)
    except ConfigError:
        return None
