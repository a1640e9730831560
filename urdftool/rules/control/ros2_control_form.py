"""Rules on the elements of ``<ros2_control>``."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.read import number
from ...source.document import Element
from ..fix import (
    FixContext,
    Proposal,
    find_element,
    get_suggestion,
    get_written_lines,
    insert_after,
    remove_element,
    rename_element,
    replace_element,
    safe,
    unsafe,
)
from ..rule import BOTH, ERROR, UNSAFE, Problem, rule
from ..words import find_nearest, suggest_name

APPLIES_TO = ("ros2_control",)

_TYPES = ("system", "sensor", "actuator")
_CHILDREN = ("hardware", "properties", "joint", "sensor", "gpio", "transmission")


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception",
    },
)
def ros2_control_missing_attribute(robot: Robot) -> Iterator[Problem]:
    """A ``<ros2_control>`` has no name or type, or an unknown type.

    The types are ``system``, ``sensor`` and ``actuator``. The controller manager stops with an
    exception.
    """
    for control in robot.ros2_controls:
        for name in ("name", "type"):
            if not control.element.get(name):
                yield Problem(control.element, f"<ros2_control> has no {name}")
        if control.type and control.type not in _TYPES:
            yield Problem(
                control.element,
                f"ros2_control '{control.name}' has the unknown type '{control.type}'; "
                f"the types are {', '.join(_TYPES)}" + suggest_name(control.type, _TYPES),
                at=control.locate_attribute("type"),
                data={"type": control.type, "suggestion": find_nearest(control.type, _TYPES)},
            )


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception",
    },
)
def ros2_control_missing_plugin(robot: Robot) -> Iterator[Problem]:
    """The hardware or a transmission of a ``<ros2_control>`` has no ``<plugin>``.

    ``<plugin>`` is the class of the hardware interface or the transmission. Without it the
    controller manager stops with an exception.
    """
    for control in robot.ros2_controls:
        hardware = control.element.find_child("hardware")
        if hardware is None:
            yield Problem(
                control.element,
                f"ros2_control '{control.name}' has no <hardware> with a <plugin>",
            )
        for child in control.element.children:
            plugin = child.find_child("plugin")
            if child.tag in ("hardware", "transmission") and (
                plugin is None or not plugin.text.strip()
            ):
                yield Problem(
                    control.element,
                    f"<{child.tag}> of ros2_control '{control.name}' has no <plugin>",
                    at=child,
                )


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception: invalid tag name",
    },
)
def ros2_control_invalid_tag(robot: Robot) -> Iterator[Problem]:
    """A ``<ros2_control>`` contains an unknown element.

    The known elements are hardware, properties, joint, sensor, gpio and transmission. The
    controller manager stops with an exception for any other.
    """
    for control in robot.ros2_controls:
        for child in control.element.children:
            if child.tag not in _CHILDREN and ":" not in child.tag:
                yield Problem(
                    control.element,
                    f"ros2_control '{control.name}' has an unknown <{child.tag}>; it may have "
                    f"{', '.join(_CHILDREN)}{suggest_name(child.tag, _CHILDREN)}",
                    at=child,
                    data={"suggestion": find_nearest(child.tag, _CHILDREN)},
                )


@ros2_control_invalid_tag.fix(UNSAFE)
def write_element(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested element."""
    element = find_element(problem)
    name = get_suggestion(problem, element.tag) if element is not None else ""
    if element is None or not name:
        return None
    return unsafe(f"write <{name}>", rename_element(element, name))


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception: no ros2_control tag",
    },
)
def ros2_control_nested(robot: Robot) -> Iterator[Problem]:
    """A ``<ros2_control>`` is not a child of ``<robot>``.

    The controller manager only reads children of ``<robot>``, and finds no ros2_control elements
    inside others such as ``<gazebo>``.
    """
    for child in robot.element.children:
        if child.tag == "ros2_control":
            continue
        for element in child.walk():
            if element.tag == "ros2_control":
                yield Problem(
                    element,
                    f"<ros2_control> is inside <{child.tag}>, where it is not read; move it "
                    "into <robot>",
                )


@ros2_control_nested.fix(BOTH, reveals=True)
def move_up(problem: Problem, context: FixContext) -> Proposal | None:
    """Move it into the robot; unsafe if the robot has another ``<ros2_control>``."""
    element = problem.element
    make = unsafe if context.robot.element.find_child("ros2_control") is not None else safe
    top: Element = element
    while top.parent is not None and top.parent is not context.robot.element:
        top = top.parent
    if top is element or top.parent is None:
        return None
    alone = element.parent is top and len(top.children) == 1 and top.tag == "gazebo"
    if alone and not top.attributes:
        return make("move it into <robot>", replace_element(top, tuple(get_written_lines(element))))
    return make(
        "move it into <robot>",
        remove_element(element),
        insert_after(top, *get_written_lines(element)),
    )


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception",
    },
)
def ros2_control_bad_param(robot: Robot) -> Iterator[Problem]:
    """A ``<param>`` has no name, or the ``size`` of an interface is not a positive integer.

    The controller manager stops with an exception.
    """
    for control in robot.ros2_controls:
        for element in control.element.walk():
            if element.tag == "param" and not element.get("name"):
                yield Problem(
                    control.element,
                    f"a <param> of ros2_control '{control.name}' has no name",
                    at=element,
                )
            size = element.get("size")
            if element.tag.endswith("_interface") and size is not None:
                value = number(size)
                if value is None or value < 1 or value != int(value):
                    yield Problem(
                        control.element,
                        f"size of interface '{element.get('name') or ''}' is '{size}'; "
                        "write a positive integer",
                        at=element.locate_attribute("size"),
                    )
