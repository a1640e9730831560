"""Comparison of the world: model, ground, gravity, and the systems of the sensors."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from ....compare.check import Check
from ....compare.compare import compare_robots
from ....compare.proof import describe
from ....compare.rows import GLOBAL_ROWS
from ....errors import UrdftoolError
from ....model.elements import Robot
from ....model.numbers import describe_content
from ....model.settings import parse
from ....model.world_settings import OF_SDF
from ..read import read
from .pair import Pair

GROUND = "ground_plane"
TOLERANCE = 1e-9
"""Largest difference of the height [m] that counts as equal; chosen, above rounding errors."""

RENDERING = ("camera", "lidar")
"""Parts of the names of sensor types that the rendering system runs."""

WORDS = {
    "air_pressure": "air-pressure", "air_speed": "air-speed", "altimeter": "altimeter",
    "contact": "contact", "dvl": "dvl", "force_torque": "forcetorque", "imu": "imu",
    "logical_camera": "logical-camera", "magnetometer": "magnetometer", "navsat": "navsat",
}  # fmt: skip
"""Words in the library names of the systems that run other sensors."""


def compare_world(pair: Pair) -> Check:
    """Compare the model in a world, and the world itself."""
    check = Check("world", "the same model, gravity, ground, systems of its sensors", TOLERANCE)
    path = pair.place if pair.options.file else pair.place.parent / "world.sdf"
    try:
        world = ET.parse(path).getroot().find("world")
    except (OSError, ET.ParseError) as error:
        check.differing.append(f"{path.name} cannot be read: {error}")
        return check
    if world is None:
        check.differing.append(f"{path.name} has no <world>")
        return check
    models = [model for model in world.findall("model") if model.get("name") != GROUND]
    if len(models) != 1:
        check.compare(np.inf, f"{len(models)} models in addition to the ground")
        return check
    _compare_model(pair, path, check)
    _compare_settings(pair.robot, world, check)
    if world.find("physics") is not None:
        check.compare(np.inf, "<physics>, which the description does not require")
    included = [(uri.text or "").strip() for uri in world.iterfind("include/uri")]
    ground = world.find(f"model[@name='{GROUND}']")
    flat = ground is not None and ground.find("link/collision/geometry/plane") is not None
    if f"model://{GROUND}" not in included and not flat:
        check.compare(np.inf, "there is no ground")
    if not pair.options.classic:
        _compare_systems(models[0], world, check)
    return check


def _compare_settings(source: Robot, world: ET.Element, check: Check) -> None:
    """Compare gravity and the other settings with those of the source, or the defaults of SDF."""
    for row in OF_SDF:
        text = world.findtext(row.path)
        found = row.default if text is None else parse(row.kind, text) or text
        expected = source.world[row.name].content if row.name in source.world else row.default
        if found != expected:
            name = row.name.replace("_", " ")
            why = f"{describe_content(found)}, not {describe_content(expected)}"
            check.compare(np.inf, f"{name} is {why}")


def _compare_model(pair: Pair, path: Path, check: Check) -> None:
    """Compare the robot of the world with that of the model's file, and its height."""
    try:
        placed = read(path, name=pair.result.name).robot
        rows = [row for row in pair.rows if row.name not in GLOBAL_ROWS]
        comparison = compare_robots(pair.result, placed, rows=rows)
    except UrdftoolError as error:
        check.differing.append(f"{path.name}: {error.message}")
        return
    check.differing += [describe(difference) for difference in comparison.differences]
    height = _get_height(placed) - _get_height(pair.result)
    declared = [loss.data["height"] for loss in pair.claims.losses if loss.code == "lossy-start"]
    if not path.samefile(pair.place):
        expected = float(declared[0]) if declared else 0.0
        check.compare(abs(height - expected), f"the model starts {height:.6g} m higher")


def _get_height(robot: Robot) -> float:
    """Return the height of the root above the ground [m]."""
    origin = None if robot.base is None else robot.base.origin
    return 0.0 if origin is None else origin.xyz[2]


def _compare_systems(model: ET.Element, world: ET.Element, check: Check) -> None:
    libraries = [plugin.get("filename") or "" for plugin in world.findall("plugin")]
    kinds = {sensor.get("type") or "" for sensor in model.iter("sensor")}
    systems = {"physics", *(WORDS[kind] for kind in kinds & WORDS.keys())}
    if any(part in kind for kind in kinds - WORDS.keys() for part in RENDERING):
        systems.add("sensors")
    for word in sorted(systems):
        if not any(library.endswith(f"-{word}-system") for library in libraries):
            check.compare(np.inf, f"the system '{word}' is missing")
