"""Inference of the simulators and middleware for which a description is made."""

from __future__ import annotations

from pathlib import Path

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


def infer_targets(robot: Robot, description: Description) -> frozenset[str]:
    """Return the targets of which a description has signs.

    Plugins distinguish Gazebo Classic from gz, also those in attributes of old versions; without
    such a plugin, a ``<gazebo>`` tag counts for gz if the targets include ROS 2, else for Gazebo
    Classic. The package.xml distinguishes ROS 1 from ROS 2.
    """
    if robot.format in TARGETS_OF:
        return frozenset(TARGETS_OF[robot.format])
    targets = set(_infer_from_package(description))
    for plugin in robot.plugins:
        name = plugin.filename.rpartition("/")[2]
        if is_for_gz(plugin.element):
            targets.add("gz")
        elif name.startswith(_CLASSIC_PREFIXES):
            targets.add("gazebo-classic")
    libraries = (library.rpartition("/")[2] for library in robot.old_plugins)
    if any(library.startswith(_CLASSIC_PREFIXES) for library in libraries):
        targets.add("gazebo-classic")
    if robot.ros2_controls:
        targets.add("ros2")
        for control in robot.ros2_controls:
            if (control.plugin or "").startswith(("gz_ros2_control/", "ign_ros2_control/")):
                targets.add("gz")
            elif (control.plugin or "").startswith("gazebo_ros2_control/"):
                targets.add("gazebo-classic")
    if any(joint.hardware_interfaces for t in robot.transmissions for joint in t.joints):
        targets.add("ros1")
    if list_blocks(robot) and not targets & {"gz", "gazebo-classic"}:
        targets.add("gz" if "ros2" in targets else "gazebo-classic")
    if robot.element.find_child("mujoco") is not None:
        targets.add("mujoco")
    if description.path != "-" and _has_srdf(description):
        targets.add("moveit")
    return frozenset(targets)


def _infer_from_package(description: Description) -> frozenset[str]:
    own = description.packages.own
    if own is None:
        return frozenset()
    return _read_manifest(description.workspace, own[1] / "package.xml")


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
