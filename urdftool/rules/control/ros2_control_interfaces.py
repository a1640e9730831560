"""Rules on the interfaces of joints in ``<ros2_control>``."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot
from ...model.read import number
from ...source.description import Description
from ...source.document import Element
from ...source.xacro_names import CONDITIONS
from ..fix import (
    Change,
    FixContext,
    Proposal,
    append_child,
    escape_attribute,
    find_element,
    is_computed,
    remove_element,
    unsafe,
    write_suggestion,
)
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import find_nearest, quote, suggest_name
from ..xacro.definitions import get_definitions

APPLIES_TO = ("ros2_control",)


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "refuses to register the interface twice",
    },
)
def ros2_control_duplicate_interface(robot: Robot) -> Iterator[Problem]:
    """A joint has the same interface twice.

    The name of an interface, such as ``joint/position``, must be unique. The controller manager
    refuses the same interface twice in a joint, or the same command interface in two
    ``<ros2_control>`` blocks.
    """
    commands: dict[tuple[str, str], str] = {}
    for control in robot.ros2_controls:
        for part in control.components:
            for kind, interfaces in (
                ("command", part.command_interfaces),
                ("state", part.state_interfaces),
            ):
                seen: set[str] = set()
                for interface in interfaces:
                    name = interface.name
                    other = control.name
                    if kind == "command":
                        other = commands.setdefault((part.name, name), control.name)
                    if name in seen or other != control.name:
                        elsewhere = other != control.name
                        where = f", already in '{other}'" if elsewhere else " twice"
                        data = {"interface": name}
                        yield Problem(
                            control.element,
                            f"{part.kind} '{part.name}' has the {kind} interface '{name}'{where}",
                            at=interface,
                            data=data | {"block": other} if elsewhere else data,
                        )
                    seen.add(name)


@ros2_control_duplicate_interface.fix(UNSAFE)
def remove_second(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the second interface of a joint; if two blocks conflict, none is chosen."""
    element = find_element(problem)
    if element is None or "block" in problem.data:
        return None
    return unsafe("remove the second", remove_element(element))


_STANDARD = ("position", "velocity", "acceleration", "effort")


@rule(
    INFO,
    on=("ros2",),
    effects={
        "gz_ros2_control": "ignores an interface other than position, velocity and effort",
    },
)
def nonstandard_interface_name(robot: Robot) -> Iterator[Problem]:
    """The name of an interface is similar to a standard name.

    Controllers look for ``position``, ``velocity``, ``acceleration`` and ``effort``. Hardware may
    have other interfaces, but a controller does not find ``postion``.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for interface in (*joint.command_interfaces, *joint.state_interfaces):
                near = find_nearest(interface.name, _STANDARD, 0.8)
                if interface.name not in _STANDARD and near:
                    yield Problem(
                        control.element,
                        f"joint '{joint.name}' has the nonstandard interface '{interface.name}'"
                        + suggest_name(interface.name, _STANDARD, 0.8),
                        at=interface.locate_attribute("name"),
                        data={"suggestion": near},
                    )


nonstandard_interface_name.fix(UNSAFE)(write_suggestion)


@rule(
    INFO,
    on=("ros2",),
    effects={
        "joint_trajectory_controller": (
            "does not activate if a required state interface is missing"
        ),
    },
)
def command_without_state(robot: Robot) -> Iterator[Problem]:
    """A joint has a command interface but no state interface of the same name.

    Most controllers read the state that they command: the trajectory controller requires position
    and velocity states of a joint whose velocity it commands. ``diff_drive_controller`` commands
    wheel velocities and reads positions, or velocities with ``position_feedback: false``; so one of
    the two states is enough for a continuous joint. The state may be in a different
    ``<ros2_control>`` block, such as that of a sensor.
    """
    given: dict[str, set[str]] = {}
    for control in robot.ros2_controls:
        for joint in control.joints:
            states = given.setdefault(joint.name, set())
            states.update(interface.name for interface in joint.state_interfaces)
    for control in robot.ros2_controls:
        for joint in control.joints:
            states = set(given[joint.name])
            written = robot.joint.get(joint.name)
            if written is not None and written.type == "continuous" and "position" in states:
                states.add("velocity")
            missing = [
                interface
                for interface in joint.command_interfaces
                if interface.name in ("position", "velocity") and interface.name not in states
            ]
            if missing:
                words = quote(interface.name for interface in missing)
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' has the command interface {words} but no such state "
                    "interface",
                    at=missing[0],
                    data={"missing": [interface.name for interface in missing]},
                )


@command_without_state.fix(UNSAFE)
def add_state(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the missing state interfaces."""
    interface = find_element(problem)
    joint = interface.parent if interface is not None else None
    if joint is None:
        return None
    states = {
        state.name
        for control in context.robot.ros2_controls
        for other in control.joints
        if other.name == (joint.get("name") or "")
        for state in other.state_interfaces
    }
    names = [command.get("name") or "" for command in joint.list_children("command_interface")]
    missing = [name for name in names if name in ("position", "velocity") and name not in states]
    lines = tuple((f'<state_interface name="{name}"/>',) for name in dict.fromkeys(missing))
    return unsafe("add the state interface", Change("insert", joint, blocks=lines))


