"""Files that make a bundle a ROS 2 package: package.xml, CMakeLists.txt, a launch file."""

from __future__ import annotations

from collections.abc import Iterable

from ..source.escape import escape

_PACKAGE = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>Description of the robot {robot}, with its meshes</description>
  <maintainer email="unknown@example.com">unknown</maintainer>
{licenses}
  <buildtool_depend>ament_cmake</buildtool_depend>
  <exec_depend>joint_state_publisher_gui</exec_depend>
  <exec_depend>robot_state_publisher</exec_depend>
  <exec_depend>rviz2</exec_depend>
  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""

_CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name} NONE)
find_package(ament_cmake REQUIRED)
install(DIRECTORY {folders} DESTINATION share/${{PROJECT_NAME}})
install(FILES bundle.json DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""

_LAUNCH = '''"""Show the robot in RViz, with a slider for each joint."""

from pathlib import Path

from launch import LaunchDescription
from launch_ros.actions import Node

DESCRIPTION = Path(__file__).resolve().parents[1] / "{urdf}"


def generate_launch_description():
    """Start the publishers of the robot and RViz."""
    parameters = [{{"robot_description": DESCRIPTION.read_text(encoding="utf-8")}}]
    return LaunchDescription(
        [
            Node(package="robot_state_publisher", executable="robot_state_publisher",
                 parameters=parameters),
            Node(package="joint_state_publisher_gui", executable="joint_state_publisher_gui"),
            Node(package="rviz2", executable="rviz2"),
        ]
    )
'''

LAUNCH = "launch/display.launch.py"


def make_package_files(
    name: str, robot: str, urdf: str, licenses: Iterable[str], folders: Iterable[str]
) -> dict[str, bytes]:
    """Return the files of a ROS 2 package by path.

    Args:
        name: Name of the package.
        robot: Name of the robot.
        urdf: Path of the description in the package.
        licenses: Names of the licenses of the sources.
        folders: Folders to install.
    """
    names = list(dict.fromkeys(licenses)) or ["unknown"]
    lines = "\n".join(f"  <license>{escape(text)}</license>" for text in names)
    installed = " ".join(sorted({*folders, "launch"}))
    return {
        "package.xml": _PACKAGE.format(name=name, robot=escape(robot), licenses=lines).encode(),
        "CMakeLists.txt": _CMAKE.format(name=name, folders=installed).encode(),
        LAUNCH: _LAUNCH.format(urdf=urdf).encode(),
    }
