"""Rules on sensors in ``<gazebo>`` blocks."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from ...model.attached import find_attached_links
from ...model.elements import GazeboExtension, Link, Robot, Sensor
from ...model.gazebo_plugins import SENSOR_PLUGINS, get_library, is_for_yarp
from ...model.pose import IDENTITY, Pose, rotation_from_rpy
from ...model.read import parse_numbers
from ...source.document import Element
from ..fix import (
    FixContext,
    Proposal,
    append_child,
    append_number,
    escape_attribute,
    get_suggestion,
    get_written_text,
    get_written_value,
    is_computed,
    remove_element,
    rename_element,
    replace_element,
    safe,
    set_attribute,
    unsafe,
)
from ..rule import ERROR, GAZEBO, INFO, ROS, SAFE, UNSAFE, WARNING, Problem, rule
from ..words import find_nearest, split_words, suggest_name
from .lumping import get_lumped_body

APPLIES_TO = ("gazebo",)

TYPES = split_words(
    "air_pressure air_speed altimeter boundingbox_camera camera contact depth depth_camera "
    "force_torque gps gpu_lidar gpu_ray imu lidar logical_camera magnetometer multicamera navsat "
    "ray rfid rfidtag rgbd rgbd_camera segmentation segmentation_camera boundingbox sonar thermal "
    "thermal_camera wireless_receiver wireless_transmitter wideanglecamera wide_angle_camera custom"
)

_WITH_FRAME = split_words(
    "camera depth depth_camera rgbd rgbd_camera gpu_lidar gpu_ray lidar ray imu thermal "
    "thermal_camera segmentation segmentation_camera boundingbox boundingbox_camera"
)

_OPTICS = ("camera", "lidar", "ray")
"""Elements of a sensor that may have their own pose."""


def _iterate_sensors(robot: Robot) -> Iterator[tuple[GazeboExtension, Sensor]]:
    for block in robot.gazebo:
        for sensor in block.sensors:
            yield block, sensor


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": (
            "report Error 5: the sensor type is missing or invalid (sdformat 12.3)"
        ),
    },
)
def unknown_sensor_type(robot: Robot) -> Iterator[Problem]:
    """A sensor has no type, or a type that is not in SDF.

    sdformat reports that the sensor type is missing or invalid, and Gazebo does not create the
    sensor.
    """
    for sensor in robot.sensors:
        if sensor.type not in TYPES:
            what = f"'{sensor.type}' is not a sensor type" if sensor.type else "no sensor type"
            near = suggest_name(sensor.type, TYPES) if sensor.type else ""
            name = f"sensor '{sensor.name}': " if sensor.name else ""
            yield Problem(
                sensor.element,
                f"{name}{what}{near or '; write, for example, camera, imu or gpu_lidar'}",
                at=sensor.locate_attribute("type"),
                data={"suggestion": find_nearest(sensor.type, TYPES) if sensor.type else ""},
            )


@unknown_sensor_type.fix(UNSAFE)
def write_sensor_type(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested type."""
    name = get_suggestion(problem, problem.element.get("type") or "")
    return unsafe(f"write {name}", set_attribute(problem.element, "type", name)) if name else None


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz": "creates no sensor: type LIDAR is not supported, use a GPU LIDAR",
    },
)
def cpu_ray_in_gz(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A laser scanner has a CPU type, which new Gazebo does not support.

    Types ``ray`` and ``lidar`` are for Gazebo Classic. New Gazebo up to version 10 requires the GPU
    type: write ``type="gpu_lidar"``, and ``<lidar>`` in place of ``<ray>``.
    """
    if "gazebo-classic" in targets:
        return
    for sensor in robot.sensors:
        if sensor.type in ("ray", "lidar"):
            yield Problem(
                sensor.element,
                f"sensor '{sensor.name}' has type '{sensor.type}', which new Gazebo does not "
                "support; "
                "write gpu_lidar",
                at=sensor.locate_attribute("type"),
            )


@cpu_ray_in_gz.fix(UNSAFE)
def write_gpu_lidar(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the GPU type, which Gazebo Classic does not support."""
    sensor = problem.element
    changes = [set_attribute(sensor, "type", "gpu_lidar")]
    if sensor.find_child("lidar") is None:
        changes += [rename_element(child, "lidar") for child in sensor.list_children("ray")]
    return unsafe("write gpu_lidar", *changes)


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz": "cannot load it: the shared library is not found",
    },
)
def ros_plugin_inside_sensor(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A sensor has a ROS plugin of Gazebo Classic.

    New Gazebo cannot load it: its sensors publish data themselves. Add a ``<topic>`` and a
    ``<gz_frame_id>`` to the sensor, and bridge the topic with ros_gz_bridge.
    """
    if "gazebo-classic" in targets:
        return
    for sensor in robot.sensors:
        for plugin in sensor.plugins:
            if plugin.filename.rpartition("/")[2].startswith("libgazebo_ros_"):
                yield Problem(
                    sensor.element,
                    f"sensor '{sensor.name}' has '{plugin.filename}', which new Gazebo cannot "
                    "load; "
                    "write <topic>, and bridge it with ros_gz_bridge",
                    at=plugin.locate_attribute("filename"),
                )


@ros_plugin_inside_sensor.fix(UNSAFE)
def write_topic(problem: Problem, context: FixContext) -> Proposal | None:
    """Replace the plugin by its topic, once the sensor itself has the frame that it names."""
    sensor = problem.element
    if not _has_frame(sensor) and _find_frame_parameter(sensor) is not None:
        return None  # the fix of missing-gz-frame-id writes it first
    plugins = [
        p for p in sensor.list_children("plugin") if "libgazebo_ros_" in (p.get("filename") or "")
    ]
    if len(plugins) != 1:
        return None
    plugin = plugins[0]
    tags = ("topicName", "topic_name", "imageTopicName", "topic")
    texts = [child.text.strip() for tag in tags for child in plugin.list_children(tag)]
    for argument in plugin.walk():
        if argument.tag == "remapping" and ":=" in argument.text:
            texts.append(argument.text.partition(":=")[2].strip())
    topic = next((text for text in texts if text), (sensor.get("name") or "").strip())
    if not topic or "$" in topic:
        return None
    line = f"<topic>{escape_attribute(topic)}</topic>"
    named = sensor.find_child("topic") is not None
    change = remove_element(plugin) if named else replace_element(plugin, (line,))
    return unsafe(f"write <topic>{topic}</topic>", change)


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "stamps the data with the scoped name of the sensor, which is not a TF frame",
    },
)
def missing_gz_frame_id(
    robot: Robot, targets: frozenset[str], guessed: frozenset[str], *, together: float = 4
) -> Iterator[Problem]:
    """A sensor has no ``<gz_frame_id>``.

    New Gazebo then uses a frame with the names of model, link and sensor, which does not exist in
    TF, so RViz shows no data. Write ``<gz_frame_id>`` (``ignition_frame_id`` in Fortress): the
    frame that the sensor's plugin names, such as the optical frame of a camera, otherwise the link
    of the sensor. If the sensor has a ``<pose>``, write a link that is fixed at that pose, or add
    one: with the link of the sensor its data would be displaced. More than ``together`` sensors of
    a kind are one finding. Without ROS among the targets it is an info, unless a plugin names the
    frame, and sensors for which no link exists are not reported, because no reader may need TF for
    their data; neither are any sensors if plugins of the robot pass data to YARP instead, or if
    only a ``<gazebo>`` tag shows that the robot is for new Gazebo.
    """
    if "gz" in guessed:
        return
    severity = INFO if targets.isdisjoint(ROS) else None
    if severity is INFO and any(
        is_for_yarp(one.element) for block in robot.gazebo for one in block.plugins
    ):
        return
    for sensor in find_sensors_without_frame(robot):
        if sensor.named is not None and sensor.frame is None:
            yield _report_unknown_frame(sensor, sensor.named.text.strip())
    for placed in (True, False) if severity is None else (True,):
        found = [
            one
            for one in find_sensors_without_frame(robot)
            if (one.frame is not None) is placed and (placed or one.named is None)
        ]
        many = len(found) > together
        for sensor in found[:1] if many else found:
            others = f" (and {len(found) - 1} more)" if many else ""
            of = [one.sensor.name for one in (found if many else [sensor])]
            data: dict[str, object] = {"sensors": of, "link": sensor.link.name}
            name = f"sensor '{sensor.sensor.name}'{others}"
            if sensor.frame is None:
                what = (
                    f"{name} has no <gz_frame_id>, and no link is at its <pose> in "
                    f"'{sensor.link.name}'; add a link there, and write it in <gz_frame_id>"
                )
            else:
                where = ", and the frame of each of the others" if many else ""
                frame = f"<gz_frame_id>{sensor.frame.name}</gz_frame_id>"
                of_plugin = f", as <{sensor.named.tag}> of its plugin" if sensor.named else ""
                what = f"{name} has no <gz_frame_id>; write {frame}{of_plugin}{where}"
                data["frame"] = sensor.frame.name
            rated = severity if sensor.named is None else None
            yield Problem(sensor.sensor.element, what, data=data, severity=rated)


def _report_unknown_frame(one: SensorWithoutFrame, name: str) -> Problem:
    assert one.named is not None
    return Problem(
        one.sensor.element,
        f"sensor '{one.sensor.name}' has no <gz_frame_id>, and <{one.named.tag}> of its plugin "
        f"names '{name}', which is not a link; add the link, and write it in <gz_frame_id>",
        data={"sensors": [one.sensor.name], "link": one.link.name, "unknown_frame": name},
    )


@missing_gz_frame_id.fix(SAFE)
def write_frame_id(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the frame that the plugin names, otherwise the link at the pose of the sensor."""
    if "frame" not in problem.data:
        return None
    found = [one for one in find_sensors_without_frame(context.robot) if one.frame is not None]
    if len(problem.data["sensors"]) == 1:
        found = [one for one in found if one.sensor.element is problem.element]
    changes = []
    for one in found:
        name = _get_frame_name(one)
        if name is None:
            return None
        line = f"<gz_frame_id>{escape_attribute(name)}</gz_frame_id>"
        changes.append(append_child(one.sensor.element, line))
    if not changes:
        return None
    more = " and so on" if len(changes) > 1 else ""
    return safe(f"write {changes[0].blocks[0][0]}{more}", *changes)


def _get_frame_name(one: SensorWithoutFrame) -> str | None:
    """Get the frame of a sensor as written in the source; None if another file computes it."""
    block, frame = one.sensor.element.parent, one.frame
    if frame is None or block is None:
        return None
    if one.named is not None:
        return get_written_text(one.named)
    if frame is one.link:
        return get_written_value(block, "reference") or None
    if is_computed(frame.element) and frame.element.calls != one.sensor.element.calls:
        return None
    return get_written_value(frame.element, "name") or None


class SensorWithoutFrame(NamedTuple):
    """A sensor without a frame for new Gazebo.

    Attributes:
        sensor: The sensor.
        link: The link that contains it.
        frame: The link that its plugin names, otherwise that at its pose; None if there is none.
        named: Parameter of its plugin that names the frame; None without such a parameter.
    """

    sensor: Sensor
    link: Link
    frame: Link | None
    named: Element | None = None


def find_sensors_without_frame(robot: Robot) -> Iterator[SensorWithoutFrame]:
    """Yield the sensors of links that have no frame."""
    for block, sensor in _iterate_sensors(robot):
        if sensor.type in _WITH_FRAME and block.reference in robot.link:
            if not _has_frame(sensor.element):
                link, named = robot.link[block.reference], _find_frame_parameter(sensor.element)
                if named is not None:
                    frame = robot.link.get(named.text.strip())
                else:
                    frame = _find_link_at(robot, link, sensor)
                yield SensorWithoutFrame(sensor, link, frame, named)


def _has_frame(sensor: Element) -> bool:
    tags = {child.tag for child in sensor.walk()}
    return bool(tags & {"gz_frame_id", "ignition_frame_id", "optical_frame_id"})


def _find_frame_parameter(sensor: Element) -> Element | None:
    """Find the parameter of a plugin that names the frame of the messages of its sensor."""
    for plugin in sensor.list_children("plugin"):
        known = SENSOR_PLUGINS.get(get_library(plugin))
        for tag in known.frame if known is not None else ():
            found = plugin.find_child(tag)
            if found is not None and found.text.strip():
                return found
    return None


def _find_link_at(robot: Robot, link: Link, sensor: Sensor) -> Link | None:
    """Find the link at the pose of a sensor; None if there is none."""
    pose = get_pose_in_link(sensor)
    if pose is None:
        return None
    found = (
        other
        for other, at in find_attached_links(robot, link)
        if math.dist(at.translation, pose.translation) < 1e-4
        and all(math.dist(a, b) < 2e-3 for a, b in zip(at.rotation, pose.rotation, strict=True))
    )
    return next(found, None)


def get_pose_in_link(sensor: Sensor) -> Pose | None:
    """Read the pose of a sensor in its link; None if it is in a different form."""
    element = sensor.element
    inner = [child.find_child("pose") for child in element.children if child.tag in _OPTICS]
    if any(one is not None and any(parse_numbers(one.text, 6) or (1.0,)) for one in inner):
        return None  # the camera has a pose in its sensor
    pose = element.find_child("pose")
    if pose is None:
        return IDENTITY
    values = parse_numbers(pose.text, 6)
    if values is None or pose.attributes:
        return None
    x, y, z, roll, pitch, yaw = values
    return Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "report Error 2: the sensor already exists (sdformat 12.3)",
    },
)
def duplicate_sensor_name(robot: Robot) -> Iterator[Problem]:
    """Two sensors of one body have the same name.

    Names of siblings must be unique. Sensors of two links are siblings if fixed joint lumping joins
    the links into one body.
    """
    seen: dict[tuple[str, str], str] = {}
    for block, sensor in _iterate_sensors(robot):
        if block.reference not in robot.link or not sensor.name:
            continue
        body = get_lumped_body(robot, block.reference)
        other = seen.get((body, sensor.name))
        seen.setdefault((body, sensor.name), block.reference)
        if other is not None:
            where = "the same link" if other == block.reference else f"'{other}', fixed to it"
            yield Problem(
                sensor.element,
                f"another sensor on body '{body}' has the name '{sensor.name}' (on {where}); "
                "make it unique",
                at=sensor.locate_attribute("name"),
                data={"name": sensor.name, "body": body},
            )


