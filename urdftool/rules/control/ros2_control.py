"""Rules on joints in ``<ros2_control>``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ...model.elements import ControlComponent, Mimic, Robot
from ...model.read import number
from ..fix import (
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
from ..words import find_nearest_joint, suggest_joint

APPLIES_TO = ("ros2_control",)


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception: joint not found in URDF",
    },
)
def ros2_control_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A joint in ``<ros2_control>`` does not exist in the robot.

    ros2_control reads the limits and ``<mimic>`` of each joint from the URDF, and throws an
    exception if the joint does not exist. No controller starts, neither in simulation nor on the
    robot.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            if joint.name and joint.name not in robot.joint and not is_unexpanded(joint.name):
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' of ros2_control '{control.name}' does not exist in "
                    "the robot" + suggest_joint(robot, joint.name),
                    at=joint.locate_attribute("name"),
                    data={
                        "joint": joint.name,
                        "suggestion": find_nearest_joint(robot, joint.name),
                    },
                )


@ros2_control_unknown_joint.fix(UNSAFE)
def write_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested joint, unless ``<ros2_control>`` already has it."""
    known = {joint.name for control in context.robot.ros2_controls for joint in control.joints}
    return None if problem.data["suggestion"] in known else write_suggestion(problem)


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": (
            "stops with an exception: fixed joints do not make sense in ros2_control"
        ),
    },
)
def ros2_control_fixed_joint(robot: Robot) -> Iterator[Problem]:
    """A joint in ``<ros2_control>`` is fixed.

    A fixed joint has no interfaces. The parser throws an exception, and the controller manager does
    not start.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            written = robot.joint.get(joint.name)
            if written is not None and written.is_fixed:
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' of ros2_control '{control.name}' is fixed; remove it",
                    at=joint.locate_attribute("name"),
                    data={"joint": joint.name},
                )


@ros2_control_fixed_joint.fix(UNSAFE)
def remove_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the joint; the fix is unsafe because ROS before Jazzy reports its state."""
    element = find_element(problem)
    return unsafe("remove the joint", remove_element(element)) if element is not None else None


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception",
    },
)
def ros2_control_mimic(robot: Robot) -> Iterator[Problem]:
    """A mimic joint contradicts its ``<ros2_control>``.

    The ``<mimic>`` of the URDF applies. Such a joint must not have a command interface unless it
    has ``mimic="false"``, its leader must be in the same block, and ``mimic="true"`` requires a
    ``<mimic>`` in the URDF. The parser throws an exception for any violation.
    """
    for control in robot.ros2_controls:
        names = {joint.name for joint in control.joints}
        for joint in control.joints:
            written = robot.joint.get(joint.name)
            if written is None or joint.mimic == "false":
                continue
            at = joint.element
            if written.mimic is None:
                if joint.mimic == "true":
                    yield Problem(
                        control.element,
                        f"joint '{joint.name}' has mimic=\"true\" but no <mimic> in the URDF",
                        at=at.locate_attribute("mimic"),
                    )
            elif joint.command_interfaces:
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' mimics '{written.mimic.joint}' but has a command "
                    'interface; remove it, or write mimic="false"',
                    at=joint.command_interfaces[0],
                    data={"joint": joint.name, "leader": written.mimic.joint},
                )
            elif written.mimic.joint and written.mimic.joint not in names:
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' mimics '{written.mimic.joint}', which is not in "
                    f"ros2_control '{control.name}'; add it",
                    at=at.locate_attribute("name"),
                    data={"joint": joint.name, "leader": written.mimic.joint},
                )


