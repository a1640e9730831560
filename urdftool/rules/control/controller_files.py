"""Find the controller files of a robot: referred to by a plugin, by launch files, or alone."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ...errors import AccessError, PackageNotFound
from ...model.controllers import Controller, list_controllers
from ...model.elements import Robot
from ...source.comments import blank_comments, list_spans
from ...source.description import Description
from ...source.location import SourceFile
from ...source.nearby_files import read_optional_file
from ...source.yaml_tree import Node
from ...workspace import Workspace
from ..unread_files import read_parameters

_FOLDERS = ("config", "controllers", "control", "bringup/config", "params", "launch")
_CONTROLLER = re.compile(rb"\btype[\"']?\s*:\s*[\"']?\w+(?:/|::)\w")
_FIND = re.compile(r"^\$\(find(?:-pkg-share)?\s+([\w-]+)\s*\)/")
_TOP = re.compile(rb"<robot\b[^<>]*\sname\s*=")
_MOST_FILES, _MOST_ENTRIES, _MOST_BYTES = 60, 3000, 1_000_000
"""Numbers of files and of entries of folders, and size of a file [bytes], that are searched.
Chosen, no source.
"""


class ControllerFile(NamedTuple):
    """A file with controllers for a robot.

    Attributes:
        file: The file.
        root: Its content.
        controllers: The controllers in it.
        by_plugin: Whether a plugin of the robot refers to it.
        by_launch: Whether a launch file refers to it and to the description.
        shared: Whether other robots of the package may use it.
    """

    file: SourceFile
    root: Node
    controllers: list[Controller]
    by_plugin: bool
    by_launch: bool
    shared: bool


class Package:
    """Files of the package that contains a description, read on demand."""

    def __init__(self, robot: Robot, description: Description) -> None:
        """Find the folder of the package."""
        self.robot = robot
        self.description = description
        self.workspace = description.workspace
        own = None if description.path == "-" else description.packages.own
        self.folder = None if own is None else own[1]

    @cached_property
    def own(self) -> set[str]:
        """The resolved paths of the files of the description."""
        return {self.workspace.resolve_links(file.path) for file in self.description.files}

    @cached_property
    def controller_files(self) -> list[ControllerFile]:
        """The controller files of the robot."""
        return list(_find_controller_files(self.robot, self))

    @cached_property
    def launch_files(self) -> list[SourceFile]:
        """The text files in ``launch``, up to a limit of number and size."""
        if self.folder is None:
            return []
        workspace = self.workspace
        found = workspace.list_matches(self.folder / "launch", "**/*")[:_MOST_FILES]
        files = [read_optional_file(workspace, path) for path in found if workspace.is_file(path)]
        return [file for file in files if file is not None and len(file.data) < _MOST_BYTES]

    @cached_property
    def other_files(self) -> list[SourceFile] | None:
        """Other ``.urdf`` and ``.xacro`` files of the package; None if too many."""
        if self.folder is None:
            return []
        entries, found = 0, []
        workspace = self.workspace
        for root, folders, names in workspace.walk(self.folder):
            folders[:] = [name for name in folders if not name.startswith(".")]
            entries += len(names) + len(folders)
            if entries > _MOST_ENTRIES:
                return None
            paths = [Path(root, name) for name in names if name.endswith((".urdf", ".xacro"))]
            others = [path for path in paths if workspace.resolve_links(path) not in self.own]
            found += [path for path in others if workspace.is_file(path)]
        if len(found) > _MOST_FILES:
            return None
        return [file for path in found if (file := read_optional_file(workspace, path)) is not None]

    @cached_property
    def other_robots(self) -> list[SourceFile] | None:
        """The ``other_files`` that are different robots; None if too many."""
        if self.other_files is None:
            return None
        stem = _get_stem(self.description.path)
        return [f for f in self.other_files if _get_stem(f.path) != stem and _is_robot(f)]

    def is_shared(self, path: str) -> bool:
        """Tell whether another robot refers to a file, or includes files of this robot."""
        names = [os.path.basename(other) for other in (path, *self.own)]
        mention = _compile_names(*names)
        others = self.other_robots
        if others is None or any(mention.search(other.data) for other in others):
            return True
        named = _compile_names(os.path.basename(path))
        robots = [os.path.basename(other.path) for other in others]
        launches = [file for file in self.launch_files if named.search(file.data)]
        return bool(robots) and any(_compile_names(*robots).search(file.data) for file in launches)

    def is_launched_with(self, path: str) -> bool:
        """Tell whether a launch file refers to the description and to another file."""
        one = _compile_names(self.description.packages.file.name)
        other = _compile_names(os.path.basename(path))
        return any(one.search(file.data) and other.search(file.data) for file in self.launch_files)


def get_package(robot: Robot, description: Description) -> Package:
    """Get the package of a robot, one object for all rules."""
    return robot.memo.get("package", lambda: Package(robot, description))


def _find_controller_files(robot: Robot, package: Package) -> Iterator[ControllerFile]:
    if not robot.ros2_controls and not robot.transmissions:
        return
    workspace = package.workspace
    named = {
        workspace.resolve_links(path) for path in _find_named_by_plugins(robot, package.description)
    }
    beside = {
        workspace.resolve_links(path)
        for path in _list_configuration_files(workspace, package.folder)
    }
    for path in sorted(named | beside):
        file = read_optional_file(workspace, path) if workspace.is_file(path) else None
        by_plugin = path in named
        if file is None or len(file.data) > _MOST_BYTES:
            continue
        if not by_plugin and not _CONTROLLER.search(file.data):
            continue
        by_launch = package.is_launched_with(path)
        if not by_plugin and not by_launch and package.other_robots != []:
            continue
        root = read_parameters(package.robot, file, "controllers" * (by_plugin or by_launch))
        controllers = [] if root is None else list(list_controllers(root))
        if root is not None and controllers:
            is_shared = package.is_shared(path)
            yield ControllerFile(file, root, controllers, by_plugin, by_launch, is_shared)


def _find_named_by_plugins(robot: Robot, description: Description) -> Iterator[Path]:
    for plugin in robot.plugins:
        if "ros2_control" not in plugin.filename:
            continue
        for child in plugin.element.list_children("parameters"):
            path = _FIND.sub(r"package://\1/", child.text.strip())
            if path.startswith(("/", "package://", "file://")):
                try:
                    yield description.resolve(path)
                except (AccessError, PackageNotFound):
                    continue


def _list_configuration_files(workspace: Workspace, package: Path | None) -> list[Path]:
    if package is None:
        return []
    found = [
        path
        for name in _FOLDERS
        for end in ("yaml", "yml")
        for path in workspace.list_matches(package, f"{name}/*.{end}")
    ]
    return [path for path in found[:_MOST_FILES] if workspace.is_file(path)]


def _get_stem(path: str) -> str:
    return os.path.basename(path).split(".")[0]


def _is_robot(file: SourceFile) -> bool:
    """Tell whether a file is a complete robot, and not a part to include."""
    if not _TOP.search(file.data):
        return False
    text, at = blank_comments(file.data), 0
    for begin, end in (*list_spans(text, b"<xacro:macro", b"</xacro:macro"), (len(text), 0)):
        outside = text[at:begin]
        if b"<link" in outside or b"<xacro:" in outside:
            return True
        at = end
    return False


def _compile_names(*names: str) -> re.Pattern[bytes]:
    words = b"|".join(re.escape(name.encode("utf-8", "replace")) for name in names)
    return re.compile(rb"(?<![\w.-])(?:" + words + rb")(?![\w-])")
