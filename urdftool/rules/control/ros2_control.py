"""What ``<ros2_control>`` says of the joints of the robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ...model.elements import ControlComponent, Mimic, Robot
from ...model.read import number
from ...source.document import Element
from ..rule import ERROR, INFO, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean, quoted

APPLIES_TO = ("ros2_control",)


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception: joint not found in URDF",
    },
)
def ros2_control_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A joint in ``<ros2_control>`` is not in the robot.

    The parser looks up every joint to know its limits and whether it mimics another, and throws at
    the first that it does not find. No controller starts, in simulation or on the robot.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            if joint.name and joint.name not in robot.joint and not is_unexpanded(joint.name):
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' of ros2_control '{control.name}' is not in the robot"
                    + did_you_mean(joint.name, robot.joint),
                    at=joint.element.attribute_place("name"),
                )


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

    The parser throws: fixed joints make no sense to it.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            written = robot.joint.get(joint.name)
            if written is not None and written.is_fixed:
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' of ros2_control '{control.name}' is fixed; take it out",
                    at=joint.element.attribute_place("name"),
                )


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "stops with an exception",
    },
)
def ros2_control_mimic(robot: Robot) -> Iterator[Problem]:
    """A joint that mimics another does not fit its ``<ros2_control>``.

    What ``<mimic>`` in the URDF says holds: such a joint takes no command of its own unless it has
    ``mimic="false"``, the joint it follows is in the same block, and ``mimic="true"`` needs a
    ``<mimic>`` in the URDF. The parser throws otherwise.
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
                        f"joint '{joint.name}' has mimic=\"true\" and no <mimic> in the URDF",
                        at=at.attribute_place("mimic"),
                    )
            elif joint.command_interfaces:
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' follows '{written.mimic.joint}' and has a command "
                    'interface; take it out, or write mimic="false"',
                    at=joint.command_interfaces[0],
                )
            elif written.mimic.joint and written.mimic.joint not in names:
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' follows '{written.mimic.joint}', which is not in "
                    f"ros2_control '{control.name}'; add it",
                    at=at.attribute_place("name"),
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
    """A ``<param>`` in ``<ros2_control>`` makes a joint a mimic joint.

    ``<param name="mimic">`` was how a joint in ``<ros2_control>`` followed another; since Jazzy
    ros2_control takes that from the ``<mimic>`` of the URDF. Where the joint has a ``<mimic>`` of
    the same joint and multiplier, the parameters do no harm, and only older versions read them: it
    is an info.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for param in joint.element.all("param"):
                if param.get("name") == "mimic":
                    written = robot.joint.get(joint.name)
                    message, repeats = _of_mimic_param(
                        joint, param.text.strip(), written.mimic if written is not None else None
                    )
                    yield Problem(
                        control.element, message, at=param, severity=INFO if repeats else None
                    )


def _of_mimic_param(joint: ControlComponent, leader: str, mimic: Mimic | None) -> tuple[str, bool]:
    """Compare the parameters that make a joint a mimic joint with its ``<mimic>``.

    Args:
        joint: The joint in ``<ros2_control>``.
        leader: The joint that its parameter names.
        mimic: The ``<mimic>`` of the joint in the URDF.

    Returns:
        The message, and whether the parameters repeat the ``<mimic>``.
    """
    factor = joint.params.get("multiplier")
    if mimic is None:
        by = f' multiplier="{factor}"' if factor is not None else ""
        return (
            f"joint '{joint.name}' follows '{leader}' by a <param>; "
            f"write <mimic joint='{leader}'{by}/> into the joint of the URDF",
            False,
        )
    if repeats_mimic(joint.params, mimic):
        return (
            f"joint '{joint.name}' follows '{leader}' by a <param> and by its <mimic>; "
            f"remove {'the <param>' if factor is None else 'both <param>, mimic and multiplier'}",
            True,
        )
    return (
        f"joint '{joint.name}' follows '{leader}' with multiplier {factor or 1} by its <param>, "
        f"but '{mimic.joint}' with multiplier {mimic.multiplier:g} by its <mimic>; "
        "remove the <param> that are wrong, or correct the <mimic>",
        False,
    )


def repeats_mimic(params: Mapping[str, str], mimic: Mimic) -> bool:
    """Whether the parameters of a joint in ``<ros2_control>`` repeat its ``<mimic>``."""
    return params.get("mimic") == mimic.joint and (
        number(params.get("multiplier", "1")) == mimic.multiplier
    )


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "refuses to register the interface twice",
    },
)
def ros2_control_duplicate_interface(robot: Robot) -> Iterator[Problem]:
    """An interface of a joint is there twice.

    Each interface is a resource with a name, ``joint/position``. The same one twice in a joint, or
    the same command in two blocks of hardware, is a conflict.
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
                        where = f" in '{other}' already" if other != control.name else " twice"
                        yield Problem(
                            control.element,
                            f"{part.kind} '{part.name}' has the {kind} interface '{name}'{where}",
                            at=interface,
                        )
                    seen.add(name)


