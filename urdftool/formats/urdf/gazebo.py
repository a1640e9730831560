"""Elements ``<gazebo>`` of an export to URDF: sensors, cameras and springs."""

from __future__ import annotations

import math
from collections.abc import Sequence

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Origin
from ...model.mechanism import Camera, MountedSensor
from ...model.numbers import format_pose_text, number_text
from ...model.pose import IDENTITY, Pose, get_origin_at, make_pose
from ...model.provenance import Written as Source
from ...model.world import WORLD
from ...source.document import Element
from ..common.naming import UniqueNames
from .control import is_joint_state
from .translation import Translation, add, add_origin, get_rpy

NOT_COPIED = ("link", "joint", "material", "mujoco")
"""Elements that the export writes itself; <mujoco> names folders of meshes of its source."""

_IMU = ("gyro", "accelerometer")
_FORCE = ("force", "torque")
_RESOLUTION = (640, 480)
"""Width and height [pixels] of a camera for which the source has none."""

_OPTICAL = Pose(((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0)))
"""Axes of an optical frame (z forward, y down) in a camera that looks along x with z up."""


def copy_extensions(t: Translation) -> None:
    """Copy the elements for simulators and controllers of a URDF source, and unknown ones."""
    source = t.robot.xml
    for element in () if source is None else source.children:
        if element.tag not in NOT_COPIED:
            copy_element(t.root, element)


def _find_namespace(element: Element, prefix: str) -> str | None:
    """Return what the nearest ``xmlns:prefix`` names; None without one."""
    holder: Element | None = element
    while holder is not None:
        if found := holder.get(f"xmlns:{prefix}"):
            return found
        holder = holder.parent
    return None


def copy_element(parent: etree._Element, element: Element) -> etree._Element:
    """Append a copy of an element; a prefix without a namespace becomes a part of the name."""
    prefix, colon, name = element.tag.partition(":")
    uri = _find_namespace(element, prefix) if colon else None
    tag = element.tag.replace(":", "_") if uri is None else f"{{{uri}}}{name}"
    attributes = {n: v for n, v in element.attributes.items() if ":" not in n and n != "xmlns"}
    node = etree.SubElement(parent, tag, attributes, {prefix: uri} if uri else None)
    node.text = element.text.strip() or None
    for child in element.children:
        copy_element(node, child)
    return node


def add_cameras(t: Translation) -> None:
    """Add a sensor and an optical frame for each camera."""
    names = UniqueNames()
    for camera in t.robot.cameras:
        name = names.take(camera.name or f"{camera.link}_camera")
        frame = _add_optical_frame(t, camera, name)
        if camera.link == WORLD:
            text = (
                f"camera is dropped, since Gazebo has no sensors on link 'world': '{camera.name}'"
            )
            t.written.report_loss("sensor", text, camera.place, kind="sensor", name=camera.name)
            continue
        node = add(t.root, "gazebo", reference=t.names.links[camera.link])
        source = _get_sdf(camera)
        if source is None:
            _add_camera(t, node, camera, name, frame)
            continue
        sensor = _copy_sensor(node, source, camera.origin, name)
        inner = sensor.find("camera")
        if inner is None:
            continue
        for pose in inner.findall("pose"):
            inner.remove(pose)
        if frame and inner.find("optical_frame_id") is None:
            add(inner, "optical_frame_id", frame)
            text = f"camera '{camera.name}' gets the optical frame '{frame}', which ROS expects"
            t.written.report_loss(
                "optical-frame", text, camera.place,
                kind="camera", name=camera.name, severity=Severity.INFO,
            )  # fmt: skip


def _add_optical_frame(t: Translation, camera: Camera, name: str) -> str:
    """Add a link for the optical frame, and return its name; empty without frames."""
    if not t.options.frames:
        return ""
    frame = t.names.taken_links.take(f"{name}_optical_frame".replace("::", "_"))
    add(t.root, "link", name=frame)
    node = add(t.root, "joint", name=t.names.taken_joints.take(f"{frame}_fixed"), type="fixed")
    add(node, "parent", link=t.names.links[camera.link])
    add(node, "child", link=frame)
    add_origin(node, get_origin_at(make_pose(camera.origin) @ _OPTICAL))
    return frame


def _add_camera(
    t: Translation, node: etree._Element, camera: Camera, name: str, frame: str
) -> None:
    """Add the sensor of a camera of MJCF."""
    width, height = camera.resolution or _RESOLUTION
    if camera.resolution is None:
        text = f"cameras have no resolution; {width} x {height} pixels are written"
        t.written.report_loss(
            "camera-default", f"{text}: '{name}'", camera.place,
            kind="link", name=camera.link, severity=Severity.INFO,
        )  # fmt: skip
    sensor = add(node, "sensor", name=name, type="camera")
    _add_pose(sensor, camera.origin)
    inner = add(sensor, "camera")
    if camera.vertical_fov is not None:
        across = 2 * math.atan(math.tan(camera.vertical_fov / 2) * width / height)
        add(inner, "horizontal_fov", number_text(across))
    image = add(inner, "image")
    add(image, "width", str(width))
    add(image, "height", str(height))
    if frame:
        add(inner, "optical_frame_id", frame)


