"""Comparison of sensors: link, pose, type, rate and parameters."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ....compare.check import Check
from ....model.block_elements import list_part_elements
from ....model.elements import Joint, Link, Robot
from ....model.gazebo_plugins import SENSOR_PLUGINS, get_library
from ....model.kinematics import link_poses
from ....model.read import number, parse_numbers
from ....model.world import WORLD
from ....source.document import Element
from .declared_losses import BLOCKS
from .facts import EXACT, Facts, compare_facts, get_facts, get_value
from .frames import Array, invert_pose, make_pose, make_pose_of_six, read_pose
from .pair import Pair
from .sensing import SENSING, get_noise, list_sensing_plugins, offset_of

FOR_GZ = {
    "ray": "gpu_lidar", "gpu_ray": "gpu_lidar", "lidar": "gpu_lidar", "gps": "navsat",
    "depth": "depth_camera", "multicamera": "camera", "wideanglecamera": "wide_angle_camera",
}  # fmt: skip
FOR_CLASSIC = {
    "gpu_lidar": "gpu_ray", "lidar": "ray", "navsat": "gps", "depth_camera": "depth",
    "rgbd_camera": "depth", "wide_angle_camera": "wideanglecamera",
}  # fmt: skip
RENAMED = {
    "gz": {"ray": "lidar", "gps": "navsat"},
    "gazebo-classic": {"lidar": "ray", "navsat": "gps"},
}
RESTING = ("lossy-sensor", "unknown-sensor-type", *sorted(BLOCKS))


@dataclass
class Expected:
    """A sensor that the description requires.

    Attributes:
        part: Link or joint that carries it.
        name: Name of the sensor.
        pose: Pose in the frame of the link or joint.
        facts: Its parameters.
        partial: Whether additional parameters are accepted.
    """

    part: Link | Joint
    name: str
    pose: Array = field(default_factory=lambda: np.eye(4))
    facts: Facts = field(default_factory=dict)
    partial: bool = False


def compare_sensors(pair: Pair) -> Check:
    """Compare every sensor."""
    check = Check("sensors", "link or joint, pose, type, rate, topic, parameters", EXACT)
    left = list(_list_written(pair))
    base, here = _compute_base(pair), _compute_poses(pair.robot)
    expected = list(list_expected_sensors(pair))
    check.is_empty = not (left or expected)
    for sensor in expected:
        part = sensor.part
        known = pair.declared.has_for(RESTING, part.name)
        about = f"sensor '{sensor.name}' of '{part.name}'"
        element = _find(pair, sensor, left)
        if element is None:
            check.compare(np.inf, f"{about} is missing", known=known)
            continue
        left.remove(element)
        found = _make_facts(element)
        if sensor.partial:
            found = {path: value for path, value in found.items() if path in sensor.facts}
        _drop_collisions(found, sensor.facts)
        compare_facts(check, about, found, sensor.facts, known=known)
        if isinstance(part, Link):
            held = pair.place(part.name)
            if held is None or held[0] != element[0]:
                check.compare(np.inf, f"{about} is on '{element[0]}'", known=known)
            place = (
                base
                @ pair.where.get_pose(element[0])
                @ pair.where.get_local(element[0], element[1])
            )
            off = float(np.abs(place - here[part.name] @ sensor.pose).max())
            check.compare(off, f"{about} is at another pose", known=known)
        else:
            off = float(np.abs(read_pose(element[1]) - sensor.pose).max())
            check.compare(off, f"{about} is at another pose", known=known)
    for owner, element in left:
        check.compare(
            np.inf, f"sensor '{element.get('name')}' of '{owner}' is not in the description"
        )
    return check


def _compute_base(pair: Pair) -> Array:
    """Return the pose of the model in the first root of the source; the identity for the world."""
    names = [root.name for root in pair.robot.tree.roots]
    held = pair.place(names[0]) if names and WORLD not in names else None
    return np.eye(4) if held is None else invert_pose(pair.where.get_pose(held[0]) @ held[1])


def _compute_poses(robot: Robot) -> dict[str, Array]:
    """Return the poses of links with all joints at zero, 4 × 4."""
    return {n: make_pose(p.rotation, p.translation) for n, p in link_poses(robot).items()}


def _list_written(pair: Pair) -> Iterator[tuple[str, Any]]:
    """Yield the sensors of the file, with the name of their link or joint."""
    for kind in ("link", "joint"):
        for node in pair.where.model.findall(kind):
            for element in node.findall("sensor"):
                yield node.get("name", ""), element


def _find(pair: Pair, sensor: Expected, left: list[tuple[str, Any]]) -> tuple[str, Any] | None:
    """Return the sensor of a name, preferably at its expected parent."""
    part = sensor.part
    if isinstance(part, Link):
        held = pair.place(part.name)
        owner = held[0] if held is not None else ""
    else:
        owner = pair.get_joint(part.name)
    named = [one for one in left if one[1].get("name") == sensor.name]
    named += [one for one in left if (one[1].get("name") or "").startswith(f"{sensor.name}_")]
    return next((one for one in named if one[0] == owner), next(iter(named), None))


def _make_facts(element: tuple[str, Any]) -> Facts:
    facts = get_facts(element[1], without=("pose", "plugin"))
    facts["type"] = get_value(element[1].get("type"))
    return facts


def _drop_collisions(found: Facts, expected: Facts) -> None:
    """Accept collision names that the exporter shortened."""
    for path in [p for p in expected if p.startswith("contact/collision")]:
        one, other = found.get(path), expected[path]
        if isinstance(one, str) and isinstance(other, str) and one in other:
            found[path] = other


def list_expected_sensors(pair: Pair) -> Iterator[Expected]:
    """Yield the sensors that the description requires."""
    parts: list[Link | Joint] = [*pair.robot.links, *pair.robot.joints]
    for part in parts:
        if isinstance(part, Joint) and not _is_joint(pair, part):
            continue
        for element in list_part_elements(pair.robot, part):
            if element.tag == "sensor":
                kind = (element.get("type") or "").strip()
                if isinstance(part, Link) and kind == "force_torque":
                    continue
                yield from _list_expected(pair, part, element)
    for plugin, part in list_sensing_plugins(pair):
        yield _get_of_plugin(pair, plugin, part)


def _get_of_plugin(pair: Pair, plugin: Element, part: Link | Joint) -> Expected:
    """Return the gz sensor that a plugin outside of a sensor becomes."""
    facts: Facts = {"type": SENSING[get_library(plugin)], "always_on": (1.0,), **get_noise(plugin)}
    _take_over(pair, plugin, facts)
    return Expected(part, plugin.get("name") or get_library(plugin), offset_of(plugin), facts)


def _is_joint(pair: Pair, joint: Joint) -> bool:
    return pair.get_joint(joint.name) in pair.joints


def _list_expected(pair: Pair, part: Link | Joint, element: Element) -> Iterator[Expected]:
    kind = (element.get("type") or "").strip()
    target = pair.options.target
    facts: Facts = {}
    for path, value in get_facts(element, without=("pose", "plugin")).items():
        head, slash, rest = path.partition("/")
        if kind in (FOR_CLASSIC if pair.options.classic else FOR_GZ):
            head = RENAMED[target].get(head, head)
        facts[head + slash + rest] = value
    kinds = FOR_CLASSIC if pair.options.classic else FOR_GZ
    facts["type"] = get_value(kinds.get(kind, kind))
    _translate_noise(element, facts)
    if not pair.options.classic:
        for plugin in element.list_children("plugin"):
            _take_over(pair, plugin, facts)
    name = element.get("name") or f"{part.name}_sensor"
    pose = get_pose_of_element(pair, part, element)
    cameras = list(element.list_children("camera"))
    if kind != "multicamera" or pair.options.classic:
        yield Expected(part, name, pose, facts)
        return
    for index, camera in enumerate(cameras):
        own = {k: v for k, v in facts.items() if not k.startswith("camera")}
        own.update({f"camera/{k}": v for k, v in get_facts(camera).items()})
        own["camera@name"] = get_value(camera.get("name"))
        if camera.get("name") is None:
            del own["camera@name"]
        yield Expected(part, f"{name}_{camera.get('name') or index}", pose, own)


def get_pose_of_element(pair: Pair, part: Link | Joint, element: Element) -> Array:
    """Return the pose of an element of a block in the frame of its link."""
    child = element.find_child("pose")
    values = parse_numbers(child.text, 6) if child is not None else None
    pose = make_pose_of_six(values) if values is not None else np.eye(4)
    frame = child.get("relative_to") if child is not None else None
    if frame and isinstance(part, Link) and frame in pair.robot.link:
        placed = _compute_poses(pair.robot)
        pose = invert_pose(placed[part.name]) @ placed[frame] @ pose
    return pose


def _translate_noise(element: Element, facts: Facts) -> None:
    """Convert IMU noise from the format before SDF 1.5, axis by axis."""
    imu = element.find_child("imu")
    noise = imu.find_child("noise") if imu is not None else None
    if noise is None:
        return
    for path in [path for path in facts if path.startswith("imu/noise")]:
        del facts[path]
    kind = noise.find_child("type")
    for old, new in (("rate", "angular_velocity"), ("accel", "linear_acceleration")):
        holder = noise.find_child(old)
        for axis in "xyz" if holder is not None else "":
            path = f"imu/{new}/{axis}/noise"
            if holder is None or any(known.startswith(path) for known in facts):
                continue
            facts[f"{path}@type"] = get_value(kind.text if kind is not None else "gaussian")
            for word in ("mean", "stddev", "bias_mean", "bias_stddev"):
                child = holder.find_child(word)
                if child is not None and number(child.text) is not None:
                    facts[f"{path}/{word}"] = get_value(child.text)


def _take_over(pair: Pair, plugin: Element, facts: Facts) -> None:
    """Add the settings that a gz sensor takes from its Gazebo Classic plugin."""
    known = SENSOR_PLUGINS.get(get_library(plugin))
    if known is None:
        return
    said = {child.tag: child.text.strip() for child in plugin.children if child.text.strip()}
    if known.type:
        facts["type"] = known.type
    topic = get_topic(plugin, said)
    if topic and "topic" not in facts:
        facts["topic"] = get_value(topic)
    rate = said.get("updateRate") or said.get("update_rate")
    if number(rate) and "update_rate" not in facts:
        facts["update_rate"] = get_value(rate)
    frame = next((said[tag] for tag in known.frame if tag in said), "")
    if not frame or "gz_frame_id" in facts:
        return
    if pair.options.is_at_least("1.12"):
        facts.setdefault("frame_id", get_value(frame))
    elif any(path.startswith("camera") for path in facts):
        facts.setdefault("camera/optical_frame_id", get_value(frame))


def get_topic(plugin: Element, said: dict[str, str]) -> str:
    """Return the topic that a plugin publishes; empty if it sets none."""
    ros = plugin.find_child("ros")
    space = said.get("robotNamespace", "")
    topic = ""
    if ros is not None:
        inner = ros.find_child("namespace")
        space = inner.text.strip() if inner is not None else space
        maps = [
            e.text.strip().split(":=") for e in ros.list_children("remapping") if ":=" in e.text
        ]
        topic = maps[0][1] if maps else ""
    if not topic:
        topic = said.get("topicName") or said.get("imageTopicName") or ""
        camera = said.get("cameraName") or said.get("camera_name") or ""
        if camera and not topic.startswith("/"):
            topic = f"{camera}/{topic or 'image_raw'}"
        topic = topic or said.get("bumperTopicName") or said.get("topic_name") or ""
    if topic and space.strip("/") and not topic.startswith("/"):
        topic = f"{space.rstrip('/')}/{topic}"
    return topic
