"""Comparison of sensors, cameras and lights: link, pose, type and view."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Array, Mechanics, get_origin_matrix
from ...model.elements import Robot
from ...model.read import number as read_number
from ...model.read import parse_numbers
from ...source.document import Element
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .verify_source import Source, read_pose

EXACT = 1e-9

SITES = {
    "imu": ("ACCELEROMETER", "GYRO", "FRAMEQUAT"),
    "force_torque": ("FORCE", "TORQUE"),
    "gps": ("FRAMEPOS",),
    "navsat": ("FRAMEPOS",),
    "altimeter": ("FRAMEPOS",),
    "magnetometer": ("MAGNETOMETER",),
}
RAYS = ("ray", "gpu_ray", "lidar", "gpu_lidar", "sonar")
PICTURES = ("camera", "depth", "depth_camera", "rgbd_camera", "openni_kinect", "multicamera")
MOST_RAYS = 36

INTERFACES = {
    "force": "FORCE",
    "torque": "TORQUE",
    "linear_acceleration": "ACCELEROMETER",
    "angular_velocity": "GYRO",
    "orientation": "FRAMEQUAT",
}
"""MuJoCo sensor of each ros2_control state interface, by the text before the dot."""

BASE = ("FRAMELINVEL", "GYRO", "ACCELEROMETER", "FRAMEQUAT")
"""Sensors of a free base."""

LOOK = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Axes of MuJoCo's camera (-z forward, y up) in Gazebo's (x forward, z up)."""


@dataclass
class Measured:
    """A sensor that the description requires.

    Attributes:
        name: Prefix of its name in MuJoCo.
        kind: MuJoCo's sensor type.
        link: Link that carries the sensor.
        pose: Pose in the link's frame, 4 × 4.
        whole: Whether all axes count; for a ray only its direction does.
    """

    name: str
    kind: str
    link: str
    pose: Array = field(default_factory=lambda: np.eye(4))
    whole: bool = True


def check_sensor(
    source: Source,
    mechanics: Mechanics,
    compiled: Compiled,
    positions: Mapping[str, float],
    declared: DeclaredLosses,
) -> Check:
    """Compare sensors, cameras and lights: link, pose, type and view.

    Args:
        source: The expected values from the description.
        mechanics: Kinematics of the description.
        compiled: The model.
        positions: Joint positions [rad or m] at which poses are compared.
        declared: The reported losses.
    """
    what = "sensors, cameras, lights: link, pose, type, view"
    check = Check("sensors", what, EXACT)
    compiled.set_pose(positions)
    frames = mechanics.compute_frames(positions)
    model = compiled.model
    left = list(range(model.nsensor))
    asked = list(_list_required(source))
    for wanted in (*asked, *_list_of_base(source, asked)):
        known = declared.has_for(("lossy-sensor",), wanted.name)
        place = frames.get(wanted.link, np.eye(4)) @ wanted.pose
        number = _find(wanted, place, left, compiled)
        text = f"sensor '{wanted.name}' ({wanted.kind.lower()})"
        if number is None:
            check.compare(math.inf, f"{text} is missing", known=known)
            continue
        left.remove(number)
        _compare_sensor(number, wanted, place, text, compiled, check)
    for number in left:
        name = compiled.name("SENSOR", number)
        check.compare(math.inf, f"sensor '{name}' is not in the description")
    _add_cameras(source, frames, compiled, declared, check)
    _add_lights(source, frames, compiled, declared, check)
    return check


def _list_required(source: Source) -> Iterator[Measured]:
    """Yield the sensors of Gazebo, then those of ros2_control."""
    robot = source.robot
    for element, link in list_sensors(robot):
        kind = (element.get("type") or "").strip()
        name, pose = element.get("name") or "", read_pose(element)
        for measured in SITES.get(kind, ()):
            yield Measured(name, measured, link, pose)
        if kind in RAYS:
            yield from _list_rays(element, name, link, pose)
        if kind == "contact" and any(_is_sized(c.geometry) for c in robot.link[link].collisions):
            yield Measured(name or f"{link}_contact", "TOUCH", link, _compute_middle(robot, link))
    for control in robot.ros2_controls:
        for component in control.components:
            frame = component.params.get("frame_id", "")
            if component.kind == "sensor" and frame in robot.link:
                words = {i.name.split(".")[0] for i in component.state_interfaces}
                for word in INTERFACES.keys() & words:
                    yield Measured(component.name, INTERFACES[word], frame)