@rule(
    WARNING,
    on=("ros2",),
    effects={
        "ros2_control": "has no interface for the joint, so no broadcaster reports its motion",
    },
    group="robot",
)
def joint_outside_ros2_control(robot: Robot, description: Description) -> Iterator[Problem]:
    """A moving joint is not in any ``<ros2_control>`` block, but other joints are.

    No broadcaster publishes its state, so RViz has no transform to the links below it. A joint that
    is only measured needs a state interface and no command interface. A joint that a condition of
    xacro leaves out, for example for one hardware plugin, is not reported.
    """
    known = {joint.name for control in robot.ros2_controls for joint in control.joints}
    if not known or not known.intersection(robot.joint) or _has_other_publisher(robot):
        return
    optional = _list_optional_names(description)
    for joint in robot.moving_joints:
        if any(pattern.fullmatch(joint.name) for pattern in optional):
            continue
        if (
            joint.mimic is None
            and joint.type not in ("planar", "floating")
            and joint.has_axis
            and joint.name not in known
        ):
            yield Problem(
                joint,
                f"moving joint '{joint.name}' is not in <ros2_control>, so its state is not "
                "published; add it with a state interface",
                group="{count} moving joints are not in <ros2_control>, so their state is not "
                "published; add them with a state interface: {names}",
            )


@joint_outside_ros2_control.fix(UNSAFE)
def add_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the joint with its states and without commands, if there is exactly one block."""
    joint = context.get_joint(problem)
    if len(context.robot.ros2_controls) != 1 or is_computed(joint.element):
        return None
    block = context.robot.ros2_controls[0].element
    lines = (
        f'<joint name="{escape_attribute(joint.name)}">',
        '\t<state_interface name="position"/>',
        '\t<state_interface name="velocity"/>',
        "</joint>",
    )
    return unsafe("report its position and velocity", append_child(block, *lines))


def _list_optional_names(description: Description) -> list[re.Pattern[str]]:
    """List patterns of names in the conditions of ``<ros2_control>`` blocks, as written."""
    if description.expansion is None:
        return []
    names = {
        name
        for document in get_definitions(description).documents
        for block in document.root.walk()
        if block.tag == "ros2_control"
        for condition in block.walk()
        if condition.tag in CONDITIONS
        for part in condition.walk()
        if part.tag == "joint" or part.tag.startswith("xacro:")
        for key, name in part.attributes.items()
        if key != "value"
    }
    return [re.compile(_EXPRESSION.sub(r".*", re.escape(name))) for name in names if name]


_EXPRESSION = re.compile(r"\\\$\\\{.*?\\\}|\\\$\\\(.*?\\\)")
"""An expression of xacro in a pattern of ``re.escape``."""


def _has_other_publisher(robot: Robot) -> bool:
    """Tell whether a Gazebo plugin publishes joint states as well."""
    words = ("drive", "joint-state", "joint_state")
    return any(word in plugin.filename for plugin in robot.plugins for word in words)


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "gz_ros2_control": "stops with an exception where the value is not a number",
    },
)
def bad_initial_value(robot: Robot) -> Iterator[Problem]:
    """The ``initial_value`` of an interface is not a number, or is outside the joint limits.

    The simulated hardware starts the joint at this value. It stops with an exception if the text is
    not a number, and moves a position outside the limits abruptly to the limit.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for interface in joint.state_interfaces:
                text = interface.params.get("initial_value")
                if text is None or is_unexpanded(text):
                    continue
                value = number(text)
                if value is None:
                    wrong = "is not a number"
                elif interface.name == "position" and (
                    limits := _format_exceeded_limits(robot, joint.name, value)
                ):
                    wrong = f"is outside the joint limits {limits}"
                else:
                    continue
                yield Problem(
                    control.element,
                    f"initial_value of joint '{joint.name}' is '{text}', which {wrong}",
                    at=_find_param(interface.element, "initial_value"),
                    severity=None if value is None else WARNING,
                    data={"joint": joint.name, "value": text},
                )


def _format_exceeded_limits(robot: Robot, name: str, value: float) -> str:
    joint = robot.joint.get(name)
    if joint is None or not joint.is_limited or joint.limit is None:
        return ""
    low, high = joint.limit.lower or 0.0, joint.limit.upper or 0.0
    return "" if low > high or low <= value <= high else f"{low:g} to {high:g}"


def _find_param(element: Element, name: str) -> Element:
    return next((p for p in element.list_children("param") if p.get("name") == name), element)