@ros2_control_mimic.fix(UNSAFE)
def remove_commands(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the command interfaces of a mimic joint."""
    interface = find_element(problem)
    joint = interface.parent if interface is not None else None
    if interface is None or interface.tag != "command_interface" or joint is None:
        return None
    return unsafe(
        "remove its command interfaces",
        *map(remove_element, joint.list_children("command_interface")),
    )


@rule(
    WARNING,
    on=("ros2",),
    effects={
        "ros2_control": "takes the mimic joint from the URDF, not from the parameter, since Jazzy",
    },
    group="robot",
)
def ros2_control_legacy_mimic_param(robot: Robot) -> Iterator[Problem]:
    """A ``<param>`` in ``<ros2_control>`` defines a mimic joint.

    Since Jazzy, ros2_control ignores ``<param name="mimic">`` and reads the ``<mimic>`` of the
    URDF. If the joint has a ``<mimic>`` with the same leader and multiplier, only older versions
    read the parameters, and the finding is an info.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for param in joint.element.list_children("param"):
                if param.get("name") == "mimic":
                    written = robot.joint.get(joint.name)
                    message, repeats = _compare_with_mimic(
                        joint, param.text.strip(), written.mimic if written is not None else None
                    )
                    yield Problem(
                        control.element,
                        message,
                        at=param,
                        severity=INFO if repeats else None,
                        alike=(written is None, joint.params.get("multiplier") is None),
                        data={"joint": joint.name},
                    )


def _compare_with_mimic(
    joint: ControlComponent, leader: str, mimic: Mimic | None
) -> tuple[str, bool]:
    """Compare the mimic parameters of a joint with its ``<mimic>``.

    Returns:
        The message, and whether the parameters repeat the ``<mimic>``.
    """
    factor = joint.params.get("multiplier")
    if mimic is None:
        by = f' multiplier="{factor}"' if factor is not None else ""
        return (
            f"joint '{joint.name}' mimics '{leader}' by a <param> only; "
            f"write <mimic joint='{leader}'{by}/> into the joint of the URDF",
            False,
        )
    if is_same_mimic(joint.params, mimic):
        return (
            f"joint '{joint.name}' mimics '{leader}' by a <param> and by its <mimic>; "
            f"remove {'the <param>' if factor is None else 'both <param>, mimic and multiplier'}",
            True,
        )
    return (
        f"joint '{joint.name}' mimics '{leader}' with multiplier {factor or 1} by its <param>, "
        f"but '{mimic.joint}' with multiplier {mimic.multiplier:g} by its <mimic>; "
        "remove the wrong <param>, or correct the <mimic>",
        False,
    )


def is_same_mimic(params: Mapping[str, str], mimic: Mimic) -> bool:
    """Tell whether parameters of a joint in ``<ros2_control>`` repeat its ``<mimic>``."""
    return params.get("mimic") == mimic.joint and (
        number(params.get("multiplier", "1")) == mimic.multiplier
    )


@ros2_control_legacy_mimic_param.fix(UNSAFE)
def leave_to_mimic(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the parameters, and write a ``<mimic>`` if the joint has none.

    The fix is unsafe because ROS before Jazzy reads the parameters.
    """
    param = find_element(problem)
    part = param.parent if param is not None else None
    joint = context.robot.joint.get(part.get("name") or "") if part is not None else None
    if param is None or part is None or joint is None:
        return None
    leader = param.text.strip()
    factors = [p for p in part.list_children("param") if p.get("name") == "multiplier"]
    changes = [remove_element(param), *map(remove_element, factors)]
    if joint.mimic is None:
        if leader not in context.robot.joint or joint.is_fixed:
            return None
        if is_computed(context.robot.joint[leader].element):
            return None
        by = f' multiplier="{escape_attribute(factors[0].text.strip())}"' if factors else ""
        changes.append(
            append_child(joint.element, f'<mimic joint="{escape_attribute(leader)}"{by}/>')
        )
        return unsafe("write <mimic> into the joint", *changes)
    params = {p.get("name") or "": p.text.strip() for p in part.list_children("param")}
    if not is_same_mimic(params, joint.mimic):
        return None
    return unsafe("remove it: the joint has a <mimic>", *changes)
