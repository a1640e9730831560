"""Sensors and closed loops that a URDF writes in ``<gazebo>`` and ``<ros2_control>`` blocks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..source.document import Element
from .elements import GazeboExtension, Robot
from .gazebo_plugins import BODY_SENSORS, get_library
from .kinematics import link_poses
from .mechanism import Camera, Closure, MountedSensor
from .numbers import parse_numbers
from .part import Vector
from .plugins import read_plugin
from .pose import IDENTITY, Pose, compute_norm, get_origin_at, rotate
from .sensors import read_body_sensor, read_sensor, read_sensor_pose
from .settings import Rejected
from .world import WORLD

if TYPE_CHECKING:
    from .provenance import Provenance

LOOP_TYPES = ("revolute", "continuous", "prismatic", "ball", "fixed", "screw", "universal")
"""Types of joints of SDF that close a loop."""

_INTERFACES = {
    "force": "force",
    "torque": "torque",
    "linear_acceleration": "accelerometer",
    "angular_velocity": "gyro",
    "orientation": "framequat",
}
"""Sensors of MJCF by the first word of a state interface of ros2_control."""

_PART = "the name of a link or joint of the robot"


def add_blocks(robot: Robot) -> None:
    """Add the sensors and loops of a URDF; what cannot be read is in ``rejected_settings``."""
    for block in robot.gazebo:
        for sensor in block.sensors:
            _add_sensor(robot, block, sensor.element)
        for plugin in block.plugins:
            add_plugin(robot, plugin.element, block.reference or "")
        if not block.reference:
            for element in block.element.list_children("joint"):
                _add_loop(robot, element)
    for control in robot.ros2_controls:
        for component in control.components:
            frame = component.params.get("frame_id", "")
            words = [interface.name.partition(".")[0] for interface in component.state_interfaces]
            kinds = dict.fromkeys(_INTERFACES[word] for word in words if word in _INTERFACES)
            if component.kind == "sensor" and kinds and frame in robot.link:
                sensor_ = MountedSensor(component.element, component.name, "ros2_control", frame)
                sensor_.quantities = tuple(kind for kind in _INTERFACES.values() if kind in kinds)
                robot.mounted_sensors.append(sensor_)


def _add_sensor(robot: Robot, block: GazeboExtension, element: Element) -> None:
    name, reference = element.get("name") or "", block.reference or ""
    if reference not in robot.link and reference not in robot.joint:
        at = block.element if block.reference else element
        robot.rejected_settings.append(
            Rejected(at, "sensor", name, "gazebo reference", reference, _PART)
        )
        return
    on_link = reference in robot.link
    pose, frame = read_sensor_pose(element)
    if frame in robot.link and on_link and frame != reference:
        poses = link_poses(robot)
        if frame in poses and reference in poses:
            pose = poses[reference].invert() @ poses[frame] @ pose
    link, joint = (reference, "") if on_link else ("", reference)
    rejected = robot.rejected_settings
    add_parts(robot, read_sensor(element, pose, link=link, joint=joint, rejected=rejected))


def add_parts(robot: Robot, parts: Iterator[Camera | MountedSensor]) -> None:
    """Add cameras and sensors to their lists."""
    for part in parts:
        if isinstance(part, Camera):
            robot.cameras.append(part)
        else:
            robot.mounted_sensors.append(part)


def add_plugin(
    robot: Robot, element: Element, owner: str, provenance: Provenance | None = None
) -> None:
    """Add a plugin, and the sensor of one that measures a link or joint itself.

    Args:
        robot: The robot.
        element: The plugin, in SDF or in a ``<gazebo>`` block.
        owner: Name of its link or joint; empty for the robot.
        provenance: Location; None for the element.
    """
    robot.mounted_plugins.append(read_plugin(element, owner, provenance))
    kind = BODY_SENSORS.get(get_library(element))
    if kind is None:
        return
    named = (child.text.strip() for tag in kind.names for child in element.list_children(tag))
    name = next(named, "") or owner
    of_joint = kind.type == "force_torque"
    if name in (robot.joint if of_joint else robot.link):
        sensor = read_body_sensor(element, kind)
        sensor.provenance = provenance or element
        sensor.link, sensor.joint = ("", name) if of_joint else (name, "")
        robot.mounted_sensors.append(sensor)


def _add_loop(robot: Robot, element: Element) -> None:
    """Add a joint of SDF, whose pose is in the frame of its child."""
    name, type_ = element.get("name") or "", element.get("type") or ""
    ends = [_get_text(element, tag).rpartition("::")[2] for tag in ("parent", "child")]
    for tag, text, known, required in (
        ("joint type", type_, LOOP_TYPES, f"one of {', '.join(LOOP_TYPES)}"),
        ("parent", ends[0], {*robot.link, WORLD}, "the name of another link"),
        ("child", ends[1], {*robot.link} - {ends[0]}, "the name of another link"),
    ):
        if text not in known:
            rejected = Rejected(element, "closed loop", name, tag, text, required)
            robot.rejected_settings.append(rejected)
            return
    parent, child = ends
    poses = link_poses(robot)
    pose, frame = read_sensor_pose(element)
    start = poses.get(child, IDENTITY)
    if frame and frame != child:
        start = poses.get(frame, IDENTITY)
    at = start @ pose
    one, two = (
        get_origin_at(poses.get(link, IDENTITY).invert() @ at, element) for link in (parent, child)
    )
    axis = None if type_ in ("fixed", "ball") else _get_axis(element, at)
    kind = "weld" if type_ == "fixed" else type_
    robot.closures.append(Closure(element, name, kind, parent, child, one, two, axis))


def _get_axis(joint: Element, pose: Pose) -> Vector:
    """Return the unit axis in the frame of a joint."""
    axis = joint.find_child("axis")
    xyz = axis.find_child("xyz") if axis is not None else None
    x, y, z = parse_numbers(xyz.text if xyz is not None else "0 0 1", 3) or (0.0, 0.0, 1.0)
    length = compute_norm((x, y, z)) or 1.0
    direction = (x / length, y / length, z / length)
    old = axis is not None and _get_text(axis, "use_parent_model_frame").lower() in ("1", "true")
    if old or (xyz is not None and xyz.get("expressed_in") == "__model__"):
        return rotate(pose.invert().rotation, direction)
    return direction


def _get_text(element: Element, tag: str) -> str:
    child = element.find_child(tag)
    return child.text.strip() if child is not None else ""
