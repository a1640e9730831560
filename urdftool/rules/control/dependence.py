"""Tell whether the package of a robot uses ros_control or ros2_control."""

from __future__ import annotations

from ...source.description import Description
from ...source.nearby_files import read_optional_document

OF_CLASSIC = ("gazebo_ros_control",)
OF_ROS2 = (
    *("ros2_control", "ros2_controllers", "controller_manager", "hardware_interface"),
    *("gazebo_ros2_control", "gz_ros2_control", "ign_ros2_control"),
)
OF_GAZEBO = (*OF_CLASSIC, "gazebo_ros2_control", "gz_ros2_control", "ign_ros2_control")


def depends_on_control(description: Description, names: tuple[str, ...] = OF_CLASSIC) -> bool:
    """Tell whether the package of a description depends on one of these packages."""
    own = description.packages.own
    if own is None:
        return False
    manifest = read_optional_document(description.workspace, own[1] / "package.xml")
    return manifest is not None and any(
        one.tag.endswith("depend") and one.text.strip() in names for one in manifest.root.children
    )
