"""Comparison of the world: model, ground, gravity, and the systems of the sensors."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from ....compare.check import Check
from .facts import EXACT, compare_facts, get_facts, get_value
from .pair import Pair

GROUND = "ground_plane"
RENDERING = ("camera", "lidar")
"""Parts of the names of sensor types that the rendering system runs."""

WORDS = {
    "air_pressure": "air-pressure", "air_speed": "air-speed", "altimeter": "altimeter",
    "contact": "contact", "dvl": "dvl", "force_torque": "forcetorque", "imu": "imu",
    "logical_camera": "logical-camera", "magnetometer": "magnetometer", "navsat": "navsat",
}  # fmt: skip
"""Words in the library names of the systems that run other sensors."""


def compare_world(pair: Pair, place: Path) -> Check:
    """Compare the model in a world, and the world itself.

    Args:
        pair: The robot and the model.
        place: Path of the model's file.
    """
    check = Check("world", "the same model, gravity, ground, systems of its sensors", EXACT)
    path = place if pair.options.file else place.parent / "world.sdf"
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
    expected = get_facts(pair.where.model)
    for height in _list_heights(pair):  # above the ground, only in the world
        expected.setdefault("pose", (0.0, 0.0, height, 0.0, 0.0, 0.0))
    compare_facts(check, "the model", get_facts(models[0]), expected)
    gravity = get_value(world.findtext("gravity") or "0 0 -9.8")
    if gravity != (0.0, 0.0, -9.8):
        check.compare(np.inf, f"gravity is {world.findtext('gravity')}")
    if world.find("physics") is not None:
        check.compare(np.inf, "<physics>, which the description does not require")
    included = [(uri.text or "").strip() for uri in world.iterfind("include/uri")]
    ground = world.find(f"model[@name='{GROUND}']")
    flat = ground is not None and ground.find("link/collision/geometry/plane") is not None
    if f"model://{GROUND}" not in included and not flat:
        check.compare(np.inf, "there is no ground")
    if not pair.options.classic:
        _compare_systems(pair, world, check)
    return check


def _list_heights(pair: Pair) -> list[float]:
    """Return the height [m] at which the export declares that the model starts, if it does."""
    return [float(loss.data["height"]) for loss in pair.claims.losses if loss.code == "lossy-start"]


def _compare_systems(pair: Pair, world: ET.Element, check: Check) -> None:
    libraries = [plugin.get("filename") or "" for plugin in world.findall("plugin")]
    kinds = {sensor.get("type") or "" for sensor in pair.where.model.iter("sensor")}
    systems = {"physics", *(WORDS[kind] for kind in kinds & WORDS.keys())}
    if any(part in kind for kind in kinds - WORDS.keys() for part in RENDERING):
        systems.add("sensors")
    for word in sorted(systems):
        if not any(library.endswith(f"-{word}-system") for library in libraries):
            check.compare(np.inf, f"the system '{word}' is missing")
