"""Rules on plugins of Gazebo."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.block_elements import list_model_elements
from ...model.elements import Plugin, Robot
from ...model.gazebo_plugins import SYSTEM_PLUGINS, convert_parameters, get_class, get_file
from ...model.gazebo_plugins import get_library as library_of
from ...source.document import Element
from ..fix import (
    FixContext,
    Proposal,
    append_number,
    escape_attribute,
    find_element,
    get_suggestion,
    replace_element,
    safe,
    set_attribute,
    set_text,
    substitute,
    unsafe,
)
from ..rule import ERROR, SAFE, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import find_nearest, quote, suggest_name
from .systems import CLASSIC, REPLACEMENTS, SYSTEMS

APPLIES_TO = ("plugin",)

_GZ = ("gz-sim-", "libgz-sim-", "ignition-gazebo-", "libignition-gazebo-", "gz_ros2_control")


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model: a required attribute is missing (sdformat 12.3)",
    },
)
def plugin_without_filename(robot: Robot) -> Iterator[Problem]:
    """A plugin has no name or no library.

    Gazebo loads the library ``filename`` and the plugin ``name`` in it; sdformat requires both
    attributes.
    """
    for plugin in robot.plugins:
        missing = [word for word in ("filename", "name") if not plugin.element.get(word)]
        if missing:
            yield Problem(
                plugin.element,
                f"plugin has no {' and no '.join(missing)}, so Gazebo rejects the model",
                data={"has_filename": "filename" not in missing},
            )


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz": "reports that it could not find the shared library",
    },
)
def classic_plugin_in_gz(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A robot for new Gazebo has a plugin of Gazebo Classic.

    New Gazebo cannot load plugins of Gazebo Classic. Most have a counterpart; those in sensors are
    not required (``ros-plugin-inside-sensor``).
    """
    if "gazebo-classic" in targets:
        return
    inside = {id(plugin.element) for sensor in robot.sensors for plugin in sensor.plugins}
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
            f"'{plugin.filename}' is for Gazebo Classic, and new Gazebo cannot load it{right}",
            at=plugin.locate_attribute("filename"),
            data={"counterpart": instead} if instead else {},
        )


@classic_plugin_in_gz.fix(UNSAFE, reveals=True)
def load_counterpart(problem: Problem, context: FixContext) -> Proposal | None:
    """Load the counterpart, with the parameters that have an equivalent."""
    plugin = problem.element
    old = library_of(plugin)
    if old == "gazebo_ros2_control":
        new = REPLACEMENTS[old]
        return unsafe(
            f"load '{new}'",
            set_attribute(plugin, "filename", new),
            set_attribute(plugin, "name", SYSTEMS[new]),
        )
    systems = SYSTEM_PLUGINS.get(old, ())
    if not systems or any("$" in child.text for child in plugin.walk()):
        return None
    lines: list[str] = []
    left: set[str] | None = None
    for system in systems:
        taken, lost = convert_parameters(plugin, system)
        joints = "left_joint" not in system.parameters.values() or "left_joint" in dict(taken)
        if system.missing or not joints:
            return None
        left = set(lost) if left is None else left & set(lost)
        inside = [f"<{tag}>{escape_attribute(v)}</{tag}>" for tag, v in taken if isinstance(v, str)]
        if len(inside) != len(taken):
            return None
        start = f'<plugin filename="{get_file(system)}" name="{get_class(system)}"'
        indented = (f"\t{line}" for line in inside)
        lines += [f"{start}>", *indented, "</plugin>"] if inside else [f"{start}/>"]
    dropped = f"; it has no {', '.join(sorted(left))}" if left else ""
    names = "' and '".join(get_file(system) for system in systems)
    return unsafe(f"load '{names}'{dropped}", replace_element(plugin, tuple(lines)))


