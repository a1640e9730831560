"""Sensors of Gazebo and ros2_control: cameras in bodies, and sensors at sites."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from lxml import etree

from ...model.elements import ControlComponent, Robot, Sensor
from ...model.pose import Pose, rotation_from_quaternion, rotation_from_rpy
from ...model.read import number, parse_numbers
from ...source.document import Element
from ..common.naming import UniqueNames
from ..written import Written
from .body import Bodies
from .digits import format_numbers_text, number_text
from .frame import set_pose
from .joint import SITE

MAX_RAYS = 36
"""Maximum number of rays of a scanner that becomes rangefinders."""

CAMERA_TURN = Pose(rotation_from_quaternion((0.5, 0.5, -0.5, -0.5)))
"""Rotation from Gazebo's camera (x forward, z up) to MuJoCo's (-z forward, y up)."""

# type -> sensors at its site, with their name suffixes
AT_SITE: dict[str, tuple[tuple[str, str], ...]] = {
    "imu": (("accelerometer", "_accelerometer"), ("gyro", "_gyro"), ("framequat", "_orientation")),
    "force_torque": (("force", "_force"), ("torque", "_torque")),
    "gps": (("framepos", ""),),
    "navsat": (("framepos", ""),),
    "altimeter": (("framepos", ""),),
    "magnetometer": (("magnetometer", ""),),
}

CAMERAS = ("camera", "depth", "depth_camera", "rgbd_camera", "openni_kinect", "multicamera")
SCANNERS = ("ray", "gpu_ray", "lidar", "gpu_lidar", "sonar")


def build_sensor_section(robot: Robot, bodies: Bodies, written: Written) -> etree._Element | None:
    """Build ``<sensor>``, or return None if it is empty; add sites and cameras to the bodies."""
    section = etree.Element("sensor")
    there = (site.get("name", "") for body in bodies.values() for site in body.iterchildren("site"))
    sites, cameras, taken = UniqueNames(there), UniqueNames(), UniqueNames()
    for block in robot.gazebo:
        link = _link_of(robot, block.reference)
        for sensor in block.sensors:
            if link is None:
                _report_sensor_loss(sensor, "it is not on a link", written)
                continue
            body = bodies[link]
            if sensor.type in CAMERAS:
                for camera in sensor.element.list_children("camera"):
                    _add_camera(sensor, camera, body, cameras, written)
            elif sensor.type in AT_SITE:
                site = _format_site(
                    sensor.name or f"{link}_{sensor.type}", _read_pose(sensor.element), body, sites
                )
                _measure(section, sensor.name or link, AT_SITE[sensor.type], site, taken)
            elif sensor.type == "contact":
                _add_touch(sensor, link, body, section, sites, taken, written)
            elif sensor.type in SCANNERS:
                _add_scanner(sensor, link, body, section, sites, taken, written)
            else:
                _report_sensor_loss(
                    sensor, f"MuJoCo has no sensor of type '{sensor.type}'", written
                )
    for control in robot.ros2_controls:
        for component in control.components:
            if component.kind == "sensor":
                _add_control_sensor(component, robot, bodies, section, sites, taken, written)
    return section if len(section) else None


def _link_of(robot: Robot, reference: str | None) -> str | None:
    """Return the link of a sensor; for a joint reference, its child."""
    if reference is None:
        return None
    if reference in robot.link:
        return reference
    joint = robot.joint.get(reference)
    return joint.child if joint is not None and joint.child in robot.link else None


def _read_pose(element: Element) -> Pose:
    """Read Gazebo's ``<pose>``: x y z [m] and roll pitch yaw [rad]."""
    child = element.find_child("pose")
    values = parse_numbers(child.text, 6) if child is not None else None
    if values is None:
        return Pose()
    return Pose(
        rotation_from_rpy((values[3], values[4], values[5])), (values[0], values[1], values[2])
    )


def _format_site(name: str, pose: Pose, body: etree._Element, sites: UniqueNames) -> str:
    element = etree.Element("site", {"name": sites.take(name), **SITE})
    set_pose(element, pose)
    put_before_bodies(body, element)
    return element.get("name", "")


def put_before_bodies(body: etree._Element, element: etree._Element) -> None:
    """Insert a site or camera before the child bodies."""
    first = body.find("body")
    body.insert(len(body) if first is None else body.index(first), element)


def _measure(
    section: etree._Element,
    name: str,
    kinds: tuple[tuple[str, str], ...],
    site: str,
    taken: UniqueNames,
) -> None:
    for kind, suffix in kinds:
        section.append(create_site_sensor(kind, taken.take(name + suffix), site))


def create_site_sensor(kind: str, name: str, site: str) -> etree._Element:
    """Create a sensor at a site."""
    element = etree.Element(kind, name=name)
    if kind.startswith("frame"):
        element.set("objtype", "site")
        element.set("objname", site)
    else:
        element.set("site", site)
    return element