@duplicate_sensor_name.fix(UNSAFE)
def number_sensor(problem: Problem, context: FixContext) -> Proposal | None:
    """Append a number to the duplicate name."""
    return append_number(problem, {sensor.name for sensor in context.robot.sensors})


_SENSOR_LINK = re.compile(r"camera|lidar|laser|(^|_)(scan|imu|gps)(_|$)", re.IGNORECASE)


@rule(
    INFO,
    on=GAZEBO,
    default=False,
    effects={
        "gz, gazebo-classic": "simulate no sensor data for the link",
    },
)
def missing_sensor_tag(robot: Robot) -> Iterator[Problem]:
    """A link has the name of a sensor, but no ``<sensor>``.

    A link without a ``<sensor>`` measures nothing. It is not reported if a link that is fixed to it
    has the sensor.
    """
    sensing = {
        get_lumped_body(robot, block.reference or "") for block, _ in _iterate_sensors(robot)
    }
    for link in robot.links:
        if not _SENSOR_LINK.search(link.name) or "optical" in link.name:
            continue
        if (link.visuals or link.collisions) and get_lumped_body(robot, link.name) not in sensing:
            yield Problem(
                link,
                f"link '{link.name}' has no <sensor>; write one into a "
                f'<gazebo reference="{link.name}">',
            )


