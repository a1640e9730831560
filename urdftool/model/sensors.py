"""Sensors and cameras, as SDF and the ``<gazebo>`` blocks of URDF write them, as tables.

A sensor has a type, a place on a link or joint, and settings by name. ``KINDS`` has one row for a
type: other names of it, and the sensors of MJCF that measure the same. ``SETTINGS`` has one row for
a setting whose name, unit or default is known; another element of a sensor is a setting that has
its path as its name. A new type or setting is a new row.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from ..source.document import Element
from .gazebo_plugins import SENSOR_PLUGINS, BodySensor, get_library
from .mechanism import Camera, MountedSensor
from .numbers import number, parse_numbers
from .pose import IDENTITY, Pose, get_origin_at, rotation_from_quaternion, rotation_from_rpy
from .settings import (
    BAD_ELEMENT,
    Content,
    Rejected,
    Setting,
    Settings,
    Value,
    add_kinds,
    find_required,
    get_number,
    get_text,
    parse,
)

if TYPE_CHECKING:
    from .provenance import Provenance


class SensorKind(NamedTuple):
    """A row of the table of types.

    Attributes:
        type: Type in gz.
        others: The same type in Gazebo Classic and in older files.
        section: Element with its settings, as gz names it.
        mjcf: Sensors of MJCF that measure the same, with the suffixes of their names.
        older: Other names of ``section``.
    """

    type: str
    others: tuple[str, ...] = ()
    section: str = ""
    mjcf: tuple[tuple[str, str], ...] = ()
    older: tuple[str, ...] = ()


_IMU = (("accelerometer", "_accelerometer"), ("gyro", "_gyro"), ("framequat", "_orientation"))
_POSITION = (("framepos", ""),)

KINDS = (
    SensorKind("imu", (), "imu", _IMU),
    SensorKind("force_torque", (), "force_torque", (("force", "_force"), ("torque", "_torque"))),
    SensorKind("navsat", ("gps",), "navsat", _POSITION, ("gps",)),
    SensorKind("altimeter", (), "altimeter", _POSITION),
    SensorKind("magnetometer", (), "magnetometer", (("magnetometer", ""),)),
    SensorKind("contact", (), "contact", (("touch", ""),)),
    SensorKind("lidar", ("ray",), "lidar", (("rangefinder", ""),), ("ray",)),
    SensorKind("gpu_lidar", ("gpu_ray",), "lidar", (("rangefinder", ""),), ("ray",)),
    SensorKind("camera", ("multicamera",), "camera"),
    SensorKind("depth_camera", ("depth",), "camera"),
    SensorKind("rgbd_camera", ("rgbd", "openni_kinect"), "camera"),
    SensorKind("thermal_camera", ("thermal",), "camera"),
    SensorKind("wide_angle_camera", ("wideanglecamera",), "camera"),
    SensorKind("segmentation_camera", ("segmentation",), "camera"),
    SensorKind("boundingbox_camera", ("boundingbox",), "camera"),
    SensorKind("logical_camera", (), "logical_camera"),
    SensorKind("air_pressure", (), "air_pressure"),
    SensorKind("air_speed", (), "air_speed"),
)
"""Types of sensors."""

_KIND_OF = {name: kind for kind in KINDS for name in (kind.type, *kind.others)}

SETTINGS = add_kinds("sensor", (
    Setting("rate", "Hz", "update_rate", 0.0),
    Setting("topic", "", "topic", ""),
    Setting("frame", "", "gz_frame_id", "", kind="text"),
    Setting("always on", "", "always_on", False),
    Setting("visualize", "", "visualize", False),
    Setting("metrics", "", "enable_metrics", False),
    Setting("field of view", "rad", "camera/horizontal_fov", 1.047, mjcf="fovy"),
    Setting("image width", "pixels", "camera/image/width", 320.0, mjcf="resolution"),
    Setting("image height", "pixels", "camera/image/height", 240.0,
            mjcf="resolution", kind="count"),
    Setting("image format", "", "camera/image/format", "R8G8B8"),
    Setting("near", "m", "camera/clip/near", 0.1),
    Setting("far", "m", "camera/clip/far", 100.0),
    Setting("samples", "", "lidar/scan/horizontal/samples", 640.0),
    Setting("resolution", "", "lidar/scan/horizontal/resolution", 1.0),
    Setting("minimum angle", "rad", "lidar/scan/horizontal/min_angle", 0.0),
    Setting("maximum angle", "rad", "lidar/scan/horizontal/max_angle", 0.0),
    Setting("vertical samples", "", "lidar/scan/vertical/samples", 1.0),
    Setting("vertical resolution", "", "lidar/scan/vertical/resolution", 1.0),
    Setting("vertical minimum angle", "rad", "lidar/scan/vertical/min_angle", 0.0),
    Setting("vertical maximum angle", "rad", "lidar/scan/vertical/max_angle", 0.0),
    Setting("minimum range", "m", "lidar/range/min", 0.0),
    Setting("maximum range", "m", "lidar/range/max", 0.0),
    Setting("range resolution", "m", "lidar/range/resolution", 0.0),
    Setting("measured frame", "", "force_torque/frame", "child"),
    Setting("direction", "", "force_torque/measure_direction", "child_to_parent"),
    Setting("collision", "", "contact/collision", ""),
))  # fmt: skip
"""Settings of sensors, by their path in SDF."""

MAX_RAYS = 36
"""Largest number of rays of a lidar that rangefinders of MJCF stand for; chosen, no source."""

_ENDINGS: dict[str, float | str] = {
    **dict.fromkeys(("mean", "stddev", "bias_mean", "bias_stddev", "precision"), 0.0),
    **dict.fromkeys(("dynamic_bias_stddev", "dynamic_bias_correlation_time"), 0.0),
    "type": "none",
}
"""Defaults of the elements of a ``<noise>``, by their tag; its type is an attribute."""

_NAMED = {row.name: row for row in SETTINGS}
_ROWS = {
    **{row.path: row for row in SETTINGS},
    **dict.fromkeys(("frame_id", "ignition_frame_id", "camera/optical_frame_id"), _NAMED["frame"]),
}
_IMU_NOISE = {"rate": "angular_velocity", "accel": "linear_acceleration"}
_DEFAULT_TOPIC = "__default__"


def get_kind(type_: str) -> SensorKind:
    """Return the row of a type; a row without counterparts for an unknown one."""
    return _KIND_OF.get(type_) or SensorKind(type_, (), type_)


def get_sensor_row(name: str) -> Setting:
    """Return the row of a setting by its name; for another element, a row with its path."""
    row = _NAMED.get(name)
    if row is not None:
        return row
    head, _, tag = name.rpartition("/")
    default: Content = _ENDINGS.get(tag, "") if head.endswith("noise") else ""
    return Setting(name, "", name, default, kind="number" if default == 0.0 else "text")


def read_sensor(
    element: Element,
    pose: Pose,
    *,
    link: str = "",
    joint: str = "",
    provenance: Provenance | None = None,
    rejected: list[Rejected] | None = None,
) -> Iterator[Camera | MountedSensor]:
    """Yield the cameras of a ``<sensor>``, or the sensor.

    ``rejected`` receives the settings whose text is not a value.
    """
    name, type_ = element.get("name") or "", (element.get("type") or "").strip()
    plugins = list(element.list_children("plugin"))
    type_ = next((t for p in plugins if (t := get_plugin_type(p))), type_)
    known = provenance or element
    cameras = list(element.list_children("camera"))
    reading = _Reading(name, [] if rejected is None else rejected)
    for child in element.children:
        if child.tag not in ("pose", "plugin", "camera"):
            reading.add(child, "", get_kind(type_))
    for plugin in plugins:
        reading.add_plugin(plugin)
    if not cameras or get_kind(type_).section != "camera":
        for camera in cameras:
            reading.add(camera, "", get_kind(type_))
        at = get_origin_at(pose, known)
        yield MountedSensor(known, name, type_, link, joint, at, reading.values)
        return
    for number_, camera in enumerate(cameras):
        own = _Reading(name, reading.rejected, dict(reading.values))
        own.add(camera, "", get_kind(type_))
        several = len(cameras) > 1
        yield _make_camera(
            f"{name}_{camera.get('name') or number_}" if several else name,
            type_,
            link,
            pose @ read_sensor_pose(camera)[0],
            own.values,
            known,
        )


def _make_camera(
    name: str, type_: str, link: str, pose: Pose, settings: Settings, provenance: Provenance
) -> Camera:
    """Return a camera whose field of view is vertical, as that of MJCF."""
    names = ("field of view", "image width", "image height")
    across, width, height = (get_number(settings, name) for name in names)
    across = 1.047 if across is None else across
    width, height = width or 320.0, height or 240.0
    vertical = None
    if 0 < across < math.pi:
        vertical = 2 * math.atan(math.tan(across / 2) * height / width)
    origin = get_origin_at(pose, provenance)
    size = int(width), int(height)
    return Camera(provenance, name, link, origin, vertical, size, type_, settings)


def read_sensor_pose(element: Element) -> tuple[Pose, str]:
    """Return the ``<pose>`` of an element and the frame that it names; what is invalid is zero."""
    child = element.find_child("pose")
    if child is None:
        return IDENTITY, ""
    frame = child.get("relative_to") or child.get("frame") or ""
    if child.get("rotation_format") == "quat_xyzw":
        seven = parse_numbers(child.text, 7)
        if seven is None or not any(seven[3:]):
            return IDENTITY, frame
        x, y, z, a, b, c, d = seven
        return Pose(rotation_from_quaternion((d, a, b, c)), (x, y, z)), frame
    x, y, z, roll, pitch, yaw = parse_numbers(child.text, 6) or (0.0,) * 6
    if (child.get("degrees") or "").lower() in ("true", "1"):
        roll, pitch, yaw = map(math.radians, (roll, pitch, yaw))
    return Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z)), frame


class _Reading:
    """Settings of one sensor while they are read."""

    def __init__(self, name: str, rejected: list[Rejected], values: Settings | None = None) -> None:
        self.name = name
        self.rejected = rejected
        self.values: Settings = {} if values is None else values

    def add(self, element: Element, above: str, kind: SensorKind) -> None:
        """Take the values of an element and of those in it."""
        tag = kind.section if not above and element.tag in kind.older else element.tag
        path = f"{above}/{tag}" if above else tag
        if path == "imu/noise":
            self._add_old_noise(element)
            return
        if tag in ("pose", "plugin"):
            return
        if tag == "noise" and element.get("type"):
            self.put(f"{path}/type", element, element.get("type") or "")
        for child in element.children:
            self.add(child, path, kind)
        if not element.children:
            self.put(path, element, get_text(element))

    def _add_old_noise(self, noise: Element) -> None:
        """Take the noise of an IMU before SDF 1.5, which is that of each axis."""
        kind = noise.find_child("type")
        text = "gaussian" if kind is None else kind.text.strip()
        for old, new in _IMU_NOISE.items():
            holder = noise.find_child(old)
            for axis in "xyz" if holder is not None else "":
                self.put(f"imu/{new}/{axis}/noise/type", noise, text)
                for child in holder.children if holder is not None else ():
                    self.put(f"imu/{new}/{axis}/noise/{child.tag}", child, child.text.strip())

    def put(self, path: str, element: Element, text: str) -> None:
        """Set a value, the first of several; a later one has a number in its name."""
        row = _ROWS.get(path) or get_sensor_row(path)
        above = "sensor" if element.parent is None else element.parent.tag
        content, required = parse(row.kind, text), find_required(row, text, element, above)
        if content is None or required:
            part = "sensor", self.name
            self.rejected.append(Rejected(element, BAD_ELEMENT, *part, element.tag, text, required))
            return
        name, count = row.name, 1
        while name in self.values:
            count += 1
            name = f"{row.name} {count}"
        if content != _DEFAULT_TOPIC:
            self.values[name] = Value(element, content)

    def add_plugin(self, plugin: Element) -> None:
        """Take topic, rate and frame from a plugin that publishes the data of the sensor."""
        known = SENSOR_PLUGINS.get(get_library(plugin))
        if known is None:
            return
        texts = {child.tag: child.text.strip() for child in plugin.children if child.text.strip()}
        rate = texts.get("updateRate") or texts.get("update_rate") or ""
        frame = next((texts[tag] for tag in known.frame if tag in texts), "")
        rows = (("topic", get_topic(plugin)), ("rate", rate if number(rate) else ""))
        for name, text in (*rows, ("frame", frame)):
            if text and name not in self.values:
                content = parse(get_sensor_row(name).kind, text)
                if content is not None:
                    self.values[name] = Value(plugin, content)


def get_plugin_type(plugin: Element) -> str:
    """Return the type that a plugin makes of its sensor; empty if it keeps it."""
    known = SENSOR_PLUGINS.get(get_library(plugin))
    return "" if known is None else known.type


def get_topic(plugin: Element) -> str:
    """Return the topic that a plugin publishes, from its parameters or a remapping."""
    settings = {child.tag: child.text.strip() for child in plugin.children if child.text.strip()}
    namespace, topic = settings.get("robotNamespace", ""), ""
    ros = plugin.find_child("ros")
    if ros is not None:
        inner = ros.find_child("namespace")
        namespace = inner.text.strip() if inner is not None else namespace
        for remapping in ros.list_children("remapping"):
            _, arrow, new = remapping.text.strip().partition(":=")
            if arrow and not topic:
                topic = new
    if not topic:
        topic = settings.get("topicName") or settings.get("imageTopicName") or ""
        camera = settings.get("cameraName") or settings.get("camera_name") or ""
        if camera and not topic.startswith("/"):
            topic = f"{camera}/{topic or 'image_raw'}"
        topic = topic or settings.get("bumperTopicName") or settings.get("topic_name") or ""
    if topic and namespace.strip("/") and not topic.startswith("/"):
        topic = f"{namespace.rstrip('/')}/{topic}"
    return topic


def read_body_sensor(plugin: Element, kind: BodySensor) -> MountedSensor:
    """Return the sensor of a plugin that measures a link or joint itself, without its place."""
    reading = _Reading(plugin.get("name") or "", [])
    reading.add_plugin(plugin)
    reading.values["always on"] = Value(plugin, True)
    for table, word in ((kind.noises, "stddev"), (kind.offsets, "mean")):
        for parameter, places in table.items():
            child = plugin.find_child(parameter)
            if child is not None:
                _add_noise(reading, child, places, word)
    six: list[float] = []
    for way in ("xyz", "rpy"):
        offset = plugin.find_child(f"{way}Offset") or plugin.find_child(f"{way}_offset")
        six += (parse_numbers(offset.text, 3) if offset is not None else None) or (0.0, 0.0, 0.0)
    x, y, z, roll, pitch, yaw = six
    origin = get_origin_at(Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z)), plugin)
    name = plugin.get("name") or get_library(plugin)
    return MountedSensor(plugin, name, kind.type, origin=origin, settings=reading.values)


def _add_noise(reading: _Reading, child: Element, places: tuple[str, ...], word: str) -> None:
    """Set a noise at each place; a vector of three sets one component for each axis."""
    single = number(child.text)
    values = parse_numbers(child.text, 3) if single is None else (single,) * 3
    if values is None or not any(values):
        return
    for index, place in enumerate(places):
        reading.values[f"{place}/noise/type"] = Value(child, "gaussian")
        reading.values[f"{place}/noise/{word}"] = Value(child, values[index % 3])
