"""Inference of the simulators and middleware for which a description is made."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ..model.elements import Robot
from ..model.gazebo_plugins import is_for_gz
from ..model.references import list_blocks
from ..source.comments import remove_comments
from ..source.description import Description
from ..workspace import Workspace, memoize_by_workspace

_CLASSIC_PREFIXES = ("libgazebo_", "libhector_", "libroboticsgroup_", "librotors_gazebo_")
_CLASSIC_DEPENDENCIES = ("gazebo_ros", "gazebo_plugins", "gazebo_ros_pkgs", "gazebo_ros_control")
_GZ_DEPENDENCIES = (
    "ros_gz",
    "ros_gz_sim",
    "gz_ros2_control",
    "ros_ign",
    "ros_ign_gazebo",
    "ros_gz_bridge",
)


TARGETS_OF = {"sdf": ("gz",), "mjcf": ("mujoco",), "usd": ("newton", "isaac")}
"""Targets of a robot in each format other than URDF."""


class Inference(NamedTuple):
    """Targets of a description, and why.

    Attributes:
        targets: The targets.
        overruled: Why a plugin of the other generation of Gazebo is not a target; empty if none is.
    """

    targets: frozenset[str]
    overruled: str = ""


def infer_targets(robot: Robot, description: Description) -> Inference:
    """Return the targets of which a description has signs.

    The generation of Gazebo is that of the package.xml, otherwise that of the launch files of the
    package, otherwise that of hardware in ``<ros2_control>`` and of plugins: new Gazebo if it has
    one of these, because plugins of Gazebo Classic remain when a robot is ported. Without any, a
    ``<gazebo>`` tag counts for gz if the targets include ROS 2, else for Gazebo Classic. The
    package.xml distinguishes ROS 1 from ROS 2; without it, a transmission counts for ROS 1.
    """
    if robot.format in TARGETS_OF:
        return Inference(frozenset(TARGETS_OF[robot.format]))
    own = description.packages.own
    named = _read_manifest(description.workspace, own[1] / "package.xml") if own else frozenset()
    targets = set(named - _GENERATIONS)
    if robot.ros2_controls:
        targets.add("ros2")
    if "ros2" not in targets and any(
        j.hardware_interfaces for t in robot.transmissions for j in t.joints
    ):
        targets.add("ros1")
    generations, overruled = _infer_generations(robot, description, named & _GENERATIONS)
    targets |= generations
    if list_blocks(robot) and not generations:
        targets.add("gz" if "ros2" in targets else "gazebo-classic")
    if robot.element.find_child("mujoco") is not None:
        targets.add("mujoco")
    if description.path != "-" and _has_srdf(description):
        targets.add("moveit")
    return Inference(frozenset(targets), overruled)


_GENERATIONS = frozenset(("gz", "gazebo-classic"))
_NAMES = {"gz": "new Gazebo", "gazebo-classic": "Gazebo Classic"}


def _infer_generations(
    robot: Robot, description: Description, named: frozenset[str]
) -> tuple[frozenset[str], str]:
    """Return the generations of Gazebo, and why one with a plugin is not among them."""
    plugins, source = _list_generations_of_plugins(robot), "package.xml"
    own = description.packages.own
    if not named and len(plugins) > 1 and own is not None:
        named, source = _read_launch_files(description.workspace, own[1]), "a launch file"
    if not named and len(plugins) > 1:
        named, source = frozenset(("gz",)), "another plugin"
    other = plugins - named
    if not named or not other or len(named) > 1:
        return named or plugins, ""
    (is_for,), (is_not,) = named, other
    return named, f"{source} is for {_NAMES[is_for]}, a plugin for {_NAMES[is_not]}"


def _list_generations_of_plugins(robot: Robot) -> frozenset[str]:
    found = set()
    for plugin in robot.plugins:
        if is_for_gz(plugin.element):
            found.add("gz")
        elif plugin.filename.rpartition("/")[2].startswith(_CLASSIC_PREFIXES):
            found.add("gazebo-classic")
    libraries = (library.rpartition("/")[2] for library in robot.old_plugins)
    if any(library.startswith(_CLASSIC_PREFIXES) for library in libraries):
        found.add("gazebo-classic")
    for control in robot.ros2_controls:
        if (control.plugin or "").startswith(("gz_ros2_control/", "ign_ros2_control/")):
            found.add("gz")
        elif (control.plugin or "").startswith("gazebo_ros2_control/"):
            found.add("gazebo-classic")
    return frozenset(found)


_LAUNCHED = {
    "gz": r"\b(?:ros_gz_sim|ros_ign_gazebo|gz_sim\.launch)",
    "gazebo-classic": r"\b(?:gazebo_ros\b|gzserver\b|spawn_entity\.py)",
}
_COMMENT = r"(?m)^\s*#.*$"


@memoize_by_workspace
def _read_launch_files(workspace: Workspace, package: Path) -> frozenset[str]:
    """Return the generations of Gazebo that the launch files of a package start."""
    import re

    found = set()
    for ending in ("*.py", "*.xml", "*.launch", "*.yaml"):
        for path in workspace.list_matches(package / "launch", ending):
            try:
                text = remove_comments(re.sub(_COMMENT, "", workspace.read_text(path)))
            except (OSError, UnicodeDecodeError):
                continue
            found |= {name for name, words in _LAUNCHED.items() if re.search(words, text)}
    return frozenset(found)


def _has_srdf(description: Description) -> bool:
    folder = Path(description.path).parent
    return bool(description.workspace.list_matches(folder, "*.srdf"))


@memoize_by_workspace
def _read_manifest(workspace: Workspace, path: Path) -> frozenset[str]:
    import re

    try:
        text = remove_comments(workspace.read_text(path))
    except OSError:
        return frozenset()
    targets = set()
    words = set(re.findall(r">\s*([\w-]+)\s*</(?:\w*depend|build_type)\s*>", text))
    if any(word.startswith("ament_") for word in words):
        targets.add("ros2")
    elif "catkin" in words:
        targets.add("ros1")
    if words.intersection(_GZ_DEPENDENCIES):
        targets.add("gz")
    if words.intersection(_CLASSIC_DEPENDENCIES):
        targets.add("gazebo-classic")
    return frozenset(targets)
