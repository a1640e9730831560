"""Manifest, build file and settings of a MoveIt configuration package."""

from __future__ import annotations

from ...source.escape import escape
from .configuration import Configuration
from .controllers import PlannedController
from .yaml_text import Tree, format_scalar, format_yaml

_DEPENDENCIES = (
    "controller_manager",
    "joint_state_broadcaster",
    "moveit_configs_utils",
    "moveit_kinematics",
    "moveit_planners",
    "moveit_ros_move_group",
    "moveit_ros_visualization",
    "moveit_ros_warehouse",
    "moveit_setup_assistant",
    "moveit_simple_controller_manager",
    "robot_state_publisher",
    "rviz2",
    "rviz_common",
    "rviz_default_plugins",
    "tf2_ros",
    "xacro",
)

_CMAKE = """\
cmake_minimum_required(VERSION 3.22)
project({name})

find_package(ament_cmake REQUIRED)

install(DIRECTORY config launch DESTINATION share/${{PROJECT_NAME}})
install(FILES .setup_assistant DESTINATION share/${{PROJECT_NAME}})

ament_package()
"""


def make_manifest(configuration: Configuration, controllers: list[PlannedController]) -> str:
    """Make ``package.xml``, with the packages that the files of this package use."""
    used = {*_DEPENDENCIES, configuration.description.package} - {""}
    for one in controllers:
        gripper = one.kind == configuration.distribution.gripper_controller
        package = configuration.distribution.gripper_package if gripper else ""
        used.add(package or one.kind.partition("/")[0])
    lines = [f"  <exec_depend>{escape(name)}</exec_depend>" for name in sorted(used)]
    robot = escape(configuration.robot.name)
    return "\n".join(
        [
            '<?xml version="1.0"?>',
            '<package format="3">',
            f"  <name>{configuration.package}</name>",
            "  <version>0.1.0</version>",
            f"  <description>MoveIt configuration of {robot}</description>",
            '  <maintainer email="todo@todo.todo">TODO</maintainer>',
            "  <license>TODO</license>",
            "",
            "  <buildtool_depend>ament_cmake</buildtool_depend>",
            "",
            *lines,
            "",
            "  <export>",
            "    <build_type>ament_cmake</build_type>",
            "  </export>",
            "</package>",
            "",
        ]
    )


def make_build_file(configuration: Configuration) -> str:
    """Make ``CMakeLists.txt``, which installs the folders of the package."""
    return _CMAKE.format(name=configuration.package)


def make_assistant_settings(configuration: Configuration) -> str:
    """Make ``.setup_assistant``, with which MoveIt's Setup Assistant opens the package.

    The time of generation is 0, so that the assistant takes each file for edited by hand.
    """
    description = configuration.description
    urdf: dict[str, str] = {"package": description.package, "relative_path": description.path}
    if description.arguments:
        pairs = (f"{name}:={value}" for name, value in description.arguments.items())
        urdf["xacro_args"] = " ".join(pairs)
    settings: Tree = {
        "moveit_setup_assistant_config": {
            "urdf": urdf,
            "srdf": {"relative_path": f"config/{configuration.stem}.srdf"},
            "package_settings": {
                "author_name": "TODO",
                "author_email": "todo@todo.todo",
                "generated_timestamp": 0,
            },
        }
    }
    return format_yaml(settings)


def make_rviz(configuration: Configuration) -> str:
    """Make ``moveit.rviz``: the robot, its motion planning panel and a grid."""
    frame = format_scalar(find_planning_frame(configuration))
    return _RVIZ.replace("@FRAME@", frame)


def find_planning_frame(configuration: Configuration) -> str:
    """Find the frame of the robot model in MoveIt: the world, or the root link."""
    root = configuration.robot.tree.root
    name = root.name if root is not None else "world"
    joints = configuration.semantic.virtual_joints
    return next((one.parent_frame for one in joints if one.child_link == name), name)


_RVIZ = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
  - Class: rviz_common/Views
    Name: Views
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Name: Grid
      Value: true
    - Class: moveit_rviz_plugin/MotionPlanning
      Name: MotionPlanning
      Planned Path:
        Loop Animation: true
        State Display Time: 0.05 s
        Trajectory Topic: display_planned_path
      Planning Scene Topic: monitored_planning_scene
      Robot Description: robot_description
      Value: true
  Global Options:
    Fixed Frame: @FRAME@
  Tools:
    - Class: rviz_default_plugins/Interact
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/Select
  Value: true
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 2
      Name: Current View
      Pitch: 0.5
      Target Frame: @FRAME@
      Yaw: 0.6
"""