def _list_of_base(source: Source, others: list[Measured]) -> Iterator[Measured]:
    """Yield the base sensors that the options require and that the base does not have."""
    if not source.options.base_sensors:
        return
    base = source.root if source.is_free else ""
    floating = [joint.child for joint in source.robot.joints if joint.type == "floating"]
    if source.root == "world" and len(floating) == 1:
        base = floating[0]
    for kind in BASE if base else ():
        if not any(o.kind == kind and source.rigid[o.link] == source.rigid[base] for o in others):
            yield Measured(base, kind, base)


def list_sensors(robot: Robot) -> Iterator[tuple[Element, str]]:
    """Yield each Gazebo ``<sensor>`` with its link; for a joint reference, the child link."""
    for block in robot.gazebo:
        name = block.element.get("reference") or ""
        joint = robot.joint.get(name)
        link = name if name in robot.link else joint.child if joint is not None else ""
        if link in robot.link:
            for element in block.element.list_children("sensor"):
                yield element, link


def _list_rays(element: Element, name: str, link: str, pose: Array) -> Iterator[Measured]:
    """Yield one ray for each sample: z of its site is the rotated x axis of the scanner."""
    scan = next((e for e in element.walk() if e.tag == "horizontal"), None)

    def read(tag: str) -> float:
        child = scan.find_child(tag) if scan is not None else None
        return (read_number(child.text) if child is not None else None) or 0.0

    count, low, high = int(read("samples")), read("min_angle"), read("max_angle")
    for index in range(count if count <= MOST_RAYS else 0):
        ray = np.eye(4)
        angle = low + (high - low) * (index / (count - 1) if count > 1 else 0.0)
        ray[:3, 2] = math.cos(angle), math.sin(angle), 0.0
        ray[:3, :2] = 0.0
        yield Measured(f"{name or f'{link}_scan'}_{index}", "RANGEFINDER", link, pose @ ray, False)


def _is_sized(geometry: object) -> bool:
    return type(geometry).__name__ in ("Box", "Cylinder", "Sphere", "Capsule", "UnknownShape")


def _compute_middle(robot: Robot, link: str) -> Array:
    sized = [c for c in robot.link[link].collisions if _is_sized(c.geometry)]
    return get_origin_matrix(sized[0].origin)


def _find(wanted: Measured, place: Array, left: list[int], compiled: Compiled) -> int | None:
    """Return the sensor of a type and name prefix that is nearest to a pose."""
    kind = int(getattr(compiled.mujoco.mjtSensor, f"mjSENS_{wanted.kind}"))
    alike = [n for n in left if int(compiled.model.sensor_type[n]) == kind]
    named = [n for n in alike if compiled.name("SENSOR", n).startswith(wanted.name)]
    return min(named, key=lambda n: _get_off(n, wanted, place, compiled), default=None)


def _get_off(number: int, wanted: Measured, place: Array, compiled: Compiled) -> float:
    """Return the difference between the pose of a sensor's site and a pose in the root's frame."""
    model = compiled.model
    site = int(model.sensor_objid[number])
    if int(model.sensor_objtype[number]) != int(compiled.mujoco.mjtObj.mjOBJ_SITE):
        return math.inf
    found = compiled.get_site_frame(site)
    if not wanted.whole:
        return float(abs(found[:3, 2:] - place[:3, 2:]).max())
    return float(abs(found - place).max())


def _compare_sensor(
    number: int, wanted: Measured, place: Array, text: str, compiled: Compiled, check: Check
) -> None:
    model = compiled.model
    check.compare(_get_off(number, wanted, place, compiled), f"{text} is at another pose")
    if int(model.sensor_objtype[number]) == int(compiled.mujoco.mjtObj.mjOBJ_SITE):
        body = int(model.site_bodyid[int(model.sensor_objid[number])])
        if model.body_weldid[body] != model.body_weldid[max(compiled.get_body(wanted.link), 0)]:
            check.compare(math.inf, f"{text} is on another body than link '{wanted.link}'")
    for name in ("noise", "cutoff", "delay", "interval"):
        values = getattr(model, f"sensor_{name}", None)
        if values is not None and np.any(values[number]):
            check.compare(math.inf, f"{text} has a {name} that the description does not require")


