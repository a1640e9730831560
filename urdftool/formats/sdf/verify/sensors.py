"""Comparison of sensors: link, pose, type, rate and parameters."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ....model.elements import Joint, Link
from ....model.gazebo_plugins import SENSOR_PLUGINS, library
from ....model.read import number, numbers
from ....source.document import Element
from ...check import Check
from .dynamics import poses
from .excuses import BLOCKS
from .facts import EXACT, Facts, compare_facts, facts_of, value_of
from .mechanism import Array, inverse, matrix, turned
from .reader import read_pose
from .said import elements_of
from .sensing import SENSING, noise_of, offset_of, sensing_plugins
from .source import base_of

if TYPE_CHECKING:
    from .compare import Pair

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
    left = list(_written(pair))
    order = pair.made.in_order()
    there = poses(pair.made, {}, order)
    root = base_of(pair.robot)
    base = np.eye(4)
    if root is not None:
        body, inside = pair.made.frames.get(pair.link(root), ("world", np.eye(4)))
        base = inverse(there[body] @ inside)
    here = poses(pair.source, {}, pair.source.in_order())
    for sensor in expected_sensors(pair):
        part = sensor.part
        known = pair.excuses.declared.of(RESTING, part.name)
        about = f"sensor '{sensor.name}' of '{part.name}'"
        element = _find(pair, sensor, left)
        if element is None:
            check.compare(np.inf, f"{about} is missing", known=known)
            continue
        left.remove(element)
        found = _facts(element)
        if sensor.partial:
            found = {path: value for path, value in found.items() if path in sensor.facts}
        _drop_collisions(found, sensor.facts)
        compare_facts(check, about, found, sensor.facts, known=known)
        if isinstance(part, Link):
            held = pair.place(part.name)
            if held is None or held[0] != element[0]:
                check.compare(np.inf, f"{about} is on '{element[0]}'", known=known)
            place = base @ there[element[0]] @ pair.where.local(element[0], element[1])
            off = float(np.abs(place - here[part.name] @ sensor.pose).max())
            check.compare(
                off, f"{about} is at another pose", known=known or part.name in pair.excuses.frames
            )
        else:
            off = float(np.abs(read_pose(element[1]) - sensor.pose).max())
            check.compare(off, f"{about} is at another pose", known=known)
    for owner, element in left:
        check.compare(
            np.inf, f"sensor '{element.get('name')}' of '{owner}' is not in the description"
        )
    return check


def _written(pair: Pair) -> Iterator[tuple[str, Any]]:
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
        owner = pair.joint(part.name)
    named = [one for one in left if one[1].get("name") == sensor.name]
    named += [one for one in left if (one[1].get("name") or "").startswith(f"{sensor.name}_")]
    return next((one for one in named if one[0] == owner), next(iter(named), None))


def _facts(element: tuple[str, Any]) -> Facts:
    facts = facts_of(element[1], without=("pose", "plugin"))
    facts["type"] = value_of(element[1].get("type"))
    return facts


def _drop_collisions(found: Facts, expected: Facts) -> None:
    """Accept collision names that the exporter shortened."""
    for path in [p for p in expected if p.startswith("contact/collision")]:
        one, other = found.get(path), expected[path]
        if isinstance(one, str) and isinstance(other, str) and one in other:
            found[path] = other


def expected_sensors(pair: Pair) -> Iterator[Expected]:
    """Yield the sensors that the description requires."""
    parts: list[Link | Joint] = [*pair.robot.links, *pair.robot.joints]
    for part in parts:
        if isinstance(part, Joint) and not _is_joint(pair, part):
            continue
        for element in elements_of(pair.robot, part):
            if element.tag == "sensor":
                kind = (element.get("type") or "").strip()
                if isinstance(part, Link) and kind == "force_torque":
                    continue
                yield from _expected(pair, part, element)
    for plugin, part in sensing_plugins(pair):
        yield _of_plugin(pair, plugin, part)


def _of_plugin(pair: Pair, plugin: Element, part: Link | Joint) -> Expected:
    """Return the gz sensor that a plugin outside of a sensor becomes."""
    facts: Facts = {"type": SENSING[library(plugin)], "always_on": (1.0,), **noise_of(plugin)}
    _take_over(pair, plugin, facts)
    return Expected(part, plugin.get("name") or library(plugin), offset_of(plugin), facts)


def _is_joint(pair: Pair, joint: Joint) -> bool:
    name = pair.joint(joint.name)
    return any(made.name == name for made in pair.made.joints)


def _expected(pair: Pair, part: Link | Joint, element: Element) -> Iterator[Expected]:
    kind = (element.get("type") or "").strip()
    target = pair.options.target
    facts: Facts = {}
    for path, value in facts_of(element, without=("pose", "plugin")).items():
        head, slash, rest = path.partition("/")
        if kind in (FOR_CLASSIC if pair.options.classic else FOR_GZ):
            head = RENAMED[target].get(head, head)
        facts[head + slash + rest] = value
    kinds = FOR_CLASSIC if pair.options.classic else FOR_GZ
    facts["type"] = value_of(kinds.get(kind, kind))
    _translate_noise(element, facts)
    if not pair.options.classic:
        for plugin in element.all("plugin"):
            _take_over(pair, plugin, facts)
    name = element.get("name") or f"{part.name}_sensor"
    pose = pose_of_element(pair, part, element)
    cameras = list(element.all("camera"))
    if kind != "multicamera" or pair.options.classic:
        yield Expected(part, name, pose, facts)
        return
    for index, camera in enumerate(cameras):
        own = {k: v for k, v in facts.items() if not k.startswith("camera")}
        own.update({f"camera/{k}": v for k, v in facts_of(camera).items()})
        own["camera@name"] = value_of(camera.get("name"))
        if camera.get("name") is None:
            del own["camera@name"]
        yield Expected(part, f"{name}_{camera.get('name') or index}", pose, own)


def pose_of_element(pair: Pair, part: Link | Joint, element: Element) -> Array:
    """Return the pose of an element of a block in the frame of its link."""
    child = element.child("pose")
    values = numbers(child.text, 6) if child is not None else None
    pose = matrix(turned(values[3:]), values[:3]) if values is not None else np.eye(4)
    frame = child.get("relative_to") if child is not None else None
    if frame and isinstance(part, Link) and frame in pair.source.frames:
        placed = poses(pair.source, {}, pair.source.in_order())
        pose = inverse(placed[part.name]) @ placed[frame] @ pose
    return pose


def _translate_noise(element: Element, facts: Facts) -> None:
    """Convert IMU noise from the format before SDF 1.5, axis by axis."""
    imu = element.child("imu")
    noise = imu.child("noise") if imu is not None else None
    if noise is None:
        return
    for path in [path for path in facts if path.startswith("imu/noise")]:
        del facts[path]
    kind = noise.child("type")
    for old, new in (("rate", "angular_velocity"), ("accel", "linear_acceleration")):
        holder = noise.child(old)
        for axis in "xyz" if holder is not None else "":
            path = f"imu/{new}/{axis}/noise"
            if holder is None or any(known.startswith(path) for known in facts):
                continue
            facts[f"{path}@type"] = value_of(kind.text if kind is not None else "gaussian")
            for word in ("mean", "stddev", "bias_mean", "bias_stddev"):
                child = holder.child(word)
                if child is not None and number(child.text) is not None:
                    facts[f"{path}/{word}"] = value_of(child.text)


def _take_over(pair: Pair, plugin: Element, facts: Facts) -> None:
    """Add the settings that a gz sensor takes from its Gazebo Classic plugin."""
    known = SENSOR_PLUGINS.get(library(plugin))
    if known is None:
        return
    said = {child.tag: child.text.strip() for child in plugin.children if child.text.strip()}
    if known.type:
        facts["type"] = known.type
    topic = topic_of(plugin, said)
    if topic and "topic" not in facts:
        facts["topic"] = value_of(topic)
    rate = said.get("updateRate") or said.get("update_rate")
    if number(rate) and "update_rate" not in facts:
        facts["update_rate"] = value_of(rate)
    frame = next((said[tag] for tag in known.frame if tag in said), "")
    if not frame or "gz_frame_id" in facts:
        return
    if pair.options.since("1.12"):
        facts.setdefault("frame_id", value_of(frame))
    elif any(path.startswith("camera") for path in facts):
        facts.setdefault("camera/optical_frame_id", value_of(frame))


def topic_of(plugin: Element, said: dict[str, str]) -> str:
    """Return the topic that a plugin publishes; empty if it sets none."""
    ros = plugin.child("ros")
    space = said.get("robotNamespace", "")
    topic = ""
    if ros is not None:
        inner = ros.child("namespace")
        space = inner.text.strip() if inner is not None else space
        maps = [e.text.strip().split(":=") for e in ros.all("remapping") if ":=" in e.text]
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
