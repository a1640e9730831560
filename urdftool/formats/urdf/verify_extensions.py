"""Check of the extensions of an export to URDF against its source, after reading them back."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from ...compare.check import Check
from ...model.elements import ControlComponent, Interface, Robot, Sensor
from ...model.mechanism import Camera, JointActuator, MountedSensor
from ...model.pose import Pose, make_pose, rotation_from_rpy
from ...source.document import Element
from ..common.losses import DeclaredLosses
from ..common.srdf import read_srdf
from ..written import Written

_TOLERANCE = 1e-6
_KINDS = {
    "gyro": "imu",
    "accelerometer": "imu",
    "force": "force_torque",
    "torque": "force_torque",
    "magnetometer": "magnetometer",
}
_STATES = {"jointpos": "position", "jointvel": "velocity", "jointactuatorfrc": "effort"}


def check_extensions(
    robot: Robot,
    result: Robot,
    path: Path,
    names: Mapping[tuple[str, str], str],
    declared: DeclaredLosses,
) -> list[Check]:
    """Compare actuators, sensors, excluded contacts and named positions.

    Args:
        robot: The source, in a format other than URDF.
        result: The export, read back.
        path: The URDF file of the export.
        names: New names by kind and old name.
        declared: Losses that the export reported.
    """
    return [
        _check_actuators(robot, result, names, declared),
        _check_sensors(robot, result, names, declared),
        _check_srdf(robot, result, path, names, declared),
    ]


def _check_actuators(
    robot: Robot,
    result: Robot,
    names: Mapping[tuple[str, str], str],
    declared: DeclaredLosses,
) -> Check:
    check = Check(
        "actuators", "interfaces, ranges and gains of joints, relative", _TOLERANCE, is_empty=True
    )
    joints = {part.name: part for block in result.ros2_controls for part in block.joints}
    for actuator in robot.joint_actuators:
        item = f"actuator '{actuator.name}' of joint '{actuator.joint}'"
        known = declared.has_for(("lossy-actuator",), actuator.name or actuator.joint)
        joint = joints.get(names.get(("joint", actuator.joint), actuator.joint))
        check.compare(_compare_actuator(actuator, joint), item, known=known)
    return check


def _compare_actuator(actuator: JointActuator, joint: ControlComponent | None) -> float:
    """Return the largest relative difference of the force of an actuator; infinite if absent."""
    name = {"motor": "effort"}.get(actuator.mode, actuator.mode)
    interfaces = [] if joint is None else joint.command_interfaces
    interface = next((part for part in interfaces if part.name == name), None)
    if interface is None:
        return math.inf
    worst = 0.0
    if actuator.control_range is not None:
        for control in actuator.control_range:
            worst = max(worst, _compare_command(actuator, interface, control))
    kp, kv = (_read(interface, key) for key in ("kp", "kv"))
    for gain, bias in ((kp, actuator.bias[1]), (kv, actuator.bias[2])):
        if actuator.mode != "motor":  # the force of a deviation of 1 rad or 1 rad/s
            worst = max(worst, _relate(-gain, bias * actuator.gear * actuator.gear))
    return worst


def _compare_command(actuator: JointActuator, interface: Interface, control: float) -> float:
    """Return how far the end of a range is from the command that has the same effect."""
    if actuator.mode == "motor":
        force = actuator.gain * control
        if actuator.force_range is not None:
            force = min(max(force, actuator.force_range[0]), actuator.force_range[1])
        command = actuator.gear * force
    else:
        command = control / actuator.gear
    ends = [_read(interface, key) for key in ("min", "max")]
    return min(_relate(end, command) for end in ends)


def _read(interface: Interface, key: str) -> float:
    return float(interface.params.get(key, 0.0))


def _relate(one: float, other: float) -> float:
    return abs(one - other) / max(1.0, abs(other))


def _check_sensors(
    robot: Robot,
    result: Robot,
    names: Mapping[tuple[str, str], str],
    declared: DeclaredLosses,
) -> Check:
    check = Check(
        "sensors", "types, links, poses and fields of view [m, rad]", _TOLERANCE, is_empty=True
    )
    present: dict[str, list[Sensor]] = {}
    for block in result.gazebo:
        if block.reference is not None:
            present.setdefault(block.reference, []).extend(block.sensors)
    for camera in robot.cameras:
        there = present.get(names.get(("link", camera.link), camera.link), [])
        known = declared.has_for(("lossy-sensor",), camera.name)
        check.compare(_compare_camera(camera, there), f"camera '{camera.name}'", known=known)
    for sensor in robot.mounted_sensors:
        part = sensor.joint or sensor.link
        known = declared.has_for(("lossy-sensor",), sensor.name or part)
        state = _STATES.get(sensor.type) if sensor.joint else None
        if state is not None:
            difference = 0.0 if _has_state(result, names, part, state) else math.inf
        else:
            difference = _compare_sensor(robot, sensor, present, names)
        check.compare(difference, f"sensor '{sensor.name}'", known=known)
    return check


def _has_state(result: Robot, names: Mapping[tuple[str, str], str], joint: str, state: str) -> bool:
    own = names.get(("joint", joint), joint)
    parts = (part for block in result.ros2_controls for part in block.joints if part.name == own)
    return any(i.name == state for part in parts for i in part.state_interfaces)


def _compare_camera(camera: Camera, there: list[Sensor]) -> float:
    """Return the difference from the nearest camera on the link; infinite if there is none."""
    worst = math.inf
    for sensor in there:
        inner = sensor.element.find_child("camera")
        if inner is None:
            continue
        difference = _measure(_read_pose(sensor), make_pose(camera.origin))
        field, image = inner.find_child("horizontal_fov"), inner.find_child("image")
        if camera.vertical_fov is not None and field is not None and image is not None:
            width, height = (_read_text(image, tag) for tag in ("width", "height"))
            up = 2 * math.atan(math.tan(float(field.text) / 2) * height / width)
            difference = max(difference, abs(up - camera.vertical_fov))
        worst = min(worst, difference)
    return worst


def _compare_sensor(
    robot: Robot,
    sensor: MountedSensor,
    present: Mapping[str, list[Sensor]],
    names: Mapping[tuple[str, str], str],
) -> float:
    kind = _KINDS.get(sensor.type, sensor.type)
    if sensor.joint:
        part = names.get(("joint", sensor.joint), sensor.joint)
    elif sensor.type in ("force", "torque"):
        above = next((joint.name for joint in robot.joints if joint.child == sensor.link), "")
        part = names.get(("joint", above), above)
    else:
        part = names.get(("link", sensor.link), sensor.link)
    own = [other for other in present.get(part, []) if other.type == kind]
    if sensor.origin is None:
        return 0.0 if own else math.inf
    pose = make_pose(sensor.origin)
    return min((_measure(_read_pose(other), pose) for other in own), default=math.inf)


def _read_pose(sensor: Sensor) -> Pose:
    element = sensor.element.find_child("pose")
    if element is None:
        return make_pose(None)
    x, y, z, roll, pitch, yaw = map(float, element.text.split())
    return Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))


def _read_text(element: Element, tag: str) -> float:
    child = element.find_child(tag)
    return math.nan if child is None else float(child.text)


def _measure(one: Pose, other: Pose) -> float:
    rows = zip((*one.rotation, one.translation), (*other.rotation, other.translation), strict=True)
    return max(abs(a - b) for row, to in rows for a, b in zip(row, to, strict=True))


def _check_srdf(
    robot: Robot,
    result: Robot,
    path: Path,
    names: Mapping[tuple[str, str], str],
    declared: DeclaredLosses,
) -> Check:
    check = Check("srdf", "excluded contacts, named joint positions [rad, m]", _TOLERANCE)
    check.is_empty = not (robot.exclusions or robot.configurations)
    if check.is_empty:
        return check
    file, problems = path.with_suffix(".srdf"), Written(path.name)
    if not file.is_file():
        known = declared.has_any("lossy-exclusion", "lossy-configuration")
        check.compare(math.inf, "the SRDF file", known=known)
        return check
    read = read_srdf(file, result, problems, None)
    for problem in problems.losses:
        check.compare(math.inf, problem.message)
    disabled = {frozenset(pair) for pair in read.disabled}
    for pair in robot.exclusions:
        both = frozenset(names.get(("link", name), name) for name in (pair.link, pair.other))
        item = f"contact of '{pair.link}' and '{pair.other}'"
        known = declared.has_for(("lossy-exclusion",), pair.link)
        check.compare(0.0 if both in disabled else math.inf, item, known=known)
    for configuration in robot.configurations:
        state = read.states.get(configuration.name, {})
        for joint, value in configuration.positions.items():
            if robot.joint[joint].mimic is None:
                written = state.get(names.get(("joint", joint), joint), math.inf)
                check.compare(abs(written - value), f"'{configuration.name}': joint '{joint}'")
    return check
