"""The files with controllers that are for a robot: named by it, by its launch files, or alone."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ...errors import ConfigError, PackageNotFound
from ...model.controllers import Controller, controllers_in
from ...model.elements import Robot
from ...source.description import Description
from ...source.location import SourceFile
from ...source.nearby import file_at
from ...workspace import Workspace

_FOLDERS = ("config", "controllers", "control", "bringup/config", "params", "launch")
_CONTROLLER = re.compile(rb"\btype[\"']?\s*:\s*[\"']?\w+(?:/|::)\w")
_FIND = re.compile(r"^\$\(find(?:-pkg-share)?\s+([\w-]+)\s*\)/")
_TOP = re.compile(rb"<robot\b[^>]*\sname\s*=")
_MACRO = re.compile(rb"<!--.*?-->|<xacro:macro\b.*?</xacro:macro\s*>", re.DOTALL)
_MOST_FILES, _MOST_ENTRIES, _MOST_BYTES = 60, 3000, 1_000_000


class ControllerFile(NamedTuple):
    """A file with controllers for a robot.

    Attributes:
        file: The file.
        controllers: What is in it.
        by_plugin: Whether a plugin of the robot names it.
        by_launch: Whether a launch file names it beside the description.
        shared: Whether it may be for another robot of the package as well.
    """

    file: SourceFile
    controllers: list[Controller]
    by_plugin: bool
    by_launch: bool
    shared: bool


class Package:
    """The files of the package that a description is in, each read when it is asked for."""

    def __init__(self, robot: Robot, description: Description) -> None:
        """Know where it is."""
        self.robot = robot
        self.description = description
        self.workspace = description.workspace
        own = None if description.path == "-" else description.packages.own
        self.folder = None if own is None else own[1]
        self.own = {self.workspace.real_path(file.path) for file in description.files}

    @cached_property
    def controller_files(self) -> list[ControllerFile]:
        """The files with controllers that are for the robot."""
        return list(_found(self.robot, self))

    @cached_property
    def launch_files(self) -> list[SourceFile]:
        """What is in ``launch``, as far as it is text of a likely size."""
        if self.folder is None:
            return []
        workspace = self.workspace
        found = workspace.glob(self.folder / "launch", "**/*")[:_MOST_FILES]
        files = [file_at(workspace, path) for path in found if workspace.is_file(path)]
        return [file for file in files if file is not None and len(file.data) < _MOST_BYTES]

    @cached_property
    def other_files(self) -> list[SourceFile] | None:
        """The ``.urdf`` and ``.xacro`` that the description is not made of; None if too many."""
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
            others = [path for path in paths if workspace.real_path(path) not in self.own]
            found += [path for path in others if workspace.is_file(path)]
        if len(found) > _MOST_FILES:
            return None
        return [file for path in found if (file := file_at(workspace, path)) is not None]

    @cached_property
    def other_robots(self) -> list[SourceFile] | None:
        """Those of them that are robots, and not this one in another form; None if too many."""
        if self.other_files is None:
            return None
        stem = _stem(self.description.path)
        return [f for f in self.other_files if _stem(f.path) != stem and _is_robot(f)]

    def shares(self, path: str) -> bool:
        """Whether another robot names a file, or is made of what this one is made of."""
        names = [os.path.basename(other) for other in (path, *self.own)]
        mention = _mention(*names)
        others = self.other_robots
        if others is None or any(mention.search(other.data) for other in others):
            return True
        named = _mention(os.path.basename(path))
        robots = [os.path.basename(other.path) for other in others]
        launches = [file for file in self.launch_files if named.search(file.data)]
        return bool(robots) and any(_mention(*robots).search(file.data) for file in launches)

    def launches(self, path: str) -> bool:
        """Whether a launch file names the description and another file."""
        one = _mention(self.description.packages.file.name)
        other = _mention(os.path.basename(path))
        return any(one.search(file.data) and other.search(file.data) for file in self.launch_files)


def package_of(robot: Robot, description: Description) -> Package:
    """The package of a robot; the same for all rules that ask."""
    return robot.memo.get("package", lambda: Package(robot, description))


def _found(robot: Robot, package: Package) -> Iterator[ControllerFile]:
    if not robot.ros2_controls and not robot.transmissions:
        return
    workspace = package.workspace
    named = {workspace.real_path(path) for path in _named_by_plugins(robot, package.description)}
    beside = {workspace.real_path(path) for path in _beside(workspace, package.folder)}
    for path in sorted(named | beside):
        file = file_at(workspace, path) if workspace.is_file(path) else None
        if file is None or len(file.data) > _MOST_BYTES or not _CONTROLLER.search(file.data):
            continue
        by_plugin, by_launch = path in named, package.launches(path)
        if not by_plugin and not by_launch and package.other_robots != []:
            continue
        controllers = _read(file)
        if controllers:
            yield ControllerFile(file, controllers, by_plugin, by_launch, package.shares(path))


def _read(file: SourceFile) -> list[Controller]:
    from ...source.yaml_tree import yaml_of

    try:
        return list(controllers_in(yaml_of(file)))
    except ConfigError:
        return []


def _named_by_plugins(robot: Robot, description: Description) -> Iterator[Path]:
    for plugin in robot.plugins:
        if "ros2_control" not in plugin.filename:
            continue
        for child in plugin.element.all("parameters"):
            path = _FIND.sub(r"package://\1/", child.text.strip())
            if path.startswith(("/", "package://", "file://")):
                try:
                    yield description.resolve(path)
                except PackageNotFound:
                    continue


def _beside(workspace: Workspace, package: Path | None) -> list[Path]:
    if package is None:
        return []
    found = [
        path
        for name in _FOLDERS
        for end in ("yaml", "yml")
        for path in workspace.glob(package, f"{name}/*.{end}")
    ]
    return [path for path in found[:_MOST_FILES] if workspace.is_file(path)]


def _stem(path: str) -> str:
    return os.path.basename(path).split(".")[0]


def _is_robot(file: SourceFile) -> bool:
    """Whether a file is a robot by itself, and no part of one."""
    if not _TOP.search(file.data):
        return False
    outside = _MACRO.sub(b"", file.data)
    return b"<link" in outside or b"<xacro:" in outside


def _mention(*names: str) -> re.Pattern[bytes]:
    words = b"|".join(re.escape(name.encode("utf-8", "replace")) for name in names)
    return re.compile(rb"(?<![\w.-])(?:" + words + rb")(?![\w-])")
