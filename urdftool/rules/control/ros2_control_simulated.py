"""Rules on ros2_control in Gazebo."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ...errors import AccessError, PackageNotFound
from ...model.elements import Robot
from ...source.description import Description
from ...workspace import Workspace
from ..cross_file_references import check_not_included
from ..fix import (
    FixContext,
    Proposal,
    append_child,
    escape_attribute,
    find_element,
    set_text,
    unsafe,
    write_suggestion,
)
from ..rule import ERROR, GAZEBO, UNSAFE, WARNING, Problem, rule
from ..words import find_nearest, suggest_name

APPLIES_TO = ("ros2_control", "plugin")

_GZ = ("gz_ros2_control/", "ign_ros2_control/")
_CLASSIC = ("gazebo_ros2_control/",)
_GZ_PLUGINS = ("gz_ros2_control", "ign_ros2_control")
_ANY_PLUGINS = ("gazebo_ros2_control", *_GZ_PLUGINS)


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz_ros2_control": "waits for its hardware and loads none",
    },
)
def ros2_control_wrong_sim_plugin(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """The simulated hardware is for a different version of Gazebo.

    ``gazebo_ros2_control/GazeboSystem`` is for Gazebo Classic, ``gz_ros2_control/GazeboSimSystem``
    for new Gazebo. Each version only finds its own class. If both versions are targets, the
    ros2_control plugin of the robot decides.
    """
    if {"gz", "gazebo-classic"} <= targets:
        targets = _find_gazebo_versions(robot)
        if len(targets) != 1:
            return
    for control in robot.ros2_controls:
        plugin = control.plugin or ""
        wrong, right = (
            (_CLASSIC, "gz_ros2_control/GazeboSimSystem")
            if "gz" in targets
            else (_GZ, "gazebo_ros2_control/GazeboSystem")
        )
        hardware = control.element.find_child("hardware")
        if plugin.startswith(wrong) and hardware is not None:
            yield Problem(
                control.element,
                f"'{plugin}' is for a different version of Gazebo; write {right}",
                at=hardware.find_child("plugin"),
                data={"write": right},
            )


@ros2_control_wrong_sim_plugin.fix(UNSAFE)
def write_hardware(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the class of the target version of Gazebo."""
    element = find_element(problem)
    right = problem.data["write"]
    if element is None or element.tag != "plugin":
        return None
    return unsafe(f"write {right}", set_text(element, right))


def _find_gazebo_versions(robot: Robot) -> frozenset[str]:
    """Find the versions of Gazebo for which a plugin runs ros2_control."""
    names = [plugin.filename for plugin in robot.plugins]
    found = {"gz" for name in names if any(word in name for word in _GZ_PLUGINS)}
    found |= {"gazebo-classic" for name in names if "gazebo_ros2_control" in name}
    return frozenset(found)


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz_ros2_control": (
            "starts no controller_manager without the plugin, and waits for hardware without "
            "the hardware"
        ),
    },
)
def ros2_control_sim_plugin_pair(robot: Robot) -> Iterator[Problem]:
    """Simulated hardware without a ros2_control plugin, or a plugin without hardware.

    Both are required: the plugin in ``<gazebo>`` starts the controller_manager inside Gazebo, and
    the hardware in ``<ros2_control>`` moves the joints.
    """
    simulated = [
        control
        for control in robot.ros2_controls
        if (control.plugin or "").startswith(_GZ + _CLASSIC)
    ]
    plugins = [
        plugin
        for plugin in robot.plugins
        if any(word in plugin.filename for word in (*_ANY_PLUGINS, "_ros2_control"))
    ]
    if simulated and not plugins:
        first = simulated[0]
        classic = (first.plugin or "").startswith(_CLASSIC)
        library = "libgazebo_ros2_control.so" if classic else "gz_ros2_control-system"
        yield Problem(
            first.element,
            f"ros2_control '{first.name}' has simulated hardware, but no Gazebo plugin runs it; "
            f'add one with filename="{library}"',
            data={"plugin": library},
        )
    elif plugins and not any(control.plugin for control in robot.ros2_controls):
        yield Problem(
            plugins[0].element,
            f"plugin '{plugins[0].name}' runs ros2_control, but the robot has no "
            "<ros2_control> block",
        )


_RUNS = {
    "gz_ros2_control/": ("gz_ros2_control-system", "gz_ros2_control::GazeboSimROS2ControlPlugin"),
    "gazebo_ros2_control/": ("libgazebo_ros2_control.so", "gazebo_ros2_control"),
}


