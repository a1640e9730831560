"""Plugins, and for which Gazebo they are."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Plugin, Robot
from ...source.document import Element
from ..rule import ERROR, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean
from .systems import CLASSIC, REPLACEMENTS, SYSTEMS

_GZ = ("gz-sim-", "libgz-sim-", "ignition-gazebo-", "libignition-gazebo-", "gz_ros2_control")


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model: a required attribute is missing (sdformat 12.3)",
    },
)
def plugin_without_filename(robot: Robot) -> Iterator[Problem]:
    """A plugin lacks its name or its library.

    Gazebo loads what ``filename`` says and calls it ``name``; without either there is no plugin.
    """
    for plugin in robot.plugins:
        missing = [word for word in ("filename", "name") if not plugin.element.get(word)]
        if missing:
            yield Problem(
                plugin.element, f"the plugin has no {' and no '.join(missing)}; it is not loaded"
            )


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz": "reports that it could not find the shared library",
    },
)
def classic_plugin_in_gz(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A plugin of Gazebo Classic is in a robot for new Gazebo.

    The two have nothing in common but the tag: the library is not there, and would not fit. Most
    have a counterpart; those in sensors are not needed any more (``ros-plugin-inside-sensor``).
    """
    if "gazebo-classic" in targets:
        return
    inside = {id(p.element) for b in robot.gazebo for s in b.sensors for p in s.plugins}
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        if not library.startswith(CLASSIC):
            continue
        if id(plugin.element) in inside and library.startswith("libgazebo_ros_"):
            continue
        instead = REPLACEMENTS.get(library.removesuffix(".so").removeprefix("lib"))
        right = f"; its counterpart is '{instead}'" if instead else "; it has no counterpart"
        yield Problem(
            plugin.element,
            f"'{plugin.filename}' is for Gazebo Classic and is not loaded by new Gazebo{right}",
            at=plugin.element.attribute_place("filename"),
        )


@rule(
    ERROR,
    on=("gazebo-classic",),
    effects={
        "gz": "loads it",
    },
)
def gz_plugin_in_classic(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A plugin of new Gazebo is in a robot for Gazebo Classic.

    gzserver does not find the library and goes on without it.
    """
    if "gz" in targets:
        return
    for plugin in robot.plugins:
        if plugin.filename.rpartition("/")[2].startswith(_GZ):
            yield Problem(
                plugin.element,
                f"'{plugin.filename}' is for new Gazebo and is not loaded by Gazebo Classic",
                at=plugin.element.attribute_place("filename"),
            )


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "replaces a file name of the old form, with a warning",
    },
)
def ignition_name(robot: Robot) -> Iterator[Problem]:
    """A plugin bears the old name, Ignition.

    ``ignition-gazebo-…`` and ``ignition::gazebo::…`` are ``gz-sim-…`` and ``gz::sim::…`` since
    2022. The old names are still understood, for now.
    """
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        if re.match(r"(lib)?ign(ition)?[-_]", library):
            new = re.sub(r"^(lib)?ign(ition)?-gazebo\d?-", "gz-sim-", library).removesuffix(".so")
            new = new.replace("ign_ros2_control", "gz_ros2_control").removeprefix("lib")
            yield Problem(
                plugin.element,
                f"'{plugin.filename}' is an old name; write '{new}'"
                + (" and gz::sim:: in its name" if "ignition::" in plugin.name else ""),
                at=plugin.element.attribute_place("filename"),
            )


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz": "finds the library and starts nothing of it: could not instantiate",
    },
)
def plugin_class_mismatch(robot: Robot) -> Iterator[Problem]:
    """The name of a plugin of gz sim is not the class in its library.

    New Gazebo takes ``name`` for the class to start. A name of one's own, as in Gazebo Classic,
    finds the library and nothing in it.
    """
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2].removeprefix("lib").removesuffix(".so")
        library = re.sub(r"^ignition-gazebo\d?-", "gz-sim-", library)
        right = SYSTEMS.get(re.sub(r"^gz-sim\d+-", "gz-sim-", library))
        name = plugin.name.replace("ignition::gazebo::", "gz::sim::")
        if right and plugin.name and name != right and name != right.removeprefix("gz::sim::"):
            yield Problem(
                plugin.element,
                f"the class in '{plugin.filename}' is '{right}', and not '{plugin.name}'",
                at=plugin.element.attribute_place("name"),
            )


_JOINTS = [
    "left_joint",
    "right_joint",
    "joint_name",
    "jointName",
    "leftJoint",
    "rightJoint",
    "leftFrontJoint",
    "leftRearJoint",
    "rightFrontJoint",
    "rightRearJoint",
    "mimicJoint",
    "front_left_joint",
    "front_right_joint",
    "rear_left_joint",
    "rear_right_joint",
    "left_steering_joint",
    "right_steering_joint",
    "steering_wheel_joint",
    "steeringJoint",
]
_LINKS = ["link_name", "linkName", "body_name", "bodyName", "child_link"]


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "pass the name on as it is",
    },
)
def plugin_unknown_entity(robot: Robot) -> Iterator[Problem]:
    """A plugin names a joint or link that is not there.

    A drive that does not find its wheels says so once in the log, among much else, and does nothing
    when it is told to go.
    """
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        if not library.startswith((*CLASSIC, *_GZ)):
            continue
        for child in plugin.element.children:
            name = child.text.strip().rpartition("::")[2]
            if not name or is_unexpanded(name) or child.children or name in ("world", "map"):
                continue
            if child.tag in _JOINTS and name not in robot.joint:
                yield _unknown(plugin, child.tag, name, "joint", [*robot.joint], child)
            elif child.tag in _LINKS and name not in robot.link:
                yield _unknown(plugin, child.tag, name, "link", [*robot.link], child)


def _unknown(
    plugin: Plugin, tag: str, name: str, kind: str, known: list[str], at: Element
) -> Problem:
    if "," in name or " " in name:
        parts = [part for part in re.split(r"[,\s]+", name) if part]
        name = next((part for part in parts if part not in known), parts[0])
    return Problem(
        plugin.element,
        f"<{tag}> of plugin '{plugin.name}' is '{name}', and there is no such {kind}"
        + did_you_mean(name, known),
        at=at,
    )


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "load both (sdformat 12.3)",
    },
)
def duplicate_plugin_name(robot: Robot) -> Iterator[Problem]:
    """Two plugins of the model have one name.

    SDF wants names of siblings to differ. For new Gazebo the name is the class and two of one class
    are right; there it is not told.
    """
    seen: set[str] = set()
    for block in robot.gazebo:
        if block.reference:
            continue
        for plugin in block.plugins:
            library = plugin.filename.rpartition("/")[2]
            if not plugin.name or not library.startswith(CLASSIC):
                continue
            if plugin.name in seen:
                yield Problem(
                    plugin.element,
                    f"a second plugin is called '{plugin.name}'; give it a name of its own",
                    at=plugin.element.attribute_place("name"),
                )
            seen.add(plugin.name)