_STANDARD = ("position", "velocity", "acceleration", "effort")


@rule(
    INFO,
    on=("ros2",),
    effects={
        "gz_ros2_control": "ignores an interface other than position, velocity and effort",
    },
)
def nonstandard_interface_name(robot: Robot) -> Iterator[Problem]:
    """An interface of a joint is nearly called as usual.

    Controllers look for ``position``, ``velocity``, ``acceleration`` and ``effort``. Other names
    are right for hardware with more to say; a ``postion`` is found by nobody.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for interface in (*joint.command_interfaces, *joint.state_interfaces):
                near = did_you_mean(interface.name, _STANDARD, 0.8)
                if interface.name not in _STANDARD and near:
                    yield Problem(
                        control.element,
                        f"joint '{joint.name}' has an interface '{interface.name}'{near}",
                        at=interface.element.attribute_place("name"),
                    )


@rule(
    INFO,
    on=("ros2",),
    effects={
        "joint_trajectory_controller": (
            "does not activate where it needs a state interface that is not there"
        ),
    },
)
def command_without_state(robot: Robot) -> Iterator[Problem]:
    """A joint has a command interface and no state interface of that name.

    Most controllers read the state of what they command: the trajectory controller does not
    configure a joint of which it commands the velocity without its position and velocity. The
    wheels of a drive are different: ``diff_drive_controller`` commands their velocity and reads
    their position, or their velocity with ``position_feedback: false``. A joint that turns without
    end is therefore right with either state. The state may be in another ``<ros2_control>`` block,
    as that of a sensor is.
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
                words = quoted(interface.name for interface in missing)
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' has the command {words} and not the state of that name",
                    at=missing[0],
                )


@rule(
    WARNING,
    on=("ros2",),
    effects={
        "ros2_control": "has no interface for the joint, so no broadcaster reports its motion",
    },
)
def joint_outside_ros2_control(robot: Robot) -> Iterator[Problem]:
    """A joint moves and is in no ``<ros2_control>`` block, though others are.

    Nobody reports where it is: RViz finds no transform to what hangs on it. A joint that is only to
    be reported needs a state interface and no command.
    """
    known = {joint.name for control in robot.ros2_controls for joint in control.joints}
    if not known or not known.intersection(robot.joint) or _reports_otherwise(robot):
        return
    for joint in robot.moving_joints:
        if joint.mimic is None and joint.has_axis and joint.name not in known:
            yield Problem(
                joint,
                f"joint '{joint.name}' moves and is in no <ros2_control>; "
                "add it there with a state interface",
            )


def _reports_otherwise(robot: Robot) -> bool:
    """Whether a plugin of Gazebo reports joints as well."""
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
    """The ``initial_value`` of an interface is no number, or outside the joint's limits.

    The simulated hardware starts the joint there. Text that is no number ends it; a position
    outside the limits is corrected with a jolt.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for interface in joint.state_interfaces:
                text = interface.params.get("initial_value")
                if text is None or is_unexpanded(text):
                    continue
                value = number(text)
                if value is None:
                    wrong = "is no number"
                elif interface.name == "position" and (
                    limits := _outside(robot, joint.name, value)
                ):
                    wrong = f"is outside the limits, {limits}"
                else:
                    continue
                yield Problem(
                    control.element,
                    f"initial_value of joint '{joint.name}' is '{text}', which {wrong}",
                    at=_param(interface.element, "initial_value"),
                    severity=None if value is None else WARNING,
                )


def _outside(robot: Robot, name: str, value: float) -> str:
    joint = robot.joint.get(name)
    if joint is None or not joint.is_limited or joint.limit is None:
        return ""
    low, high = joint.limit.lower or 0.0, joint.limit.upper or 0.0
    return "" if low > high or low <= value <= high else f"{low:g} to {high:g}"


def _param(element: Element, name: str) -> Element:
    return next((p for p in element.all("param") if p.get("name") == name), element)
