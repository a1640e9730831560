"""Plan of a MoveIt configuration package: which robot, which names, what exists."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from ...errors import ConfigError, ModelError, SourceError
from ...model.elements import Robot
from ...model.semantic import Group, SemanticDescription, read_semantic
from ...source.description import read_description
from ...source.packages import find_own_package
from ...workspace import Workspace
from ..groups import GivenGroup, find_groups
from ..name_parts import make_identifier
from .configuration import Configuration, DescriptionFile
from .distributions import DISTRIBUTIONS
from .existing_srdf import DecidePairs, complete_srdf
from .package import PackageFile, PackageFiles, make_package

MakeSrdf = Callable[[], tuple[SemanticDescription, str]]


def plan_package(
    robot: Robot,
    folder: Path,
    distribution: str,
    make_srdf: MakeSrdf,
    decide: DecidePairs,
    given: Sequence[GivenGroup] = (),
) -> tuple[Configuration, PackageFiles]:
    """Plan all files of the MoveIt configuration package of a robot.

    Existing files are kept; existing parameter files get the keys that they lack. An existing SRDF
    gets the groups that it lacks, and its pairs are updated; the other files match its groups.

    Raises:
        ModelError: The robot was not read from a URDF or xacro file.
        ConfigError: An existing file of the package cannot be completed, or there are no groups.
    """
    description = _locate_description(robot)
    workspace = Workspace()
    files = PackageFiles(folder, workspace)
    path = _find_srdf(folder, robot, workspace)
    exists = workspace.is_file(folder / path)
    if not exists:
        require_groups(find_groups(robot, given).groups)  # before the pairs are decided
    semantic, text = _read_srdf(folder / path, workspace) if exists else make_srdf()
    configuration = Configuration(
        robot,
        semantic,
        description,
        _name_package(folder),
        path.name.split(".")[0],
        DISTRIBUTIONS[distribution],
    )
    data = text.encode()
    if exists:
        completed = complete_srdf(configuration, folder / path, given, decide)
        configuration = replace(configuration, semantic=completed[0])
        data, files.srdf = completed[1:]
    require_groups(configuration.semantic.groups)
    before = semantic.element.file.data if exists else None
    files.files.append(PackageFile(path.as_posix(), data, before))
    make_package(configuration, files)
    return configuration, files


def require_groups(groups: Sequence[Group]) -> None:
    """Check that there is a planning group.

    Raises:
        ConfigError: There is none.
    """
    if not groups:
        raise ConfigError(
            "no planning group was found, and MoveIt plans only for groups; "
            "give one with --group NAME=BASE:TIP"
        )


def _locate_description(robot: Robot) -> DescriptionFile:
    source = robot.source
    if source is None or robot.format != "urdf" or source.path == "-":
        raise ModelError(
            "a MoveIt configuration includes the URDF or xacro file of its robot; "
            "convert the robot with 'urdftool export urdf' first"
        )
    own = source.packages.own
    path = Path(source.path).resolve()
    if own is None:
        return DescriptionFile("", path.as_posix(), source.arguments)
    name, folder = own
    return DescriptionFile(name, path.relative_to(folder.resolve()).as_posix(), source.arguments)


def _find_srdf(folder: Path, robot: Robot, workspace: Workspace) -> Path:
    """Find the SRDF of a package: its only one, else the one that is named for the robot.

    Raises:
        ConfigError: The package has several, and none is named for the robot.
    """
    named = Path("config", f"{make_identifier(robot.name) or 'robot'}.srdf")
    found = sorted(
        path.relative_to(folder)
        for pattern in ("config/*.srdf", "config/*.srdf.xacro")
        for path in workspace.list_matches(folder, pattern)
    )
    if len(found) > 1 and named not in found:
        names = ", ".join(path.name for path in found)
        raise ConfigError(
            f"has several SRDF files ({names}), and none is named {named.name} for the robot; "
            "use another folder",
            path=folder,
        )
    return named if named in found or not found else found[0]


def _read_srdf(path: Path, workspace: Workspace) -> tuple[SemanticDescription, str]:
    """Read an existing SRDF: its content, and its text.

    Raises:
        SourceError: It cannot be read, or is not an SRDF.
    """
    root = read_description(path, workspace=workspace).document.root
    if root.tag != "robot":
        raise SourceError(
            f"the root element is <{root.tag}>; an SRDF file starts with <robot>", at=root.place
        )
    return read_semantic(root), workspace.read_text(path)


def _name_package(folder: Path) -> str:
    """Return the name of an existing package; for a new one a valid name from its folder."""
    own = find_own_package(folder / "package.xml")
    if own is not None and own[1].resolve() == folder.resolve():
        return own[0]
    name = re.sub("_+", "_", make_identifier(folder.resolve().name).lower()).strip("_")
    return name if re.match("[a-z]", name) else f"moveit_{name}".rstrip("_")
