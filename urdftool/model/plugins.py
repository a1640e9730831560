"""Plugins of Gazebo on a robot, as values: library, class, and parameters by their path.

``gazebo_plugins.py`` has the systems of gz that replace plugins of Gazebo Classic. A plugin that no
table knows keeps its parameters as texts by their path.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..source.document import Element
from .gazebo_plugins import (
    BODY_SENSORS,
    CONTROL_PLUGINS,
    MIMIC_PLUGINS,
    SYSTEM_PLUGINS,
    System,
    convert_parameters,
    get_class,
    get_file,
    get_library,
)
from .mechanism import MountedPlugin
from .provenance import Written
from .settings import Settings, Value, get_text

if TYPE_CHECKING:
    from .provenance import Provenance

_CONTROL = frozenset(
    ("parameters", "ros", "controller_manager_name", "robot_param", "robot_param_node",
     "hold_joints")
)  # fmt: skip
"""Parameters that the plugin of ros2_control for gz takes unchanged."""

_IGNITION = "ignition-gazebo-"


def read_plugin(
    element: Element, owner: str = "", provenance: Provenance | None = None
) -> MountedPlugin:
    """Return the plugin of an element."""
    settings: Settings = {}
    for child in element.children:
        _add_parameters(settings, child, "")
    known = provenance or element
    name, library = element.get("name") or "", normalize_library(get_library(element))
    return MountedPlugin(known, name, library, owner, settings)


def normalize_library(library: str) -> str:
    """Return the name of a library in the newest gz."""
    if library.startswith(_IGNITION):
        return "gz-sim-" + library.removeprefix(_IGNITION)
    return "gz_ros2_control-system" if library == "ign_ros2_control-system" else library


def normalize_class(name: str) -> str:
    """Return the name of a class in the newest gz."""
    if name == "ign_ros2_control::IgnitionROS2ControlPlugin":
        return "gz_ros2_control::GazeboSimROS2ControlPlugin"
    before = "ignition::gazebo::"
    return "gz::sim::" + name.removeprefix(before) if name.startswith(before) else name


def _add_parameters(settings: Settings, element: Element, above: str) -> None:
    path = f"{above}{element.tag}"
    name, count = path, 1
    while name in settings:
        count += 1
        name = f"{path} {count}"
    if not element.children:
        settings[name] = Value(element, get_text(element))
    for attribute, text in element.attributes.items():
        settings[f"{name}/@{attribute}"] = Value(element, text)
    for child in element.children:
        _add_parameters(settings, child, f"{name}/")


def list_replacements(plugin: MountedPlugin) -> list[MountedPlugin]:
    """Return the systems of gz that replace a plugin of Gazebo Classic; none for another."""
    element = _get_element(plugin)
    if element is None:
        return []
    if plugin.library in CONTROL_PLUGINS:
        return [_replace_control(plugin, element)]
    return [_replace(plugin, element, system) for system in SYSTEM_PLUGINS.get(plugin.library, ())]


def is_part_of_robot(plugin: MountedPlugin) -> bool:
    """Tell whether the robot itself holds what a plugin does: a sensor, or a mimic joint."""
    return plugin.library in BODY_SENSORS or plugin.library in MIMIC_PLUGINS


def _get_element(plugin: MountedPlugin) -> Element | None:
    known = plugin.provenance
    return known.element if isinstance(known, Written) else plugin.xml


def _replace(plugin: MountedPlugin, element: Element, system: System) -> MountedPlugin:
    settings: Settings = {}
    for tag, value in convert_parameters(element, system)[0]:
        name, count = tag, 1
        while name in settings:
            count += 1
            name = f"{tag} {count}"
        if isinstance(value, str):
            settings[name] = Value(element, value)
        else:
            for child in value.children:
                _add_parameters(settings, child, f"{name}/")
            for attribute, text in value.attributes.items():
                settings[f"{name}/@{attribute}"] = Value(value, text)
    name, file = get_class(system), get_file(system)
    return MountedPlugin(plugin.provenance, name, file, plugin.owner, settings)


def _replace_control(plugin: MountedPlugin, element: Element) -> MountedPlugin:
    settings: Settings = {}
    for child in element.children:
        if child.tag == "robotNamespace" and child.text.strip():
            settings["ros/namespace"] = Value(child, child.text.strip())
        elif child.tag in _CONTROL:
            _add_parameters(settings, child, "")
    name, file = "gz_ros2_control::GazeboSimROS2ControlPlugin", "gz_ros2_control-system"
    return MountedPlugin(plugin.provenance, name, file, plugin.owner, settings)
