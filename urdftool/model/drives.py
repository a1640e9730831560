"""Joints that a description drives, and how: one place for every format.

A URDF does so by transmissions, ros2_control or Gazebo plugins, an MJCF by actuators, a USD by
drives of joints.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from .elements import ControlComponent, Joint, Plugin, Robot
from .kinematics import MOVABLE, get_limits
from .mechanism import JointActuator
from .numbers import number
from .part import Part

PLUGINS = (
    "diff_drive",
    "skid_steer",
    "ackermann",
    "tricycle",
    "planar_move",
    "mecanum",
    "hoverboard",
)
"""Words in the names of Gazebo plugins that drive a robot over the ground."""


INTERFACES = ("position", "velocity", "effort")


def drive_plugins(robot: Robot) -> list[Plugin]:
    """Return the plugins that drive a robot over the ground."""
    found = []
    for plugin in robot.plugins:
        words = f"{plugin.filename} {plugin.name}".lower().replace("-", "_")
        if any(word in words or word.replace("_", "") in words for word in PLUGINS):
            found.append(plugin)
    return found


def get_plugin_drives(robot: Robot) -> dict[str, str]:
    """Return how drive plugins actuate the joints that they name.

    Returns:
        By joint name: ``velocity`` for a wheel, ``position`` for a joint with limits, which steers.
    """
    plugin_drives = {}
    for plugin in drive_plugins(robot):
        for element in plugin.element.walk():
            for name in re.split(r"[,\s]+", element.text.strip()):
                joint = robot.joint.get(name)
                if joint is not None and joint.type in MOVABLE:
                    lower, upper = get_limits(joint)
                    turns = joint.type == "continuous" or not -7.0 < lower < upper < 7.0
                    plugin_drives[name] = "velocity" if turns else "position"
    return plugin_drives


def get_commanded_joints(robot: Robot) -> set[str]:
    """Return the names of joints that a transmission, ros2_control or a drive plugin actuates."""
    names = {joint.name for part in robot.transmissions for joint in part.joints}
    for block in robot.ros2_controls:
        names |= {joint.name for joint in block.joints if joint.command_interfaces}
    return (names & set(robot.joint)) | set(get_plugin_drives(robot))


def get_actuator_kind(interfaces: list[str]) -> str:
    """Return the actuator kind for hardware interfaces; the first known interface counts."""
    for name in interfaces:
        for interface in INTERFACES:
            if interface in name.lower().rpartition("/")[2]:
                return "motor" if interface == "effort" else interface
    return "motor"


def list_servo_joints(robot: Robot) -> list[str]:
    """Return the joints with a position or velocity interface, which need gains, in file order."""
    kinds = get_plugin_drives(robot)
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            names = [*joint.hardware_interfaces]
            names += [name for part in transmission.actuators for name in part.hardware_interfaces]
            kinds[joint.name] = get_actuator_kind(names)
    for block in robot.ros2_controls:
        for component in block.joints:
            names = [interface.name for interface in component.command_interfaces]
            if names:
                kinds[component.name] = get_actuator_kind(names)
    return [joint.name for joint in robot.joints if kinds.get(joint.name, "motor") != "motor"]


GAINS = {"stiffness": "N·m/rad or N/m", "damping": "N·m·s/rad or N·s/m"}
"""Units of the gains of a drive: names in ``Drive`` and of attributes of USD."""


@dataclass(slots=True)
class Drive(Part):
    """Drive of a joint.

    Attributes:
        joint: Name of the joint.
        mode: ``motor``, ``position``, ``velocity`` or ``general``.
        gear: Reduction of a motor; None if not written.
        stiffness: Force for each unit of position [N·m/rad or N/m]; None if not written.
        damping: Force for each unit of velocity [N·m·s/rad or N·s/m]; None if not written.
        force: Largest force at the joint [N·m or N]; None if not limited.
        commands: Least and largest command at the joint [rad, m, rad/s, m/s, N·m or N]; None if not
            written.
        source: ``plugin``, ``transmission``, ``ros2_control`` or ``actuator``.
        owner: Name of the block or actuator.
    """

    joint: str = ""
    mode: str = "motor"
    gear: float | None = None
    stiffness: float | None = None
    damping: float | None = None
    force: float | None = None
    commands: tuple[float, float] | None = None
    source: str = "actuator"
    owner: str = ""


def list_drives(robot: Robot) -> Iterator[Drive]:
    """Yield the drives of joints that exist; of several of a joint the last one counts."""
    yield from _list_actuators(robot)
    for name, mode in get_plugin_drives(robot).items():
        yield Drive(robot.joint[name].provenance, name, mode, source="plugin")
    for part in robot.transmissions:
        reductions = (actuator.mechanical_reduction for actuator in part.actuators)
        reduction = next((value for value in reductions if value), 1.0)
        shared = [name for actuator in part.actuators for name in actuator.hardware_interfaces]
        for joint in part.joints:
            mode = get_actuator_kind([*joint.hardware_interfaces, *shared])
            gear = reduction if mode == "motor" else None
            if joint.name in robot.joint:
                source = "transmission"
                yield Drive(part.provenance, joint.name, mode, gear, source=source, owner=part.name)
    for block in robot.ros2_controls:
        for component in block.joints:
            if component.command_interfaces and component.name in robot.joint:
                yield _read_component(component, block.name)


def _read_component(component: ControlComponent, owner: str) -> Drive:
    """Return the drive of a joint of ros2_control, with gains and range of its interface."""
    mode = get_actuator_kind([interface.name for interface in component.command_interfaces])
    name = "effort" if mode == "motor" else mode
    interface = next((one for one in component.command_interfaces if one.name == name), None)
    values = {} if interface is None else {k: number(v) for k, v in interface.params.items()}
    low, high = values.get("min"), values.get("max")
    return Drive(
        component.provenance,
        component.name,
        mode,
        stiffness=values.get("kp") if mode == "position" else None,
        damping=values.get("kv") if mode != "motor" else None,
        commands=None if low is None or high is None else (low, high),
        source="ros2_control",
        owner=owner,
    )


def _list_actuators(robot: Robot) -> Iterator[Drive]:
    """Yield the actuators of MJCF and USD with their gains at the joint."""
    for part in robot.joint_actuators:
        _, position, velocity = part.bias
        squared = part.gear * part.gear
        force = None
        if part.force_range is not None:
            force = max(map(abs, part.force_range)) * abs(part.gear)
        elif part.mode == "motor" and part.control_range is not None:
            force = max(map(abs, part.control_range)) * abs(part.gear * part.gain)
        yield Drive(
            part.provenance,
            part.joint,
            part.mode,
            part.gear if part.mode == "motor" else None,
            -position * squared if part.mode in ("position", "general") else None,
            -velocity * squared if part.mode != "motor" else None,
            force if force is None or math.isfinite(force) else None,
            _compute_commands(part),
            owner=part.name,
        )


def _compute_commands(part: JointActuator) -> tuple[float, float] | None:
    """Return the range of the commands at the joint; of a motor, those that its force allows."""
    if part.control_range is None:
        return None
    ends = [control / part.gear if part.gear else math.inf for control in part.control_range]
    if part.mode == "motor":
        low, high = part.force_range or (-math.inf, math.inf)
        forces = (min(max(part.gain * control, low), high) for control in part.control_range)
        ends = [part.gear * force for force in forces]
    return min(ends), max(ends)


def is_driven_alone(joint: Joint) -> bool:
    """Tell whether a joint can have a drive: it has one position, and no other joint leads it."""
    lower, upper = get_limits(joint)
    return joint.type in MOVABLE and joint.mimic is None and lower < upper
