"""Sensors and cameras: what MuJoCo has for those of a robot, and their elements.

MuJoCo has one sensor for each measured quantity, at a site or joint; ``model/sensors.py: KINDS``
says which. A planned sensor has the type of MuJoCo and the name of its site, which is a frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Link, Robot
from ...model.mechanism import Camera, Frame, MountedSensor
from ...model.pose import IDENTITY, Pose, get_origin_at, make_pose, rotation_from_rpy
from ...model.sensors import KINDS, MAX_RAYS, get_kind, get_sensor_row
from ...model.settings import get_number
from ..common.naming import UniqueNames
from ..common.shape_box import get_shape_size
from ..written import Written
from .copied import has_copies
from .structure import Structure

WIDEST = 2.8
"""Horizontal field of view [rad] of a camera that sees more than a flat image shows; chosen, no
source."""

CAMERA_SIZE = (320, 240)
"""Width and height [pixels] that SDF's specification gives an image."""

BASE_KINDS = (
    ("framelinvel", "_linear_velocity"),
    ("gyro", "_gyro"),
    ("accelerometer", "_accelerometer"),
    ("framequat", "_orientation"),
)
"""Sensors of a floating base that control policies read, with the suffixes of their names."""

_SUFFIX_OF = {tag: suffix for kind in KINDS for tag, suffix in kind.mjcf}


_EXPRESSED = (
    *("samples", "minimum angle", "maximum angle", "measured frame", "direction", "collision"),
    *("visualize", "metrics"),
)
"""Parameters that a sensor's type, site or number of rays expresses, or that change no value."""


def _compute_ratio(size: tuple[int, int] | None) -> float:
    """Return height over width of an image; 1 for one without a size."""
    return 1.0 if size is None else size[1] / size[0]


@dataclass
class SensorPlan:
    """Sensors of a model.

    Attributes:
        sensors: Sensors of MuJoCo's types.
        frames: Their sites.
        cameras: Cameras.
    """

    sensors: list[MountedSensor] = field(default_factory=list)
    frames: list[Frame] = field(default_factory=list)
    cameras: list[Camera] = field(default_factory=list)


class _Planner:
    """Sensors while they are chosen; names are unique."""

    def __init__(self, robot: Robot, taken: list[Frame], written: Written) -> None:
        self.robot = robot
        self.written = written
        self.plan = SensorPlan(frames=list(taken))
        self._sites = UniqueNames(frame.name for frame in taken)
        self._names = UniqueNames()
        self._cameras = UniqueNames()

    def add_site(self, name: str, link: str, pose: Pose) -> Frame:
        """Add a site."""
        frame = Frame(None, self._sites.take(name), link, "site", get_origin_at(pose))
        self.plan.frames.append(frame)
        return frame

    def add(self, source: MountedSensor | None, tag: str, name: str, site: Frame) -> None:
        """Add a sensor at a site."""
        place = None if source is None else source.provenance
        own = self._names.take(name)
        self.plan.sensors.append(
            MountedSensor(place, own, tag, site.link, "", site.origin, site=site.name)
        )

    def add_camera(self, camera: Camera) -> None:
        """Add a camera; one that sees too wide is reported."""
        vertical, size = camera.vertical_fov, camera.resolution
        if size is None and self.robot.format != "mjcf":
            size = CAMERA_SIZE
        if vertical is None:
            across = get_number(camera.settings, "field of view") or 0.0
            self.written.report_loss(
                "camera",
                f"camera '{camera.name}' sees {across:g} rad wide, which no flat image shows; "
                f"it sees {WIDEST:g} rad",
                camera.place,
                kind="sensor",
                name=camera.name,
            )
            vertical = 2 * math.atan(math.tan(WIDEST / 2) * _compute_ratio(size))
        name = self._cameras.take(camera.name or "camera")
        self.plan.cameras.append(
            Camera(camera.provenance, name, camera.link, camera.origin, vertical, size)
        )

    def report_parameters(self, sensor: Camera | MountedSensor) -> None:
        """Report the parameters of a sensor that MuJoCo's do not have; defaults have no effect."""
        names = dict.fromkeys(
            "noise" if "noise" in name else name.replace("/", " ")
            for name, value in sensor.settings.items()
            if name not in _EXPRESSED
            and not get_sensor_row(name).mjcf
            and value.content != get_sensor_row(name).default
        )
        if names:
            what = "camera" if isinstance(sensor, Camera) else "sensor"
            self.written.report_loss(
                "sensor-parameter",
                f"{what} '{sensor.name}' is exported without what MuJoCo's have no place for: "
                f"{', '.join(names)}",
                sensor.place,
                kind="sensor",
                name=sensor.name,
                severity=Severity.INFO,
            )

    def report(self, sensor: MountedSensor, why: str) -> None:
        """Report a sensor that is not exported completely."""
        what = f"sensor '{sensor.name}'" if sensor.name else "an unnamed sensor"
        self.written.report_loss(
            "sensor",
            f"{what} is not exported completely: {why}",
            sensor.place,
            kind="sensor",
            name=sensor.name,
        )