@ros2_control_sim_plugin_pair.fix(UNSAFE)
def add_plugin(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the plugin, if the package has exactly one controller file, which the plugin requires."""
    described = context.description
    own = described.packages.own
    controls = [c for c in context.robot.ros2_controls if c.element is problem.element]
    if own is None or described.expansion is None or not controls:
        return None
    runs = [v for prefix, v in _RUNS.items() if (controls[0].plugin or "").startswith(prefix)]
    found = context.workspace.list_matches(own[1] / "config", "*.y*ml")
    files = [path for path in found if _has_controller_manager(context.workspace, path)]
    if len(files) != 1 or not runs:
        return None
    check_not_included(context)
    file, name = runs[0]
    lines = (
        "<gazebo>",
        f'\t<plugin filename="{file}" name="{name}">',
        f"\t\t<parameters>$(find {own[0]})/config/{escape_attribute(files[0].name)}</parameters>",
        "\t</plugin>",
        "</gazebo>",
    )
    return unsafe(
        f"add it with the controllers of config/{files[0].name}",
        append_child(context.robot.element, *lines),
    )


def _has_controller_manager(workspace: Workspace, path: Path) -> bool:
    """Tell whether a file has the parameters of a controller_manager."""
    try:
        data = workspace.read_bytes(path)
    except OSError:
        return False
    return re.search(rb"^\W*controller_manager\W*:", data, re.MULTILINE) is not None


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz_ros2_control": "fails to initialize: found an empty parameters file",
    },
)
def ros2_control_empty_parameters(robot: Robot, description: Description) -> Iterator[Problem]:
    """The ros2_control plugin has no controller file, or the file does not exist.

    ``<parameters>`` is the path of the YAML file with the controllers. The plugin fails if it is
    empty; if the file does not exist, no controller can be loaded.
    """
    for plugin in robot.plugins:
        if not any(word in plugin.filename for word in _ANY_PLUGINS):
            continue
        for child in plugin.element.list_children("parameters"):
            text = child.text.strip()
            if "$(" in text or "${" in text:
                continue
            if not text:
                wrong = "is empty; write the path of the controller file"
            elif text.startswith(("/", "package://")) and not _is_there(text, description):
                wrong = f"refers to '{text}', which does not exist"
            else:
                continue
            yield Problem(
                plugin.element, f"<parameters> of plugin '{plugin.name}' {wrong}", at=child
            )


def _is_there(path: str, description: Description) -> bool:
    try:
        return description.workspace.exists(description.resolve(path))
    except (AccessError, PackageNotFound):
        return True  # cannot be checked


_IMU = tuple(
    f"{what}.{axis}"
    for what, axes in (
        ("orientation", "xyzw"),
        ("angular_velocity", "xyz"),
        ("linear_acceleration", "xyz"),
    )
    for axis in axes
)


@rule(
    ERROR,
    on=("gz",),
    effects={
        "gz_ros2_control": "stops with an exception (std::out_of_range)",
    },
)
def ros2_control_unknown_imu_interface(robot: Robot) -> Iterator[Problem]:
    """A state interface of an IMU is unknown.

    The simulated hardware stops with an exception if a name is not in its table.
    """
    imus = {sensor.name for sensor in robot.sensors if sensor.type == "imu"}
    for control in robot.ros2_controls:
        if not (control.plugin or "").startswith(_GZ):
            continue
        for part in control.components:
            if part.kind != "sensor" or part.name not in imus:
                continue
            for interface in part.state_interfaces:
                if interface.name not in _IMU:
                    yield Problem(
                        control.element,
                        f"sensor '{part.name}' has no state '{interface.name}'"
                        + (
                            suggest_name(interface.name, _IMU)
                            or f"; the states are {', '.join(_IMU)}"
                        ),
                        at=interface.locate_attribute("name"),
                        data={"suggestion": find_nearest(interface.name, _IMU)},
                    )


ros2_control_unknown_imu_interface.fix(UNSAFE)(write_suggestion)


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz_ros2_control": "gives the sensor no interfaces",
    },
)
def sensor_name_mismatch(robot: Robot) -> Iterator[Problem]:
    """A sensor of ``<ros2_control>`` does not exist in Gazebo.

    The simulated hardware finds sensors by name: the ``<sensor>`` in the ``<gazebo>`` block must
    have the same name.
    """
    known = [sensor.name for sensor in robot.sensors]
    for control in robot.ros2_controls:
        if not (control.plugin or "").startswith(_GZ):
            continue
        for part in control.components:
            if part.kind == "sensor" and part.name not in known:
                yield Problem(
                    control.element,
                    f"no <sensor> in a <gazebo> block has the name '{part.name}'"
                    + suggest_name(part.name, known),
                    at=part.locate_attribute("name"),
                    data={"sensor": part.name, "suggestion": find_nearest(part.name, known)},
                )
