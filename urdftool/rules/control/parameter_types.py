"""Rules on the types of parameters of ros2_controllers."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ...source.yaml_tree import Node
from ..fix import FixContext, Proposal, Span, safe
from ..rule import ERROR, SAFE, Problem, rule
from ..words import join_some
from .controller_files import ControllerFile, get_package

APPLIES_TO = ("ros2_control",)

_LIMITS = tuple(f"{end}_{what}" for end in ("max", "min") for what in ("velocity", "acceleration"))
_COVARIANCE = ("pose_covariance_diagonal", "twist_covariance_diagonal")
_STEERED = ("reference_timeout", *_COVARIANCE)

_DOUBLES: dict[str, tuple[str, ...]] = {
    "JointTrajectoryController": (
        "action_monitor_rate",
        "state_publish_rate",
        "cmd_timeout",
        *(f"gains.*.{name}" for name in ("p", "i", "d", "i_clamp", "ff_velocity_scale")),
        "constraints.stopped_velocity_tolerance",
        "constraints.goal_time",
        "constraints.*.trajectory",
        "constraints.*.goal",
    ),
    "DiffDriveController": (
        "wheel_separation",
        "wheel_radius",
        "wheel_separation_multiplier",
        "left_wheel_radius_multiplier",
        "right_wheel_radius_multiplier",
        "cmd_vel_timeout",
        "publish_rate",
        *_COVARIANCE,
        *(f"linear.x.{name}" for name in _LIMITS),
        *(f"angular.z.{name}" for name in _LIMITS),
    ),
    "GripperActionController": (
        "action_monitor_rate",
        "goal_tolerance",
        "max_effort",
        "stall_velocity_threshold",
        "stall_timeout",
    ),
    "BicycleSteeringController": (
        "wheelbase",
        "front_wheel_radius",
        "rear_wheel_radius",
        "traction_wheel_radius",
        *_STEERED,
    ),
    "TricycleSteeringController": (
        "wheelbase",
        "wheel_track",
        "front_wheels_radius",
        "rear_wheels_radius",
        *_STEERED,
    ),
    "AckermannSteeringController": (
        "wheelbase",
        "front_wheel_track",
        "rear_wheel_track",
        "front_wheels_radius",
        "rear_wheels_radius",
        *_STEERED,
    ),
}
"""Parameters that ros2_controllers declares as double or double array, by class."""

_INTEGERS: dict[str, tuple[str, ...]] = {
    "DiffDriveController": ("wheels_per_side", "velocity_rolling_window_size"),
}


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": (
            "cannot load the controller: expected [double] got [integer]; for update_rate it "
            "ends itself"
        ),
    },
)
def controller_parameter_type(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller parameter is an integer instead of a double, or a double instead of an integer.

    ROS 2 does not convert parameter types. In YAML ``1`` is an integer and ``1.0`` is a double, so
    the controller manager cannot load a controller with ``wheel_radius: 1``. Checked are
    controllers of ros2_controllers in the controller files of the robot. One finding lists all
    parameters of a file.
    """
    if not robot.ros2_controls:
        return
    for file in get_package(robot, description).controller_files:
        wrong = list(find_wrong_types(file))
        if wrong:
            name, node, right = wrong[0]
            what = "doubles" if node.items is not None else "a double" if _is_int(node) else ""
            names = [f"{one}.{other.key}" for one, other, _ in wrong[1:]]
            more = f"; the same applies to {join_some(names, 'parameters', 3)}" if names else ""
            yield Problem(
                robot,
                f"{node.key} of '{name}' must be {what or 'an integer'} for ROS 2; "
                f"write {right}{more}",
                at=node.place,
                data={"parameters": [f"{one}.{other.key}" for one, other, _ in wrong]},
            )


@controller_parameter_type.fix(SAFE)
def write_declared_type(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the same numbers with the declared type, without rounding."""
    for file in get_package(context.robot, context.description).controller_files:
        if file.file.path != problem.place.path:
            continue
        spans = []
        for _, node, right in find_wrong_types(file):
            if node.items is None and float(node.text or 0) != float(right):
                continue
            pairs = [(node, right)]
            if node.items is not None:
                pairs = [(item, f"{item.text}.0") for item in node.items]
            spans += [Span(one.file, one.start, one.end, text.encode()) for one, text in pairs]
        return safe("write the declared type", *spans) if spans else None
    return None


def find_wrong_types(file: ControllerFile) -> Iterator[tuple[str, Node, str]]:
    """Yield parameters with a wrong type: the controller, the value, and the corrected text."""
    for path, parameters in file.root.walk():
        if path[-2:] == ("controller_manager", "ros__parameters"):
            for node in _find_values(parameters, "update_rate"):
                if node.kind == "float" and (right := _as_integer(node)):
                    yield "controller_manager", node, right
    for controller in file.controllers:
        for pattern in _DOUBLES.get(controller.kind, ()):
            for node in _find_values(controller.parameters, pattern):
                scalars = [node] if node.items is None else node.items
                if scalars and all(map(_is_int, scalars)):
                    texts = [f"{scalar.text}.0" for scalar in scalars]
                    right = texts[0] if node.items is None else f"[{', '.join(texts)}]"
                    yield controller.name, node, right
        for pattern in _INTEGERS.get(controller.kind, ()):
            for node in _find_values(controller.parameters, pattern):
                if node.kind == "float" and (right := _as_integer(node)):
                    yield controller.name, node, right


def _find_values(node: Node, pattern: str) -> Iterator[Node]:
    """Yield the values at a path of keys; a star matches each key."""
    before, star, after = pattern.partition(".*.")
    found = node.find(*before.split("."))
    if found is None or not star:
        yield from [found] if found is not None else []
        return
    for inner in (found.fields or {}).values():
        if inner.fields is not None:
            yield from _find_values(inner, after)


def _is_int(node: Node) -> bool:
    return node.kind == "int" and re.fullmatch(r"[+-]?\d+", node.text or "") is not None


def _as_integer(node: Node) -> str:
    try:
        value = float(node.text or "")
    except ValueError:
        return ""
    return str(int(value)) if value.is_integer() else str(round(value))