_RENDERED = split_words(
    "boundingbox boundingbox_camera camera depth depth_camera gpu_lidar gpu_ray lidar multicamera "
    "rgbd rgbd_camera segmentation segmentation_camera thermal thermal_camera wide_angle_camera "
    "wideanglecamera"
)
_SYSTEM_OF = {
    **dict.fromkeys(_RENDERED, "sensors"),
    "air_pressure": "air-pressure",
    "air_speed": "air-speed",
    "altimeter": "altimeter",
    "contact": "contact",
    "force_torque": "forcetorque",
    "gps": "navsat",
    "imu": "imu",
    "logical_camera": "logical-camera",
    "magnetometer": "magnetometer",
    "navsat": "navsat",
}
"""Name of the system ``gz-sim-NAME-system`` that generates the data of a sensor type."""


@rule(
    INFO,
    on=("gz",),
    default=False,
    effects={
        "gz": "keeps the sensor, without a system",
    },
)
def sensor_needs_world_system(robot: Robot) -> Iterator[Problem]:
    """A sensor requires a system of the world.

    In new Gazebo, systems of the world generate sensor data: ``sensors`` renders cameras and laser
    scanners, and ``imu``, ``navsat`` and ``forcetorque`` are separate systems. Without the system
    there is no data and no message. The robot does not contain the systems of the world, so this is
    a reminder. One finding lists all systems.
    """
    loaded = [plugin.filename for block in robot.gazebo for plugin in block.plugins]
    found: dict[str, Sensor] = {}
    for sensor in robot.sensors:
        system = _SYSTEM_OF.get(sensor.type)
        if system is not None and not any(f"-{system}-system" in name for name in loaded):
            found.setdefault(system, sensor)
    if found:
        systems = ", ".join(f"gz-sim-{system}-system" for system in sorted(found))
        first = next(iter(found.values()))
        yield Problem(
            first.element,
            f"sensor '{first.name}' has data only in a world that loads {systems}",
            data={"systems": [f"gz-sim-{system}-system" for system in sorted(found)]},
        )