def _add_cameras(
    source: Source,
    frames: dict[str, Array],
    compiled: Compiled,
    declared: DeclaredLosses,
    check: Check,
) -> None:
    model = compiled.model
    left = list(range(model.ncam))
    for element, link in list_sensors(source.robot):
        if (element.get("type") or "").strip() not in PICTURES:
            continue
        for camera in element.list_children("camera"):
            name = element.get("name") or "camera"
            place = frames[link] @ read_pose(element) @ read_pose(camera)
            place[:3, :3] = place[:3, :3] @ LOOK
            named = [n for n in left if compiled.name("CAMERA", n).startswith(name)]
            named.sort(key=lambda n: float(abs(compiled.get_camera_frame(n) - place).max()))
            if not named:
                check.compare(math.inf, f"camera '{name}' is missing")
                continue
            left.remove(named[0])
            known = declared.has_for(("lossy-camera",), element.get("name") or "")
            _compare_camera(named[0], camera, place, link, compiled, check, known)
    for number in left:
        name = compiled.name("CAMERA", number)
        check.compare(math.inf, f"camera '{name}' is not in the description")


def _compare_camera(
    number: int,
    camera: Element,
    place: Array,
    link: str,
    compiled: Compiled,
    check: Check,
    known: bool,
) -> None:
    model, name = compiled.model, compiled.name("CAMERA", number)
    off = float(abs(compiled.get_camera_frame(number) - place).max())
    check.compare(off, f"camera '{name}' is at another pose")
    body = int(model.cam_bodyid[number])
    if model.body_weldid[body] != model.body_weldid[max(compiled.get_body(link), 0)]:
        check.compare(math.inf, f"camera '{name}' is on another body than link '{link}'")
    width, height = (
        _get_pixels(camera, tag, size) for tag, size in (("width", 320), ("height", 240))
    )
    fov = camera.find_child("horizontal_fov")
    across = (read_number(fov.text) if fov is not None else None) or 1.047
    half = math.tan(across / 2) * height / width
    up = 2 * math.degrees(math.atan(half))
    check.compare(abs(float(model.cam_fovy[number]) - up) / 180, f"view of '{name}'", known=known)
    if list(model.cam_resolution[number]) != [width, height]:
        check.compare(math.inf, f"resolution of camera '{name}'")
    if int(model.cam_mode[number]) != 0:
        check.compare(math.inf, f"camera '{name}' does not move with its body")


def _get_pixels(camera: Element, tag: str, usual: int) -> int:
    image = camera.find_child("image")
    child = image.find_child(tag) if image is not None else None
    value = read_number(child.text) if child is not None else None
    return int(value) if value is not None and value >= 1 else usual


def _add_lights(
    source: Source,
    frames: dict[str, Array],
    compiled: Compiled,
    declared: DeclaredLosses,
    check: Check,
) -> None:
    model, data = compiled.model, compiled.data
    root = compiled.get_body(source.root)
    up = data.xmat[max(root, 0)].reshape(3, 3)
    start = data.xpos[max(root, 0)]
    left = list(range(model.nlight))
    for block in source.robot.gazebo:
        link = block.element.get("reference") or ""
        for light in block.element.list_children("light") if link in source.robot.link else ():
            name = light.get("name") or "light"
            place = frames[link] @ read_pose(light)
            named = [n for n in left if compiled.name("LIGHT", n).startswith(name)]
            if not named:
                check.compare(math.inf, f"light '{name}' is missing")
                continue
            number = named[0]
            left.remove(number)
            at = up.T @ (data.light_xpos[number] - start)
            check.compare(float(abs(at - place[:3, 3]).max()), f"light '{name}' is at another pose")
            body = int(model.light_bodyid[number])
            if model.body_weldid[body] != model.body_weldid[max(compiled.get_body(link), 0)]:
                check.compare(math.inf, f"light '{name}' is on another body than link '{link}'")
            if (light.get("type") or "point") != "point":
                aim = np.array(_collect_three(light, "direction") or (0.0, 0.0, -1.0))
                aim = aim if aim.any() else np.array((0.0, 0.0, -1.0))
                aim = place[:3, :3] @ aim / np.linalg.norm(aim)
                found = up.T @ data.light_xdir[number]
                check.compare(float(abs(found - aim).max()), f"direction of light '{name}'")
            for tag in ("diffuse", "specular"):
                color = _collect_three(light, tag)
                if color is not None:
                    found = getattr(model, f"light_{tag}")[number]
                    off = float(abs(found - np.array(color)).max())
                    check.compare(off * EXACT / 1e-6, f"{tag} of light '{name}'")
            if not model.light_active[number]:
                check.compare(math.inf, f"light '{name}' is off")
    for number in left:
        name = compiled.name("LIGHT", number)
        check.compare(math.inf, f"light '{name}' is not in the description")


def _collect_three(element: Element, tag: str) -> tuple[float, ...] | None:
    child = element.find_child(tag)
    if child is None:
        return None
    four = parse_numbers(child.text, 4) or parse_numbers(child.text, 3)
    return four[:3] if four is not None else None