def plan_sensors(
    structure: Structure, frames: list[Frame], written: Written, *, base: bool
) -> SensorPlan:
    """Choose MuJoCo's sensors for those of a robot."""
    robot = structure.robot
    planner = _Planner(robot, frames, written)
    for sensor in robot.mounted_sensors:
        joint = robot.joint.get(sensor.joint)
        link = sensor.link or ("" if joint is None else joint.child)
        if robot.format == "mjcf":
            planner.plan.sensors.append(sensor)
            if not (sensor.joint or sensor.site or has_copies(robot, "sensor")):
                planner.report(sensor, "it is neither at a joint nor at a site")
        elif link in robot.link:
            _plan_sensor(planner, sensor, link)
            planner.report_parameters(sensor)
    for camera in robot.cameras:
        planner.add_camera(camera)
        planner.report_parameters(camera)
    _report_unknown(robot, written)
    if base:
        _plan_base(planner, structure)
    return planner.plan


def _plan_sensor(planner: _Planner, sensor: MountedSensor, link: str) -> None:
    kind, pose = get_kind(sensor.type), make_pose(sensor.origin)
    tags = kind.mjcf
    if sensor.quantities:
        tags = tuple((tag, _SUFFIX_OF[tag]) for tag in sensor.quantities)
    if not tags:
        planner.report(sensor, f"MuJoCo has no sensor of type '{sensor.type}'")
    elif tags[0][0] == "touch":
        _plan_touch(planner, sensor, link)
    elif tags[0][0] == "rangefinder":
        _plan_rays(planner, sensor, link, pose)
    else:
        site = planner.add_site(sensor.name or f"{link}_{sensor.type}", link, pose)
        for tag, suffix in tags:
            planner.add(sensor, tag, (sensor.name or link) + suffix, site)


def _plan_touch(planner: _Planner, sensor: MountedSensor, link: str) -> None:
    """Plan a touch sensor in a site that covers the first primitive collision of a link."""
    covered = find_covered(planner.robot.link[link])
    if covered is None:
        planner.report(sensor, "its link has no primitive collision that a site can cover")
        return
    name = sensor.name or f"{link}_contact"
    planner.add(sensor, "touch", name, planner.add_site(name, link, covered[2]))
    if len(planner.robot.link[link].collisions) > 1:
        planner.report(sensor, "only the first collision of its link is covered")


def find_covered(link: Link) -> tuple[str, tuple[float, ...], Pose] | None:
    """Return type, half sizes [m] and pose of the first primitive collision; None without one."""
    for collision in link.collisions:
        found = get_shape_size(collision.geometry)
        if found is not None and min(found[1]) > 0:
            return *found, make_pose(collision.origin)
    return None


