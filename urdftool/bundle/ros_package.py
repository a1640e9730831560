"""Files that make a bundle a ROS 2 package: package.xml, CMakeLists.txt, a launch file."""

from __future__ import annotations

import json
from collections.abc import Iterable

from ..model.elements import Robot
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

PACKAGE = Path(__file__).resolve().parents[1]
DESCRIPTION = PACKAGE / "{urdf}"


def generate_launch_description():
    """Start the publishers of the robot and RViz."""
    parameters = [{{"robot_description": DESCRIPTION.read_text(encoding="utf-8")}}]
    return LaunchDescription(
        [
            Node(package="robot_state_publisher", executable="robot_state_publisher",
                 parameters=parameters),
            Node(package="joint_state_publisher_gui", executable="joint_state_publisher_gui"),
            Node(package="rviz2", executable="rviz2",
                 arguments=["-d", str(PACKAGE / "{rviz}")]),
        ]
    )
'''

LAUNCH = "launch/display.launch.py"

_RVIZ = """Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
    - Class: rviz_default_plugins/RobotModel
      Description Source: Topic
      Description Topic:
        Depth: 1
        Durability Policy: Transient Local
        History Policy: Keep Last
        Reliability Policy: Reliable
        Value: /robot_description
      Enabled: true
      Name: RobotModel
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
  Enabled: true
  Global Options:
    Fixed Frame: {root}
  Tools:
    - Class: rviz_default_plugins/MoveCamera
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: {distance:.3g}
      Name: Current View
"""

RVIZ = "rviz/display.rviz"

VIEW_DISTANCE = 3.0
"""Distance of RViz's camera [m]; chosen, no source."""


def make_package_files(
    name: str, robot: Robot, urdf: str, licenses: Iterable[str], folders: Iterable[str]
) -> dict[str, bytes]:
    """Return the files of a ROS 2 package by path."""
    names = list(dict.fromkeys(licenses)) or ["unknown"]
    lines = "\n".join(f"  <license>{escape(text)}</license>" for text in names)
    installed = " ".join(sorted({*folders, "launch", "rviz"}))
    root = next((link.name for link in robot.tree.roots), "base_link")
    return {
        "package.xml": _PACKAGE.format(
            name=name, robot=escape(robot.name), licenses=lines
        ).encode(),
        "CMakeLists.txt": _CMAKE.format(name=name, folders=installed).encode(),
        LAUNCH: _LAUNCH.format(urdf=urdf, rviz=RVIZ).encode(),
        RVIZ: _RVIZ.format(root=json.dumps(root), distance=VIEW_DISTANCE).encode(),
    }
