"""A stand-in for ``moveit_configs_utils``, which no package index has without ROS.

It follows ``MoveItConfigsBuilder.to_moveit_configs`` of moveit2 (``moveit_configs_builder.py`` and
``load_yaml`` of ``launch_param_builder``): which files are read, which must exist, and how one of
several is chosen. Files pass through Jinja there; here they must have no Jinja tag. The description
and the SRDF are expanded by urdftool instead of xacro. That a node starts with the result is not
shown by it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from urdftool.model.elements import Robot
from urdftool.model.load import load
from urdftool.source.description import read_description

JINJA = re.compile(r"\{\{|\{%|\{#")


class MoveItConfigs:
    """What the builder loads of a package."""

    def __init__(self, package: Path, stem: str, packages: Mapping[str, Path]) -> None:
        """Load a package.

        Args:
            package: Its folder.
            stem: Name of the robot that the launch files pass.
            packages: Folders of other packages by name.
        """
        self.config = package / "config"
        settings = load_yaml(package / ".setup_assistant")["moveit_setup_assistant_config"]
        description = self.config / f"{stem}.urdf.xacro"
        assert description.is_file(), "the builder prefers this file"
        self.robot: Robot = load(description, packages=packages)
        srdf = package / settings["srdf"]["relative_path"]
        self.semantic = read_description(srdf).document.root
        self.kinematics = load_yaml(self.config / "kinematics.yaml")
        self.joint_limits = load_yaml(self.config / "joint_limits.yaml")
        self.pilz = load_yaml(self.config / "pilz_cartesian_limits.yaml")
        self.trajectory_execution = load_yaml(self._choose_controllers(stem))
        self.spawned = [
            *self.trajectory_execution["moveit_simple_controller_manager"]["controller_names"],
            "joint_state_broadcaster",
        ]
        self.ros2_controllers = load_yaml(self.config / "ros2_controllers.yaml")

    def _choose_controllers(self, stem: str) -> Path:
        names = [path.name for path in self.config.glob("*_controllers.yaml")]
        found = [n for n in ("moveit", "moveit2", stem) if f"{n}_controllers.yaml" in names]
        assert found, "the builder finds no controllers"
        return self.config / f"{found[0]}_controllers.yaml"


def load_yaml(path: Path) -> Any:
    """Load a parameter file, which must exist, as ``launch_param_builder`` does."""
    text = path.read_text("utf-8")
    assert not JINJA.search(text)
    return yaml.load(text, Loader=yaml.FullLoader)


DOUBLE, BOOL, TEXT, TEXTS, INTEGER = float, bool, str, list, int

DECLARED = {
    "joint_limits": {
        "default_velocity_scaling_factor": DOUBLE,
        "default_acceleration_scaling_factor": DOUBLE,
        "joint_limits.*.has_velocity_limits": BOOL,
        "joint_limits.*.max_velocity": DOUBLE,
        "joint_limits.*.has_acceleration_limits": BOOL,
        "joint_limits.*.max_acceleration": DOUBLE,
    },
    "kinematics": {
        "*.kinematics_solver": TEXT,
        "*.kinematics_solver_search_resolution": DOUBLE,
        "*.kinematics_solver_timeout": DOUBLE,
        "*.position_only_ik": BOOL,
    },
    "pilz": {
        "cartesian_limits.max_trans_vel": DOUBLE,
        "cartesian_limits.max_trans_acc": DOUBLE,
        "cartesian_limits.max_trans_dec": DOUBLE,
        "cartesian_limits.max_rot_vel": DOUBLE,
    },
    "trajectory_execution": {
        "moveit_controller_manager": TEXT,
        "trajectory_execution.allowed_execution_duration_scaling": DOUBLE,
        "trajectory_execution.allowed_goal_duration_margin": DOUBLE,
        "trajectory_execution.allowed_start_tolerance": DOUBLE,
        "moveit_simple_controller_manager.controller_names": TEXTS,
        "moveit_simple_controller_manager.*.action_ns": TEXT,
        "moveit_simple_controller_manager.*.type": TEXT,
        "moveit_simple_controller_manager.*.default": BOOL,
        "moveit_simple_controller_manager.*.joints": TEXTS,
    },
    "ros2_controllers": {
        "controller_manager.ros__parameters.update_rate": INTEGER,
        "controller_manager.ros__parameters.*.type": TEXT,
        "*.ros__parameters.joints": TEXTS,
        "*.ros__parameters.joint": TEXT,
        "*.ros__parameters.command_interfaces": TEXTS,
        "*.ros__parameters.state_interfaces": TEXTS,
    },
}
"""Types of the parameters that the files may have, from the declarations in moveit2
(``robot_model_loader.cpp``, ``kinematics_parameters.yaml``, ``kdl_kinematics_parameters.yaml``,
``cartesian_limits_parameters.yaml``, ``trajectory_execution_manager.cpp``,
``moveit_simple_controller_manager_parameters.yaml``) and ros2_controllers."""


def list_undeclared(configs: MoveItConfigs) -> list[str]:
    """List the parameters of the files that are not declared, or have another type."""
    wrong = []
    for name, declared in DECLARED.items():
        for path, value in _walk(getattr(configs, name) or {}, ()):
            patterns = [p for p in declared if _matches(p.split("."), path)]
            if not patterns or type(value) is not declared[patterns[0]]:
                wrong.append(f"{name}: {'.'.join(path)} = {value!r}")
    return wrong


def _walk(tree: Any, path: tuple[str, ...]) -> Any:
    if not isinstance(tree, dict):
        yield path, tree
        return
    for key, value in tree.items():
        assert isinstance(key, str), key
        yield from _walk(value, (*path, key))


def _matches(pattern: list[str], path: tuple[str, ...]) -> bool:
    return len(pattern) == len(path) and all(
        one in ("*", other) for one, other in zip(pattern, path, strict=True)
    )
