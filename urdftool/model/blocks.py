"""Sensors and closed loops that a URDF writes in ``<gazebo>`` and ``<ros2_control>`` blocks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ..source.document import Element
from .elements import GazeboExtension, Robot
from .gazebo_plugins import BODY_SENSORS, SENSOR_PLUGINS, get_library
from .kinematics import get_zero_poses
from .mechanism import Camera, Closure, Light, MountedSensor
from .numbers import number, parse_numbers
from .part import Vector
from .plugins import read_plugin
from .pose import IDENTITY, Pose, compute_norm, get_origin_at, rotate
from .sdf_schema import find_requirement, walk_values
from .sensors import read_body_sensor, read_sensor, read_sensor_pose
from .settings import BAD_ELEMENT, RESISTANCE_OF_URDF, Rejected, is_false, is_setting
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
        for element in block.element.list_children("joint"):
            _add_loop(robot, block.reference or "", element)
        for element in block.element.list_children("light"):
            _add_light(robot, block.reference or "", element)
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
        if not reference:  # else the block is reported
            part = "sensor", name, "gazebo reference", reference, _PART
            robot.rejected_settings.append(Rejected(element, "misplaced-extension", *part))
        return
    cameras = [("camera", camera.find_child("pose")) for camera in element.list_children("camera")]
    _reject_values(robot, ("sensor", name), [("sensor", element.find_child("pose")), *cameras])
    on_link = reference in robot.link
    pose, frame = read_sensor_pose(element)
    if frame in robot.link and on_link and frame != reference:
        poses = get_zero_poses(robot)
        if frame in poses and reference in poses:
            pose = poses[reference].invert() @ poses[frame] @ pose
    link, joint = (reference, "") if on_link else ("", reference)
    rejected = robot.rejected_settings
    add_parts(robot, element, read_sensor(element, pose, link=link, joint=joint, rejected=rejected))


def add_parts(robot: Robot, sensor: Element, parts: Iterator[Camera | MountedSensor]) -> None:
    """Add the cameras or the sensor of a ``<sensor>`` to their lists, and its own plugins."""
    for plugin in sensor.list_children("plugin"):
        if get_library(plugin) not in SENSOR_PLUGINS:
            robot.sensor_plugins.append(read_plugin(plugin, sensor.get("name") or ""))
    for part in parts:
        if isinstance(part, Camera):
            robot.cameras.append(part)
        else:
            robot.mounted_sensors.append(part)


def add_plugin(
    robot: Robot, element: Element, owner: str, provenance: Provenance | None = None
) -> None:
    """Add a plugin, and the sensor of one that measures a link or joint itself."""
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


_PARTS = frozenset(
    ("sensor", "plugin", "light", "joint", "material", "visual", "collision", "pose", "mu",
     "canonicalBody")
)  # fmt: skip
"""Elements of blocks that are parts of a robot, or decide nothing of what a format lacks."""


def list_unread_elements(robot: Robot) -> Iterator[tuple[GazeboExtension, Element]]:
    """Yield each element in ``<gazebo>`` that is neither a setting nor such a part, with its block.

    A format that does not copy blocks reports them.
    """
    for block in robot.gazebo:
        for element in block.element.children:
            if element.tag not in _PARTS and not is_setting(element.tag):
                yield block, element


_LIGHTS = ("point", "directional", "spot")


def _add_light(robot: Robot, link: str, element: Element) -> None:
    """Add a light of a link; by default it points down."""
    if link not in robot.link:
        required = "the name of a link of the robot"
        name = element.get("name") or ""
        if not link or link in robot.joint:  # else the block is reported
            part = "light", name, "gazebo reference", link, required
            robot.rejected_settings.append(Rejected(element, "unknown-extension", *part))
        return
    _reject_values(robot, ("light", element.get("name") or ""), walk_values("link", element))
    kind = element.get("type") or "point"
    pose, _ = read_sensor_pose(element)
    direction = None
    if kind != "point":
        x, y, z = parse_numbers(_get_text(element, "direction"), 3) or _DOWN
        direction = rotate(pose.rotation, (x, y, z) if any((x, y, z)) else _DOWN)
    diffuse, specular = (_read_color(element, tag) for tag in ("diffuse", "specular"))
    spot = element.find_child("spot")
    outer = number(_get_text(spot, "outer_angle")) if spot is not None else None
    robot.lights.append(
        Light(
            element,
            element.get("name") or "light",
            link,
            kind if kind in _LIGHTS else "point",
            pose.translation,
            direction,
            diffuse,
            specular,
            outer / 2 if kind == "spot" and outer else None,
            not is_false(_get_text(element, "cast_shadows")),
        )
    )


_DOWN: Vector = (0.0, 0.0, -1.0)


def _read_color(element: Element, tag: str) -> Vector | None:
    text = _get_text(element, tag)
    parts = parse_numbers(text, 4) or parse_numbers(text, 3)
    return None if parts is None else (parts[0], parts[1], parts[2])


def _add_loop(robot: Robot, reference: str, element: Element) -> None:
    """Add a joint of SDF, whose pose is in the frame of its child."""
    name, type_ = element.get("name") or "", element.get("type") or ""
    pose, frame = read_sensor_pose(element)
    ends = [_get_text(element, tag).rpartition("::")[2] for tag in ("parent", "child")]
    invalid = _reject_values(robot, ("joint", name), walk_values("model", element))
    for tag, what, text, known, required in (
        ("", "gazebo reference", reference, ("",), "absent"),
        ("", "joint type", type_, LOOP_TYPES, f"one of {', '.join(LOOP_TYPES)}"),
        ("pose", "frame of the pose", frame, {*robot.link, "", "__model__"}, "the name of a link"),
        ("parent", "parent", ends[0], {*robot.link, WORLD}, "the name of another link"),
        ("child", "child", ends[1], {*robot.link} - {ends[0]}, "the name of another link"),
    ):
        if text not in known:
            code = "dangling-reference" if tag else _CODES[what]
            written = element.find_child(tag) or element
            if all(one.provenance is not written for one in invalid):
                rejected = Rejected(written, code, "joint", name, what, text, required)
                robot.rejected_settings.append(rejected)
            return
    parent, child = ends
    poses = get_zero_poses(robot)
    start = poses.get(child, IDENTITY)
    if frame and frame != child:
        start = poses.get(frame, IDENTITY)
    at = start @ pose
    one, two = (
        get_origin_at(poses.get(link, IDENTITY).invert() @ at, element) for link in (parent, child)
    )
    axis = None if type_ in ("fixed", "ball") else _get_axis(element, at)
    kind = "weld" if type_ == "fixed" else type_
    closure = Closure(element, name, kind, parent, child, one, two, axis)
    closure.is_limited, closure.has_dynamics = _has_bounds(element), _has_dynamics(element)
    robot.closures.append(closure)


_CODES = {"gazebo reference": "unknown-extension", "joint type": BAD_ELEMENT}
"""Rules of ``lint`` that report what is wrong with a joint of SDF, apart from its references."""


def _reject_values(
    robot: Robot, part: tuple[str, str], elements: Iterable[tuple[str, Element | None]]
) -> list[Rejected]:
    """Reject the invalid values of elements of SDF, each after the tag that holds it."""
    rejected = [
        Rejected(one, BAD_ELEMENT, *part, one.tag, one.text.strip(), required.text)
        for above, one in elements
        if one is not None and (required := find_requirement(above, one))
    ]
    robot.rejected_settings += rejected
    return rejected


def _has_bounds(joint: Element) -> bool:
    """Tell whether a joint of SDF has a limit of its position."""
    limit = _find(joint, "axis", "limit")
    ends = () if limit is None else (number(_get_text(limit, end)) for end in ("lower", "upper"))
    return any(end is not None and abs(end) < _UNBOUNDED for end in ends)


_UNBOUNDED = 1e15
"""Limit that stands for none; sdformat writes 1e16."""


def _has_dynamics(joint: Element) -> bool:
    """Tell whether a joint of SDF has dynamics: resistance or a spring."""
    part = _find(joint, "axis", "dynamics")
    tags = (*RESISTANCE_OF_URDF, "spring_stiffness")
    return part is not None and any(number(_get_text(part, tag)) for tag in tags)


def _find(element: Element, *tags: str) -> Element | None:
    found: Element | None = element
    for tag in tags:
        found = None if found is None else found.find_child(tag)
    return found


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
