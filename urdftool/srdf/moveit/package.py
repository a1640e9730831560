"""MoveIt configuration package: its new files, and edits of those that exist."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import ConfigError
from ...model.elements import Joint
from ...model.moveit_parameters import MANAGER
from ...model.start import list_initial_positions
from ...source.edit import Edit, apply
from ...source.location import SourceFile
from ...source.nearby_files import read_optional_file
from ...source.yaml_tree import Node, is_blank, parse_yaml
from ...workspace import Workspace
from ..states import get_default_position, is_within
from .configuration import Configuration
from .controllers import (
    PlannedController,
    add_missing,
    get_sections,
    make_moveit_controllers,
    make_ros2_controllers,
    plan_controllers,
    read_moveit_controllers,
    read_ros2_controllers,
)
from .description_files import (
    complete_mock_hardware,
    list_mock_joints,
    make_description,
    make_mock_hardware,
)
from .existing_srdf import SrdfChanges
from .package_files import make_assistant_settings, make_build_file, make_manifest, make_rviz
from .yaml_text import Commented, Tree, Value, append_items, complete, format_yaml

_MOVEIT, _ROS2 = "config/moveit_controllers.yaml", "config/ros2_controllers.yaml"


@dataclass
class PackageFile:
    """File of a package."""

    path: str
    data: bytes
    before: bytes | None = None
    added: list[str] = field(default_factory=list)


class PackageFiles:
    """Files of a package that is made or completed."""

    def __init__(self, folder: Path, workspace: Workspace) -> None:
        """Begin without files."""
        self.folder = folder
        self._workspace = workspace
        self.files: list[PackageFile] = []
        self.srdf: SrdfChanges | None = None

    def read(self, path: str) -> SourceFile | None:
        """Read an existing file of the package; None if there is none."""
        return read_optional_file(self._workspace, self.folder / path)

    def read_parameters(self, path: str) -> Node | None:
        """Read an existing parameter file; None if there is none, or only comments in it.

        Raises:
            ConfigError: It is not a YAML mapping.
        """
        file = self.read(path)
        return None if file is None or is_blank(file) else parse_yaml(file)

    def add_text(self, path: str, text: str) -> None:
        """Add a file; an existing one is kept as it is."""
        file = self.read(path)
        if file is None:
            self.files.append(PackageFile(path, text.encode()))
        else:
            self.files.append(PackageFile(path, file.data, file.data))

    def add_parameters(self, path: str, tree: Tree, *comments: str) -> None:
        """Add a parameter file; an existing one gets the keys that it lacks."""
        file = self.read(path)
        root = self.read_parameters(path)
        if file is None:
            self.add_text(path, format_yaml(tree, comments))
        elif root is None:
            data = file.data.rstrip() + b"\n" + format_yaml(tree).encode()
            self.files.append(PackageFile(path, data.lstrip(), file.data, list(tree)))
        else:
            self.add_edits(path, root.file, complete(root, tree))

    def add_edits(self, path: str, file: SourceFile, edits: Iterable[tuple[str, Edit]]) -> None:
        """Add an existing file with edits, each with what it adds."""
        found = list(edits)
        data = apply(file, [edit for _, edit in found])
        self.files.append(PackageFile(path, data, file.data, [what for what, _ in found]))


def make_package(configuration: Configuration, files: PackageFiles) -> None:
    """Add all files of a MoveIt configuration package but its SRDF.

    Raises:
        ConfigError: An existing parameter file is not a YAML mapping.
    """
    controllers = _merge_controllers(configuration, files)
    files.add_text("package.xml", make_manifest(configuration, controllers))
    files.add_text("CMakeLists.txt", make_build_file(configuration))
    files.add_text(".setup_assistant", make_assistant_settings(configuration))
    stem = f"config/{configuration.stem}"
    files.add_text(f"{stem}.urdf.xacro", make_description(configuration))
    if list_mock_joints(configuration):
        _add_mock_hardware(configuration, files, f"{stem}.ros2_control.xacro")
        positions = _make_initial_positions(configuration)
        files.add_parameters(
            "config/initial_positions.yaml", positions, "Where mock hardware starts"
        )
    _add_parameter_files(configuration, files)
    _add_controllers(files, controllers)
    files.add_text("config/moveit.rviz", make_rviz(configuration))
    for path, text in make_launch_files(configuration):
        files.add_text(path, text)


def _add_mock_hardware(configuration: Configuration, files: PackageFiles, path: str) -> None:
    file = files.read(path)
    if file is None:
        files.add_text(path, make_mock_hardware(configuration))
    else:
        files.add_edits(path, file, complete_mock_hardware(configuration, file))


def _add_parameter_files(configuration: Configuration, files: PackageFiles) -> None:
    files.add_parameters(
        "config/joint_limits.yaml",
        _make_joint_limits(configuration),
        "Limits of MoveIt; numbers must be doubles: 3.0, not 3.",
        "Increase the scaling factors up to 1.0 for full speed.",
    )
    kinematics = _make_kinematics(configuration)
    if kinematics or files.read("config/kinematics.yaml") is None:
        files.add_parameters("config/kinematics.yaml", kinematics)
    files.add_parameters(
        "config/pilz_cartesian_limits.yaml",
        _CARTESIAN_LIMITS,
        "Limits of the tip for the Pilz planner [m/s, m/s^2, rad/s]: guesses, not of this robot",
    )


def _merge_controllers(
    configuration: Configuration, files: PackageFiles
) -> list[PlannedController]:
    """List the controllers of existing files, and those for the joints that they lack."""
    ros2, moveit = files.read_parameters(_ROS2), files.read_parameters(_MOVEIT)
    gripper = configuration.distribution.gripper_controller
    known: list[PlannedController] = []
    if ros2 is not None:
        known += read_ros2_controllers(ros2)
    if moveit is not None:
        known = add_missing(known, read_moveit_controllers(moveit, gripper))
    return add_missing(known, plan_controllers(configuration))


def _add_controllers(files: PackageFiles, controllers: list[PlannedController]) -> None:
    ros2, moveit = files.read_parameters(_ROS2), files.read_parameters(_MOVEIT)
    known = [] if ros2 is None else list(read_ros2_controllers(ros2))
    names = {one.name for one in known}
    lacking = [one for one in controllers if one.name not in names]
    files.add_parameters(_ROS2, make_ros2_controllers(lacking))
    if moveit is None:
        files.add_parameters(_MOVEIT, make_moveit_controllers(controllers))
    else:
        files.add_edits(_MOVEIT, moveit.file, _complete_moveit(moveit, controllers))


def _complete_moveit(
    root: Node, controllers: list[PlannedController]
) -> Iterator[tuple[str, Edit]]:
    """Yield the edits of an existing list of controllers: new ones, and lacking keys."""
    sections = get_sections(root)
    used = {
        node.text
        for section in sections.values()
        for node in (section.fields or {}).get("joints", section).items or ()
    }
    written = [one for one in controllers if one.name in sections or not used & set(one.joints)]
    yield from complete(root, make_moveit_controllers(written))
    listed = root.find(MANAGER, "controller_names")
    present = {node.text for node in (listed.items if listed is not None else None) or ()}
    lacking = [one.name for one in written if one.name not in present]
    if listed is not None and lacking:
        if listed.items is None:
            raise ConfigError("controller_names is not a list", at=listed.place)
        yield f"controller_names: {', '.join(lacking)}", append_items(listed, lacking)


LAUNCHES = (
    "demo",
    "move_group",
    "moveit_rviz",
    "rsp",
    "setup_assistant",
    "spawn_controllers",
    "static_virtual_joint_tfs",
    "warehouse_db",
)
"""Launch files that ``moveit_configs_utils.launches`` makes, by the name of its function.
``generate_demo_launch`` includes six of them by these names."""

_TEXT = """\
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_{name}_launch