def add_sensors(t: Translation) -> None:
    """Add the sensors of links and joints; report those that Gazebo does not have."""
    names = UniqueNames()
    for camera in t.robot.cameras:
        names.take(camera.name or f"{camera.link}_camera")
    groups: dict[tuple[str, str, str], list[MountedSensor]] = {}
    for sensor in t.robot.mounted_sensors:
        element = _get_sdf(sensor)
        if sensor.link == WORLD:
            _report(t, sensor, "is on link 'world', which Gazebo does not read")
        elif element is not None:
            _add_sdf_sensor(t, sensor, element, names)
        elif is_joint_state(sensor):
            if not (t.options.hardware and t.robot.joint_actuators):
                _report(t, sensor, "requires <ros2_control>")
        else:
            groups.setdefault(_get_group(sensor), []).append(sensor)
    for (kind, link, _), members in groups.items():
        if not link or kind not in ("imu", "force_torque", "magnetometer"):
            _report_all(t, members)
        elif kind == "force_torque":
            _add_force_sensor(t, members, names)
        else:
            _add_sensor(t, members, kind, names)


def _get_group(sensor: MountedSensor) -> tuple[str, str, str]:
    """Return type, link and pose of the sensor that stands for sensors of MJCF."""
    kind = {**dict.fromkeys(_IMU, "imu"), **dict.fromkeys(_FORCE, "force_torque")}
    return kind.get(sensor.type, sensor.type), sensor.link, repr(make_pose(sensor.origin))


def _report_all(t: Translation, sensors: Sequence[MountedSensor]) -> None:
    for sensor in sensors:
        _report(t, sensor, "has no counterpart in Gazebo")


def _report(t: Translation, sensor: MountedSensor, why: str) -> None:
    text = f"{sensor.type} sensor is dropped, since it {why}: '{sensor.name}'"
    name = sensor.name or sensor.joint or sensor.link
    t.written.report_loss("sensor", text, sensor.place, kind="sensor", name=name)


def _add_sdf_sensor(
    t: Translation, sensor: MountedSensor, element: Element, names: UniqueNames
) -> None:
    if sensor.type == "contact":
        _report(t, sensor, "names a <collision>, which has another name in Gazebo")
        return
    known = t.names.joints if sensor.joint else t.names.links
    reference = known.get(sensor.joint or sensor.link)
    if reference is None:
        _report(t, sensor, "is on a part that is not in the robot")
        return
    node = add(t.root, "gazebo", reference=reference)
    if sensor.joint and t.robot.joint[sensor.joint].is_fixed:
        add(node, "preserveFixedJoint", "true")
    _copy_sensor(node, element, sensor.origin, names.take(sensor.name or sensor.type))


def _copy_sensor(
    node: etree._Element, element: Element, origin: Origin | None, name: str
) -> etree._Element:
    """Copy a sensor of SDF, with another name and pose."""
    sensor = copy_element(node, element)
    sensor.set("name", name)
    for pose in sensor.findall("pose") if origin is not None else ():
        sensor.remove(pose)
    _add_pose(sensor, origin)
    return sensor


def _add_sensor(
    t: Translation, members: Sequence[MountedSensor], kind: str, names: UniqueNames
) -> None:
    """Add a sensor of a link in place of sensors of MJCF at the same pose."""
    first = members[0]
    node = add(t.root, "gazebo", reference=t.names.links[first.link])
    sensor = add(node, "sensor", name=names.take(_join(members) or kind), type=kind)
    _add_pose(sensor, first.origin)


def _add_force_sensor(t: Translation, members: Sequence[MountedSensor], names: UniqueNames) -> None:
    """Add a sensor of the force between a link and its parent, which acts at the parent."""
    first = members[0]
    joint = next((j for j in t.robot.joints if j.child == first.link), None)
    if joint is None or joint.name not in t.names.joints or joint.type in ("ball", "spherical"):
        for sensor in members:
            _report(t, sensor, "is not on a link with one joint to its parent")
        return
    node = add(t.root, "gazebo", reference=t.names.joints[joint.name])
    if joint.is_fixed:
        add(node, "preserveFixedJoint", "true")
    name = names.take(_join(members) or "force")
    inner = add(node, "sensor", name=name, type="force_torque")
    _add_pose(inner, first.origin)
    settings = add(inner, "force_torque")
    add(settings, "frame", "sensor")
    add(settings, "measure_direction", "child_to_parent")


def _join(members: Sequence[MountedSensor]) -> str:
    return "_".join(dict.fromkeys(sensor.name for sensor in members if sensor.name))


def _add_pose(sensor: etree._Element, origin: Origin | None) -> None:
    if origin is None or make_pose(origin) == IDENTITY:
        return
    pose = etree.Element("pose")
    pose.text = format_pose_text((*origin.xyz, *get_rpy(origin)))
    sensor.insert(0, pose)


def _get_sdf(part: Camera | MountedSensor) -> Element | None:
    """Return the element of SDF from which a part was read."""
    return part.provenance.element if isinstance(part.provenance, Source) else None
