"""Comparison of plugins: library, class and parameters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....compare.check import Check
from ....model.block_elements import list_model_elements, list_part_elements
from ....model.elements import Joint, Link
from ....model.gazebo_plugins import (
    CONTROL_PLUGINS,
    MIMIC_PLUGINS,
    SENSOR_PLUGINS,
    SYSTEM_PLUGINS,
    System,
    get_library,
)
from ....model.read import number
from ....source.document import Element
from .facts import EXACT, Facts, compare_facts, get_facts, get_value
from .frames import Array, make_pose_of_six
from .pair import Pair
from .sensing import get_sensed_part

CONTROL = frozenset(
    ("parameters", "ros", "controller_manager_name", "robot_param", "robot_param_node",
     "hold_joints")
)  # fmt: skip
"""Parameters that gz_ros2_control supports."""


@dataclass
class Expected:
    """A plugin that the description requires.

    Attributes:
        owner: Link, joint or sensor that contains it; empty for the model.
        library: Library file.
        name: Class or name; empty if any is accepted.
        facts: Its parameters.
        offset: Pose in the owner, for a plugin of a link that was lumped into another.
    """

    owner: str
    library: str
    name: str
    facts: Facts
    offset: Array | None = None


def compare_plugins(pair: Pair) -> Check:
    """Compare every plugin."""
    check = Check("plugins", "what they are of, library, class, parameters", 0.0)
    left = list(_list_written(pair))
    expected = list(_list_expected(pair))
    check.is_empty = not (left or expected)
    for wanted in expected:
        about = f"plugin '{wanted.library}'" + (f" of '{wanted.owner}'" if wanted.owner else "")
        alike = [one for one in left if one[1].get("filename") == wanted.library]
        alike.sort(key=lambda one: _collect_unlike(one, wanted))
        if not alike:
            check.compare(np.inf, f"{about} is missing")
            continue
        owner, element = alike[0]
        left.remove(alike[0])
        if owner != wanted.owner:
            # sensors with the same name in one link are renamed
            renamed = pair.declared.has_any("lossy-name")
            known = renamed and owner.startswith(f"{wanted.owner}_")
            check.compare(np.inf, f"{about} is in '{owner}'", known=known)
        if wanted.name and element.get("name") != wanted.name:
            check.compare(
                np.inf, f"{about} has the name '{element.get('name')}', not '{wanted.name}'"
            )
        facts = {p: v for p, v in get_facts(element).items() if not p.startswith("@")}
        if wanted.offset is not None:
            apart = _offset(facts) - wanted.offset
            check.compare(float(np.abs(apart).max()) // EXACT, f"{about} has another offset")
        compare_facts(check, about, facts, wanted.facts)
    for owner, element in left:
        text = f"plugin '{element.get('filename')}' of '{owner}' is not in the description"
        check.compare(np.inf, text)
    return check


def _collect_unlike(one: tuple[str, Any], wanted: Expected) -> tuple[bool, bool, int]:
    facts = get_facts(one[1])
    apart = sum(facts.get(path) != value for path, value in wanted.facts.items())
    return one[0] != wanted.owner, one[1].get("name") != wanted.name, apart


def _list_written(pair: Pair) -> Iterator[tuple[str, Any]]:
    """Yield the plugins of the file, with the name of their parent element."""
    model = pair.where.model
    for element in model.findall("plugin"):
        yield "", element
    for kind in ("link", "joint"):
        for node in model.findall(kind):
            for element in node.findall("plugin"):
                yield node.get("name", ""), element
            for sensor in node.findall("sensor"):
                for element in sensor.findall("plugin"):
                    yield sensor.get("name", ""), element


def _list_expected(pair: Pair) -> Iterator[Expected]:
    for element in list_model_elements(pair.robot):
        if element.tag == "plugin":
            yield from _list_one(pair, element, "")
    elements = {
        kind: {e.get("name") for e in pair.where.model.findall(kind)} for kind in ("link", "joint")
    }
    parts: list[Link | Joint] = [*pair.robot.links, *pair.robot.joints]
    for part in parts:
        if isinstance(part, Link):
            held = pair.place(part.name)
            owner = held[0] if held is not None else ""
        else:
            owner = pair.get_joint(part.name)
        there = owner in elements["link" if isinstance(part, Link) else "joint"]
        for element in list_part_elements(pair.robot, part) if there else ():
            if element.tag == "plugin":
                yield from _list_one(pair, element, owner)
            elif element.tag == "sensor":
                for plugin in element.list_children("plugin"):
                    if pair.options.classic or get_library(plugin) not in SENSOR_PLUGINS:
                        name = element.get("name") or f"{part.name}_sensor"
                        yield from _list_one(pair, plugin, name, inside=True)


def _list_one(
    pair: Pair, element: Element, owner: str, *, inside: bool = False
) -> Iterator[Expected]:
    """Yield the expected plugins for a plugin of the description."""
    name = get_library(element)
    if not name:
        return
    gz = not pair.options.classic
    if not inside and get_sensed_part(pair, element) is not None:
        return
    if gz and name in CONTROL_PLUGINS:
        yield _get_control(pair, element, owner)
    elif gz and name in MIMIC_PLUGINS and _is_mimic(pair, element):
        return
    elif gz and name in SYSTEM_PLUGINS:
        for system in SYSTEM_PLUGINS[name]:
            yield _get_system(pair, element, owner, system)
    else:
        facts = {p: v for p, v in get_facts(element).items() if not p.startswith("@")}
        own = element.get("name") or name
        yield _set_moved(
            pair,
            Expected(owner, element.get("filename") or "", own, _get_renamed(pair, facts)),
            element,
        )


def _set_moved(pair: Pair, wanted: Expected, element: Element) -> Expected:
    """Set the offset of a plugin whose link was lumped into another, in Classic."""
    child = element.find_child("bodyName")
    link = child.text.strip() if child is not None else ""
    held = pair.place(link)
    if not pair.options.classic or held is None or held[0] == pair.link(link):
        return wanted
    wanted.offset = held[1] @ _offset(wanted.facts)
    return wanted


def _offset(facts: Facts) -> Array:
    """Remove the pose from the parameters of a plugin, and return it."""
    six: list[float] = []
    for word in ("xyzOffset", "rpyOffset"):
        value = facts.pop(word, (0.0, 0.0, 0.0))
        six += value if not isinstance(value, str) and len(value) == 3 else (0.0, 0.0, 0.0)
    return make_pose_of_six(six)


def _is_mimic(pair: Pair, element: Element) -> bool:
    child = element.find_child("mimicJoint")
    joint = pair.robot.joint.get(child.text.strip()) if child is not None else None
    return joint is not None and joint.mimic is not None and pair.options.is_at_least("1.11")


def _get_control(pair: Pair, element: Element, owner: str) -> Expected:
    """Return the expected ros2_control plugin for gz."""
    new = pair.options.is_at_least("1.10")
    facts: Facts = {}
    for child in element.children:
        if child.tag == "robotNamespace" and child.text.strip():
            facts["ros/namespace"] = get_value(child.text)
    kept = [child.tag for child in element.children if child.tag not in CONTROL]
    facts.update(
        {p: v for p, v in get_facts(element, without=kept).items() if not p.startswith("@")}
    )
    return Expected(
        owner,
        "gz_ros2_control-system" if new else "ign_ros2_control-system",
        "gz_ros2_control::GazeboSimROS2ControlPlugin"
        if new
        else "ign_ros2_control::IgnitionROS2ControlPlugin",
        facts,
    )


def _get_system(pair: Pair, element: Element, owner: str, system: System) -> Expected:
    """Return the expected gz system for a plugin of Gazebo Classic."""
    said: list[tuple[str, str]] = []
    facts: Facts = {}
    for child in element.children:
        new = system.parameters.get(child.tag)
        text = child.text.strip()
        if new is None:
            continue
        if child.children:
            for path, value in get_facts(child).items():
                facts[f"{new}/{path}"] = value
            said.append((new, ""))
        elif new == "joint_name":
            said += [(new, word.strip()) for word in text.split(",") if word.strip()]
        elif child.tag in system.halved and number(text) is not None:
            said.append((new, repr((number(text) or 0.0) / 2)))
        elif text:
            said.append((new, text))
    ros = element.find_child("ros")
    maps = [e for tag in ("remapping", "argument") for e in (ros.list_children(tag) if ros else ())]
    for entry in maps:
        old, arrow, new_name = entry.text.strip().partition(":=")
        tag = system.remapped.get(old.strip()) if arrow else None
        if tag is not None and tag not in dict(said):
            said.append((tag, new_name.strip()))
    said += [(tag, text) for tag, text in system.defaults.items() if tag not in dict(said)]
    count: Counter[str] = Counter()
    for tag, text in said:
        if not text:
            continue
        count[tag] += 1
        path = tag if count[tag] == 1 else f"{tag}[{count[tag]}]"
        facts[path] = get_value(pair.get_joint(text) if "joint" in tag else text)
    modern = pair.options.is_at_least("1.10")
    return Expected(
        owner,
        f"gz-sim-{system.word}-system" if modern else f"ignition-gazebo-{system.word}-system",
        f"gz::sim::systems::{system.name}"
        if modern
        else f"ignition::gazebo::systems::{system.name}",
        facts,
    )


def _get_renamed(pair: Pair, facts: Facts) -> Facts:
    """Return parameters with the exported names of links and joints."""
    made: Facts = {}
    for path, value in facts.items():
        tag = path.rpartition("/")[2].partition("[")[0]
        if isinstance(value, str) and "oint" in tag:
            value = pair.get_joint(value)
        elif isinstance(value, str) and ("ink" in tag or tag in ("bodyName", "body_name")):
            held = pair.place(str(value))
            if held is not None:
                value = held[0] if pair.options.classic else pair.link(str(value))
        made[path] = value
    return made
