"""Expected gz sensors for Gazebo Classic plugins that measure a link or joint."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....model.block_elements import list_plugins
from ....model.elements import Joint, Link
from ....model.gazebo_plugins import get_library
from ....model.read import number, parse_numbers
from ....source.document import Element
from .facts import Facts
from .frames import Array, make_pose_of_six
from .pair import Pair

TURNING = tuple(f"imu/angular_velocity/{axis}" for axis in "xyz")
MOVING = tuple(f"imu/linear_acceleration/{axis}" for axis in "xyz")
PLACE = tuple(f"navsat/position_sensing/{way}" for way in ("horizontal", "horizontal", "vertical"))
SPEED = tuple(f"navsat/velocity_sensing/{way}" for way in ("horizontal", "horizontal", "vertical"))

SENSING = {
    "gazebo_ros_imu": "imu",
    "gazebo_ros_imu_sensor": "imu",
    "hector_gazebo_ros_imu": "imu",
    "hector_gazebo_ros_gps": "navsat",
    "hector_gazebo_ros_magnetic": "magnetometer",
    "gazebo_ros_ft_sensor": "force_torque",
}
"""Sensor type by plugin library."""

NOISES = {
    ("gazebo_ros_imu", "gaussianNoise"): (TURNING, MOVING),
    ("gazebo_ros_imu", "gaussian_noise"): (TURNING, MOVING),
    ("gazebo_ros_imu_sensor", "gaussianNoise"): (TURNING, MOVING),
    ("gazebo_ros_imu_sensor", "gaussian_noise"): (TURNING, MOVING),
    ("hector_gazebo_ros_imu", "rateGaussianNoise"): (TURNING,),
    ("hector_gazebo_ros_imu", "accelGaussianNoise"): (MOVING,),
    ("hector_gazebo_ros_gps", "gaussianNoise"): (PLACE,),
    ("hector_gazebo_ros_gps", "velocityGaussianNoise"): (SPEED,),
}
OFFSETS = {
    ("hector_gazebo_ros_imu", "rateOffset"): (TURNING,),
    ("hector_gazebo_ros_imu", "accelOffset"): (MOVING,),
}
"""Elements to which each constant error parameter applies."""


def get_sensed_part(pair: Pair, plugin: Element) -> Link | Joint | None:
    """Return the link or joint that a plugin outside of a sensor measures; None for none."""
    kind = SENSING.get(get_library(plugin))
    if kind is None or pair.options.classic:
        return None
    joints = kind == "force_torque"
    tags = ("jointName", "joint_name") if joints else ("bodyName", "body_name")
    named = [child.text.strip() for tag in tags for child in plugin.list_children(tag)]
    block = plugin.parent
    reference = (block.get("reference") if block is not None else None) or ""
    name = (named[0] if named else "") or reference
    if not joints:
        return pair.robot.link.get(name) if pair.place(name) is not None else None
    joint = pair.robot.joint.get(name)
    return joint if joint is not None and pair.get_joint(name) in pair.joints else None


def list_sensing_plugins(pair: Pair) -> Iterator[tuple[Element, Link | Joint]]:
    """Yield the plugins outside of sensors that become sensors."""
    for plugin in list_plugins(pair.robot):
        part = get_sensed_part(pair, plugin)
        if part is not None:
            yield plugin, part


def offset_of(plugin: Element) -> Array:
    """Return the pose of a plugin's sensor in the frame of its link."""
    six: list[float] = []
    for word in ("xyz", "rpy"):
        child = plugin.find_child(f"{word}Offset") or plugin.find_child(f"{word}_offset")
        three = parse_numbers(child.text, 3) if child is not None else None
        six += three or (0.0, 0.0, 0.0)
    return make_pose_of_six(six) if any(six) else np.eye(4)


def get_noise(plugin: Element) -> Facts:
    """Return the noise of the sensor that a plugin becomes."""
    facts: Facts = {}
    for table, word in ((NOISES, "stddev"), (OFFSETS, "mean")):
        for (name, tag), groups in table.items():
            child = plugin.find_child(tag) if name == get_library(plugin) else None
            one = number(child.text) if child is not None else None
            three = parse_numbers(child.text, 3) if child is not None else None
            values = three if one is None else (one, one, one)
            if not values or not any(values):
                continue
            for places in groups:
                for place, value in zip(places, values, strict=True):
                    path = f"{place}/noise"
                    facts[f"{path}@type"] = "gaussian"
                    facts.setdefault(f"{path}/mean", (0.0,))
                    facts.setdefault(f"{path}/stddev", (0.0,))
                    facts[f"{path}/{word}"] = (value,)
    return facts