def _add_camera(
    sensor: Sensor, camera: Element, body: etree._Element, cameras: UniqueNames, written: Written
) -> None:
    image, fov = camera.find_child("image"), camera.find_child("horizontal_fov")
    horizontal = (number(fov.text) if fov is not None else None) or 1.047
    width, height = (
        _get_whole(image, name, size) for name, size in (("width", 320), ("height", 240))
    )
    if not 0 < horizontal < math.pi:
        written.report_loss(
            "camera",
            f"camera '{sensor.name}' sees {horizontal:g} rad wide, which no flat image shows; "
            "it sees 2.8 rad",
            sensor.place,
            kind="sensor",
            name=sensor.name,
        )
        horizontal = 2.8
    vertical = 2 * math.atan(math.tan(horizontal / 2) * height / width)
    name = cameras.take(sensor.name or "camera", f"{sensor.name}_{camera.get('name') or ''}")
    element = etree.Element("camera", name=name, fovy=number_text(math.degrees(vertical)))
    element.set("resolution", f"{width} {height}")
    set_pose(element, _read_pose(sensor.element) @ _read_pose(camera) @ CAMERA_TURN)
    put_before_bodies(body, element)


def _get_whole(image: Element | None, name: str, default: int) -> int:
    child = image.find_child(name) if image is not None else None
    value = number(child.text) if child is not None else None
    return int(value) if value is not None and value >= 1 else default


def _add_touch(
    sensor: Sensor,
    link: str,
    body: etree._Element,
    section: etree._Element,
    sites: UniqueNames,
    taken: UniqueNames,
    written: Written,
) -> None:
    """Add a touch sensor in a site that covers the first primitive collision geom of a link."""
    name = sensor.name or f"{link}_contact"
    geoms = [g for g in body.iterchildren("geom") if g.get("class") == "collision"]
    sized = [g for g in geoms if g.get("size")]
    if not sized:
        _report_sensor_loss(
            sensor, "its link has no primitive collision that a site can cover", written
        )
        return
    own = sites.take(name)
    size = (float(part) for part in sized[0].get("size", "").split())
    site = etree.Element("site", name=own, type=sized[0].get("type", ""), group="5")
    site.set("size", format_numbers_text(1.01 * part for part in size))
    for attribute in ("pos", "quat"):
        if attribute in sized[0].attrib:
            site.set(attribute, sized[0].get(attribute, ""))
    put_before_bodies(body, site)
    etree.SubElement(section, "touch", name=taken.take(name), site=own)
    if len(geoms) > 1:
        _report_sensor_loss(sensor, "only the first collision of its link is covered", written)


def _add_scanner(
    sensor: Sensor,
    link: str,
    body: etree._Element,
    section: etree._Element,
    sites: UniqueNames,
    taken: UniqueNames,
    written: Written,
) -> None:
    """Add one rangefinder for each ray, along the z axis of a site."""
    name = sensor.name or f"{link}_scan"
    scan = next((e for e in sensor.element.walk() if e.tag == "horizontal"), None)
    read: Callable[[str, float], float] = lambda tag, default: _compute_value(scan, tag, default)  # noqa: E731
    count = int(read("samples", 0))
    pose = _read_pose(sensor.element)
    if not 0 < count <= MAX_RAYS:
        _format_site(name, pose, body, sites)
        _report_sensor_loss(
            sensor,
            f"its {count} rays are too many for rangefinders; only its site is exported",
            written,
        )
        return
    low, high = read("min_angle", 0.0), read("max_angle", 0.0)
    for index in range(count):
        angle = low + (high - low) * index / max(count - 1, 1)
        ray = (
            pose
            @ Pose(rotation_from_rpy((0.0, 0.0, angle)))
            @ Pose(rotation_from_rpy((0.0, math.pi / 2, 0.0)))
        )
        site = _format_site(f"{name}_{index}", ray, body, sites)
        etree.SubElement(section, "rangefinder", name=taken.take(f"{name}_{index}"), site=site)


def _compute_value(scan: Element | None, tag: str, default: float) -> float:
    child = scan.find_child(tag) if scan is not None else None
    value = number(child.text) if child is not None else None
    return default if value is None else value


def _add_control_sensor(
    component: ControlComponent,
    robot: Robot,
    bodies: Bodies,
    section: etree._Element,
    sites: UniqueNames,
    taken: UniqueNames,
    written: Written,
) -> None:
    """Add a ros2_control sensor, by its state interfaces and its ``frame_id``."""
    names = {interface.name.partition(".")[0] for interface in component.state_interfaces}
    kinds = list(_list_control_kinds(names))
    frame = component.params.get("frame_id", "")
    if frame not in robot.link or not kinds:
        why = "its frame_id names no link" if kinds else "MuJoCo has no sensors for its interfaces"
        written.report_loss(
            "sensor",
            f"sensor '{component.name}' of ros2_control is not exported: {why}",
            component.place,
            kind="sensor",
            name=component.name,
        )
        return
    site = _format_site(component.name, Pose(), bodies[frame], sites)
    _measure(section, component.name, tuple(kinds), site, taken)


def _list_control_kinds(interfaces: set[str]) -> Iterator[tuple[str, str]]:
    for interface, kind, suffix in (
        ("force", "force", "_force"),
        ("torque", "torque", "_torque"),
        ("linear_acceleration", "accelerometer", "_accelerometer"),
        ("angular_velocity", "gyro", "_gyro"),
        ("orientation", "framequat", "_orientation"),
    ):
        if interface in interfaces:
            yield kind, suffix


def _report_sensor_loss(sensor: Sensor, why: str, written: Written) -> None:
    written.report_loss(
        "sensor",
        f"sensor '{sensor.name}' is not exported completely: {why}",
        sensor.place,
        kind="sensor",
        name=sensor.name,
    )