def generate_launch_description():
    builder = MoveItConfigsBuilder({stem!r}, package_name={package!r})
    return generate_{name}_launch(builder.to_moveit_configs())
"""


def make_launch_files(configuration: Configuration) -> Iterator[tuple[str, str]]:
    """Yield the path in the package and the text of each launch file."""
    for name in LAUNCHES:
        text = _TEXT.format(name=name, stem=configuration.stem, package=configuration.package)
        yield f"launch/{name}.launch.py", text


_RAMP = 0.5
"""Time to reach the velocity limit at the guessed acceleration [s]; chosen, no source."""

_VELOCITY = 1.0
"""Guessed velocity limit of a joint without one [rad/s, m/s]; chosen, no source."""

_FULL_POSE = 6
"""Least number of joints with which a chain reaches poses of any orientation."""

_LEAST_JOINTS = 3
"""Least number of joints of a chain that gets a solver; chosen, no source."""

_CARTESIAN_LIMITS: Tree = {
    "cartesian_limits": {
        "max_trans_vel": 1.0,
        "max_trans_acc": 2.25,
        "max_trans_dec": -5.0,
        "max_rot_vel": 1.57,
    }
}
"""Limits for Pilz [m/s, m/s², m/s², rad/s], the values of MoveIt's Setup Assistant."""


def _make_joint_limits(configuration: Configuration) -> Tree:
    """Make the content of ``joint_limits.yaml``: velocities of the description, accelerations."""
    limits = {joint.name: _make_limits(joint) for joint in configuration.active_joints}
    return {
        "default_velocity_scaling_factor": 0.1,
        "default_acceleration_scaling_factor": 0.1,
        "joint_limits": limits,
    }


def _make_limits(joint: Joint) -> Tree:
    written = joint.get_magnitude("velocity") or 0.0
    has = 0.0 < written < float("inf")
    velocity = written if has else _VELOCITY
    guess = "guess: the description has no velocity limit"
    acceleration = float(f"{velocity / _RAMP:.6g}")
    return {
        "has_velocity_limits": True,
        "max_velocity": float(velocity) if has else Commented(velocity, guess),
        "has_acceleration_limits": True,
        "max_acceleration": Commented(acceleration, "guess: URDF has no acceleration limits"),
    }


def _make_kinematics(configuration: Configuration) -> Tree:
    """Make the content of ``kinematics.yaml``: a solver for each chain."""
    found: dict[str, Tree] = {}
    for name, group in configuration.groups.items():
        count = len(configuration.list_group_joints(group))
        if len(group.chains) == 1 and not group.groups and count >= _LEAST_JOINTS:
            found[name] = _make_solver(count)
    return found


def _make_solver(count: int) -> Tree:
    solver: dict[str, Value] = {
        "kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
        "kinematics_solver_search_resolution": 0.005,
        "kinematics_solver_timeout": 0.05,
    }
    if count < _FULL_POSE:
        comment = f"{count} joints do not reach every orientation"
        solver["position_only_ik"] = Commented(True, comment)
    return solver


def _make_initial_positions(configuration: Configuration) -> Tree:
    """Make the content of ``initial_positions.yaml``, where mock hardware starts."""
    robot = configuration.robot
    known = list_initial_positions(robot)
    found: dict[str, float] = {}
    for joint in configuration.active_joints:
        value = known.get(joint.name)
        if value is None or not is_within(robot, joint.name, value):
            value = get_default_position(robot, joint)
        found[joint.name] = float(value or 0.0)
    return {"initial_positions": found}