@rule(
    ERROR,
    on=("gazebo-classic",),
    effects={
        "gz": "loads it",
    },
)
def gz_plugin_in_classic(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A robot for Gazebo Classic has a plugin of new Gazebo.

    gzserver does not find the library and continues without the plugin.
    """
    if "gz" in targets:
        return
    for plugin in robot.plugins:
        if plugin.filename.rpartition("/")[2].startswith(_GZ):
            yield Problem(
                plugin.element,
                f"'{plugin.filename}' is for new Gazebo, and Gazebo Classic cannot load it",
                at=plugin.locate_attribute("filename"),
            )


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "replaces an old file name, with a warning",
    },
)
def ignition_name(robot: Robot) -> Iterator[Problem]:
    """A plugin has an old name of Ignition Gazebo.

    Since 2022, ``ignition-gazebo-…`` is ``gz-sim-…``, and ``ignition::gazebo::…`` is
    ``gz::sim::…``. Gazebo still replaces the old names, with a warning.
    """
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        if re.match(r"(lib)?ign(ition)?[-_]", library):
            new = re.sub(r"^(lib)?ign(ition)?-gazebo\d?-", "gz-sim-", library).removesuffix(".so")
            new = new.replace("ign_ros2_control", "gz_ros2_control").removeprefix("lib")
            yield Problem(
                plugin.element,
                f"'{plugin.filename}' is an old name of Ignition Gazebo; write '{new}'"
                + (" and gz::sim:: in its name" if "ignition::" in plugin.name else ""),
                at=plugin.locate_attribute("filename"),
                data={"write": new},
            )


@ignition_name.fix(UNSAFE)
def write_gz_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the new name, which Gazebo Fortress, the last release named Ignition, does not load."""
    plugin = problem.element
    new = problem.data["write"]
    changes = [set_attribute(plugin, "filename", new)]
    name = plugin.get("name") or ""
    if "ignition::gazebo::" in name:
        changes.append(substitute(plugin, "name", "^ignition::gazebo::", "gz::sim::"))
    elif name.startswith("ign_ros2_control::"):
        changes.append(set_attribute(plugin, "name", SYSTEMS["gz_ros2_control-system"]))
    return unsafe(f"write {new}", *changes)


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz": "finds the library, but could not instantiate the plugin",
    },
)
def plugin_class_mismatch(robot: Robot) -> Iterator[Problem]:
    """The name of a gz sim plugin is not the class in its library.

    New Gazebo uses ``name`` as the class to instantiate. With a custom name, as in Gazebo Classic,
    it loads the library but does not start the plugin.
    """
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2].removeprefix("lib").removesuffix(".so")
        library = re.sub(r"^ignition-gazebo\d?-", "gz-sim-", library)
        right = SYSTEMS.get(re.sub(r"^gz-sim\d+-", "gz-sim-", library))
        name = plugin.name.replace("ignition::gazebo::", "gz::sim::")
        if right and plugin.name and name != right and name != right.removeprefix("gz::sim::"):
            yield Problem(
                plugin.element,
                f"the class in '{plugin.filename}' is '{right}', not '{plugin.name}'; write it "
                "as the name",
                at=plugin.locate_attribute("name"),
                data={"class": right},
            )


