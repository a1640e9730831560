"""Actuators and sensors of joints as ``<ros2_control>`` in an export to URDF."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Joint, Robot
from ...model.mechanism import JointActuator, MountedSensor
from ...model.numbers import number_text
from .translation import Translation, add

_INTERFACES = {"position": "position", "velocity": "velocity", "motor": "effort"}
"""Command interface of each kind of actuator."""

_MEASURED = {"jointpos": "position", "jointvel": "velocity", "jointactuatorfrc": "effort"}
"""State interface of each type of sensor of MJCF."""

_MOVING = ("revolute", "continuous", "prismatic", "screw")


def is_joint_state(sensor: MountedSensor) -> bool:
    """Tell whether a sensor becomes a state interface."""
    return bool(sensor.joint) and sensor.type in _MEASURED


def add_control(t: Translation) -> None:
    """Add ``<ros2_control>`` with all moving joints, if the source has actuators."""
    robot = t.robot
    if not robot.joint_actuators:
        return
    if not t.options.hardware:
        _report(t, robot.joint_actuators, "are dropped, as requested")
        return
    chosen = _choose(t)
    if not chosen:
        return
    name = "".join(c if c.isalnum() else "_" for c in robot.name or "robot")
    block = add(t.root, "ros2_control", name=name, type="system")
    add(add(block, "hardware"), "plugin", t.options.hardware)
    for joint in robot.joints:
        if joint.type in _MOVING:
            node = add(block, "joint", name=t.names.joints[joint.name])
            own = chosen.get(joint.name, [])
            for actuator in own:
                _add_command(node, actuator)
            _add_states(node, robot, joint, own)
    count = sum(map(len, chosen.values()))
    t.written.summary.append(f"{count} {'actuator' if count == 1 else 'actuators'}")
    t.written.report_loss(
        "hardware",
        f"<ros2_control> names the hardware '{t.options.hardware}', since the source names none; "
        "--hardware PLUGIN sets another",
        robot.joint_actuators[0].place,
        kind="robot",
        name=robot.name,
        severity=Severity.INFO,
    )


def _choose(t: Translation) -> dict[str, list[JointActuator]]:
    """Return the actuators with a command interface by joint; report the others."""
    chosen: dict[str, list[JointActuator]] = {}
    laws, followers, seconds = [], [], []
    for actuator in t.robot.joint_actuators:
        own = chosen.get(actuator.joint, [])
        joint = t.robot.joint[actuator.joint]
        if actuator.mode not in _INTERFACES or not actuator.gear or not actuator.gain:
            laws.append(actuator)
        elif joint.mimic is not None:
            followers.append(actuator)
        elif any(other.mode == actuator.mode for other in own):
            seconds.append(actuator)
        else:
            chosen.setdefault(actuator.joint, []).append(actuator)
    _report(t, laws, "are dropped, since ros2_control has no interface for their control law")
    _report(t, followers, "are dropped, since their joints mimic others")
    _report(t, seconds, "are dropped, since their joints have another of the same kind")
    shared = [one for own in chosen.values() if len(own) > 1 for one in own]
    _report(t, shared, "act together, but ros2_control has them as modes of one joint")
    return chosen


def _report(t: Translation, actuators: Sequence[JointActuator], why: str) -> None:
    for actuator in actuators:
        name = actuator.name or f"of joint '{actuator.joint}'"
        t.written.report_loss(
            "actuator",
            f"actuators {why}: '{name}'",
            actuator.place,
            kind="actuator",
            name=actuator.name or actuator.joint,
        )


def compute_command_range(actuator: JointActuator) -> tuple[float, float] | None:
    """Return the range of the command at the joint [rad, rad/s, N·m or the same with m and N].

    Args:
        actuator: An actuator whose mode is not ``general``.
    """
    if actuator.control_range is None:
        return None
    # the length of the actuator is gear times that of the joint; its force gear times smaller
    motor = actuator.mode == "motor"
    factor = actuator.gear * actuator.gain if motor else 1 / actuator.gear
    lower, upper = sorted(factor * value for value in actuator.control_range)
    if motor and actuator.force_range is not None:
        least, most = sorted(actuator.gear * value for value in actuator.force_range)
        lower, upper = max(lower, least), min(upper, most)
    return lower, upper


def _add_command(node: etree._Element, actuator: JointActuator) -> None:
    inner = add(node, "command_interface", name=_INTERFACES[actuator.mode])
    bounds = compute_command_range(actuator)
    if bounds is not None and all(map(math.isfinite, bounds)):
        _add_parameters(inner, zip(("min", "max"), bounds, strict=True))
    squared = actuator.gear**2
    if actuator.mode == "position":
        gains = [("kp", actuator.gain * squared)]
        if actuator.bias[2]:
            gains.append(("kv", -actuator.bias[2] * squared))
        _add_parameters(inner, gains)
    elif actuator.mode == "velocity":
        _add_parameters(inner, [("kv", actuator.gain * squared)])


def _add_parameters(node: etree._Element, values: Iterable[tuple[str, float]]) -> None:
    for name, value in values:
        add(node, "param", number_text(value), name=name)


def _add_states(
    node: etree._Element, robot: Robot, joint: Joint, own: Sequence[JointActuator]
) -> None:
    """Add the state interfaces: position and velocity, and effort where it is used."""
    measured = {
        _MEASURED[sensor.type]
        for sensor in robot.mounted_sensors
        if sensor.joint == joint.name and is_joint_state(sensor)
    }
    used = {_INTERFACES[actuator.mode] for actuator in own} | measured
    for name in ("position", "velocity", "effort"):
        if name != "effort" or name in used:
            add(node, "state_interface", name=name)
