"""Fixes of Gazebo's plugins."""

from __future__ import annotations

import re
from pathlib import Path

from ...model.gazebo_plugins import SYSTEM_PLUGINS, carried, class_of, file_of, library
from ...source.nearby import bytes_of
from ...source.packages import own_package
from ..cross_file_references import check_not_included
from ..gazebo.systems import REPLACEMENTS, SYSTEMS
from ..rule import Problem
from .proposal import (
    Around,
    Proposal,
    element_at,
    insert,
    meant,
    put,
    quote,
    replace,
    safe,
    say,
    sub,
    unsafe,
)


def classic_plugin_in_gz(problem: Problem, around: Around) -> Proposal | None:
    """Its successor, with the parameters that have one."""
    plugin = problem.element
    old = library(plugin)
    if old == "gazebo_ros2_control":
        new = REPLACEMENTS[old]
        return unsafe(
            f"load '{new}'", put(plugin, "filename", new), put(plugin, "name", SYSTEMS[new])
        )
    systems = SYSTEM_PLUGINS.get(old, ())
    if not systems or any("$" in child.text for child in plugin.walk()):
        return None
    lines: list[str] = []
    left: set[str] | None = None
    for system in systems:
        said, unsaid = carried(plugin, system)
        joints = "left_joint" not in system.parameters.values() or "left_joint" in dict(said)
        if system.missing or not joints:
            return None
        left = set(unsaid) if left is None else left & set(unsaid)
        inside = [f"<{tag}>{quote(v)}</{tag}>" for tag, v in said if isinstance(v, str)]
        if len(inside) != len(said):
            return None
        start = f'<plugin filename="{file_of(system)}" name="{class_of(system)}"'
        indented = (f"\t{line}" for line in inside)
        lines += [f"{start}>", *indented, "</plugin>"] if inside else [f"{start}/>"]
    dropped = f"; it has no {', '.join(sorted(left))}" if left else ""
    names = "' and '".join(file_of(system) for system in systems)
    return unsafe(f"load '{names}'{dropped}", replace(plugin, tuple(lines)))


def ignition_name(problem: Problem, around: Around) -> Proposal | None:
    """Write its new name, which Gazebo Fortress, the last called Ignition, does not know."""
    plugin = problem.element
    new = problem.message.partition("; write '")[2].partition("'")[0]
    if not new:
        return None
    changes = [put(plugin, "filename", new)]
    name = plugin.get("name") or ""
    if "ignition::gazebo::" in name:
        changes.append(sub(plugin, "name", "^ignition::gazebo::", "gz::sim::"))
    elif name.startswith("ign_ros2_control::"):
        changes.append(put(plugin, "name", SYSTEMS["gz_ros2_control-system"]))
    return unsafe(f"write {new}", *changes)


def plugin_class_mismatch(problem: Problem, around: Around) -> Proposal | None:
    """Write the class in the library, by the name that goes with the library's."""
    right = problem.message.partition("' is '")[2].partition("'")[0]
    if not right:
        return None
    if "ignition-gazebo" in (problem.element.get("filename") or ""):
        right = right.replace("gz::sim::", "ignition::gazebo::")
    return safe(f"write {right}", put(problem.element, "name", right))


def plugin_unknown_entity(problem: Problem, around: Around) -> Proposal | None:
    """The link or joint that was meant; an element for each of several."""
    element = element_at(problem)
    if element is not None and " takes one " in problem.message:
        names = [name for name in re.split(r"[,\s]+", element.text) if name]
        tag = element.tag
        blocks = [(f"<{tag}>{quote(name)}</{tag}>",) for name in names]
        return unsafe(f"write {len(names)} <{tag}>", replace(element, *blocks))
    name = meant(problem, element.text.strip()) if element is not None else ""
    if element is None or not name or re.search(r"[,\s]", element.text.strip()):
        return None
    return unsafe(f"write {name}", say(element, name))


_RUNS = {
    "gz_ros2_control/": ("gz_ros2_control-system", "gz_ros2_control::GazeboSimROS2ControlPlugin"),
    "gazebo_ros2_control/": ("libgazebo_ros2_control.so", "gazebo_ros2_control"),
}


def ros2_control_sim_plugin_pair(problem: Problem, around: Around) -> Proposal | None:
    """The plugin, where the package has one file of controllers, without which it fails."""
    described = around.description
    own = own_package(described.packages.file)
    controls = [c for c in around.robot.ros2_controls if c.element is problem.element]
    if own is None or described.expansion is None or not controls:
        return None
    runs = [v for prefix, v in _RUNS.items() if (controls[0].plugin or "").startswith(prefix)]
    files = [path for path in sorted((own[1] / "config").glob("*.y*ml")) if _manages(path)]
    if len(files) != 1 or not runs:
        return None
    check_not_included(around)
    file, name = runs[0]
    lines = (
        "<gazebo>",
        f'\t<plugin filename="{file}" name="{name}">',
        f"\t\t<parameters>$(find {own[0]})/config/{quote(files[0].name)}</parameters>",
        "\t</plugin>",
        "</gazebo>",
    )
    return unsafe(
        f"add it with the controllers of config/{files[0].name}",
        insert(around.robot.element, *lines),
    )


def _manages(path: Path) -> bool:
    """Whether a file has the parameters of a controller_manager."""
    try:
        return re.search(rb"^\W*controller_manager\W*:", bytes_of(path), re.MULTILINE) is not None
    except OSError:
        return False