def _plan_rays(planner: _Planner, sensor: MountedSensor, link: str, pose: Pose) -> None:
    """Plan one rangefinder for each ray, along the z axis of a site."""
    name = sensor.name or f"{link}_scan"
    count = int(get_number(sensor.settings, "samples") or 0)
    if not 0 < count <= MAX_RAYS:
        planner.add_site(name, link, pose)
        planner.report(
            sensor,
            f"it has {count} rays, and 1 to {MAX_RAYS} can be rangefinders; only its site "
            "is exported",
        )
        return
    low, high = (get_number(sensor.settings, f"{end} angle") or 0.0 for end in _ENDS)
    for index in range(count):
        angle = low + (high - low) * index / max(count - 1, 1)
        turned = Pose(rotation_from_rpy((0.0, 0.0, angle))) @ _FORWARD
        own = f"{name}_{index}"
        planner.add(sensor, "rangefinder", own, planner.add_site(own, link, pose @ turned))


_ENDS = ("minimum", "maximum")

_FORWARD = Pose(rotation_from_rpy((0.0, math.pi / 2, 0.0)))
"""Rotation of the z axis of a site to the x axis of a ray."""


def _report_unknown(robot: Robot, written: Written) -> None:
    """Report the sensors of ros2_control that the model does not hold."""
    known = {sensor.name for sensor in robot.mounted_sensors if sensor.quantities}
    for control in robot.ros2_controls:
        for component in control.components:
            if component.kind != "sensor" or component.name in known:
                continue
            frame = component.params.get("frame_id", "")
            why = "MuJoCo has no sensors for its interfaces"
            if frame not in robot.link:
                why = "its frame_id names no link"
            written.report_loss(
                "sensor",
                f"sensor '{component.name}' of ros2_control is not exported: {why}",
                component.place,
                kind="sensor",
                name=component.name,
            )


def _plan_base(planner: _Planner, structure: Structure) -> None:
    """Add the missing sensors of a floating base, in the frame of its link."""
    base = _get_free_link(structure)
    if base is None:
        planner.written.advice.append("--base-sensors adds nothing: the base is fixed")
        return
    body = {link.name for link in structure.members[structure.group[base]]}
    there = {sensor.type for sensor in planner.plan.sensors if sensor.link in body}
    missing = [(tag, suffix) for tag, suffix in BASE_KINDS if tag not in there]
    if missing:
        site = planner.add_site(f"{base}_imu", base, IDENTITY)
        for tag, suffix in missing:
            planner.add(None, tag, base + suffix, site)


def _get_free_link(structure: Structure) -> str | None:
    """Return the link of a floating base: the root, or the one floating link below a world root."""
    if structure.free:
        return structure.root.name
    floating = [j.child for j in structure.moving if structure.get_kind(j) == "free"]
    return floating[0] if structure.in_world and len(floating) == 1 else None


def build_sensor_section(robot: Robot) -> etree._Element | None:
    """Build ``<sensor>`` with the sensors of a plan; None if it has none."""
    section = etree.Element("sensor")
    for sensor in robot.mounted_sensors:
        if sensor.joint:
            etree.SubElement(section, sensor.type, name=sensor.name, joint=sensor.joint)
        elif sensor.site:
            section.append(_build_at_site(sensor))
    return section if len(section) else None


def _build_at_site(sensor: MountedSensor) -> etree._Element:
    element = etree.Element(sensor.type, name=sensor.name)
    if sensor.type.startswith("frame"):
        element.set("objtype", "site")
        element.set("objname", sensor.site)
    else:
        element.set("site", sensor.site)
    return element


def list_touched(robot: Robot) -> Iterator[tuple[str, Link]]:
    """Yield the name of the site of each touch sensor with its link."""
    for sensor in robot.mounted_sensors:
        if sensor.type == "touch" and sensor.link in robot.link:
            yield sensor.site, robot.link[sensor.link]