@plugin_class_mismatch.fix(SAFE)
def write_class(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the class of the library, with the same prefix as the library's name."""
    right = problem.data["class"]
    if "ignition-gazebo" in (problem.element.get("filename") or ""):
        right = right.replace("gz::sim::", "ignition::gazebo::")
    return safe(f"write {right}", set_attribute(problem.element, "name", right))


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
        "gz, gazebo-classic": "keep the name as written",
    },
)
def plugin_unknown_entity(robot: Robot) -> Iterator[Problem]:
    """A plugin refers to a joint or link that does not exist.

    A drive without its wheels logs one error and does not move the robot. The joint state publisher
    of Gazebo Classic reads a comma-separated list, of which the missing names are reported. Systems
    of new Gazebo read one name per element, and the element several times.
    """
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        if not library.startswith((*CLASSIC, *_GZ)):
            continue
        for child in plugin.element.children:
            text = child.text.strip()
            kind = "joint" if child.tag in _JOINTS else "link" if child.tag in _LINKS else ""
            if not kind or child.children or is_unexpanded(text):
                continue
            known = [*robot.joint] if kind == "joint" else [*robot.link]
            parts = [part for part in re.split(r"[,\s]+", text) if part]
            names = [part.rpartition("::")[2] for part in parts]
            if len(names) > 1 and text.rpartition("::")[2] in known:
                continue
            missing = [name for name in names if name not in (*known, "world", "map")]
            if len(names) > 1 and library.startswith(_GZ):
                yield Problem(
                    plugin.element,
                    f"<{child.tag}> of plugin '{plugin.name}' takes one {kind}, but has several, "
                    f"'{text}'; write one <{child.tag}> for each",
                    at=child,
                    data={"kind": kind, "names": parts},
                )
            elif missing:
                yield _report_unknown_entities(plugin, child, missing, kind, known, len(names) > 1)


def _report_unknown_entities(
    plugin: Plugin, at: Element, missing: list[str], kind: str, known: list[str], of_list: bool
) -> Problem:
    verb = "lists" if of_list else "is"
    kinds = f"no such {kind}s" if len(missing) > 1 else f"no such {kind}"
    return Problem(
        plugin.element,
        f"<{at.tag}> of plugin '{plugin.name}' {verb} {quote(missing)}, but the robot has {kinds}"
        + suggest_name(missing[0], known),
        at=at,
        data={"kind": kind, "missing": missing, "suggestion": find_nearest(missing[0], known)},
    )


@plugin_unknown_entity.fix(UNSAFE)
def write_names(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested name, or one element for each of several names."""
    element = find_element(problem)
    names: list[str] = problem.data.get("names", [])
    if element is not None and names:
        tag = element.tag
        blocks = [(f"<{tag}>{escape_attribute(name)}</{tag}>",) for name in names]
        return unsafe(f"write {len(names)} <{tag}>", replace_element(element, *blocks))
    name = get_suggestion(problem, element.text.strip()) if element is not None else ""
    if element is None or not name or re.search(r"[,\s]", element.text.strip()):
        return None
    return unsafe(f"write {name}", set_text(element, name))


@rule(
    WARNING,
    effects={
        "gazebo_ros": "of ROS 2 creates no second node with the same name, so the plugin gets none",
        "gz, gazebo-classic": "load both (sdformat 12.3)",
    },
)
def duplicate_plugin_name(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """Two plugins of the model have the same name.

    The plugins of gazebo_ros for ROS 2 use the plugin name as node name, and the second plugin gets
    no node: "Found multiple nodes with same name". Write unique names, or a namespace for each. The
    rule does not apply to new Gazebo, where the name is the class, and to ROS 1. sdformat 12.3
    accepts equal names.
    """
    if "ros1" in targets and "ros2" not in targets:
        return
    seen: set[tuple[str, str]] = set()
    of_model = {id(element) for element in list_model_elements(robot)}
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        is_of_model = id(plugin.element) in of_model
        if not (is_of_model and plugin.name and library.startswith("libgazebo_ros")):
            continue
        spaces = [one.text.strip() for one in plugin.element.walk() if one.tag == "namespace"]
        key = (spaces[0] if spaces else "", plugin.name)
        if key in seen:
            yield Problem(
                plugin.element,
                f"another plugin also has the name '{plugin.name}'; make it unique",
                at=plugin.locate_attribute("name"),
            )
        seen.add(key)


@duplicate_plugin_name.fix(UNSAFE)
def number_plugin(problem: Problem, context: FixContext) -> Proposal | None:
    """Append a number to the duplicate name."""
    return append_number(problem, {plugin.name for plugin in context.robot.plugins})
