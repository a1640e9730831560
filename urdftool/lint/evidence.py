"""Evidence of the targets of a description: which file and line says gz, ROS 2 or MoveIt."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ..model.elements import Robot
from ..model.gazebo_plugins import is_for_gz
from ..model.references import list_blocks
from ..source.comments import blank_comments
from ..source.description import Description
from ..source.description_formats import DESCRIPTION_FORMATS
from ..source.document import Element
from ..source.location import SourceFile
from ..source.nearby_files import read_optional_file
from ..source.packages import shorten_path
from ..workspace import Workspace, memoize_by_workspace

GENERATIONS = frozenset(("gz", "gazebo-classic"))
"""Targets that exclude each other, unless a package.xml depends on both."""

TARGETS_OF = {one.name: one.targets for one in DESCRIPTION_FORMATS if one.targets}
"""Targets of a robot in each format that is made for simulators."""

_CLASSIC_PREFIXES = ("libgazebo_", "libhector_", "libroboticsgroup_", "librotors_gazebo_")
_DEPENDENCIES = {
    "gz": (
        *("ros_gz", "ros_gz_sim", "gz_ros2_control", "ros_ign", "ros_ign_gazebo", "ros_gz_bridge"),
    ),
    "gazebo-classic": ("gazebo_ros", "gazebo_plugins", "gazebo_ros_pkgs", "gazebo_ros_control"),
}
_DEPENDENCY = re.compile(rb">\s*([\w-]+)\s*</(\w*depend|build_type)\s*>")
_LAUNCHED = {
    "gz": re.compile(rb"\b(?:ros_gz_sim|ros_ign_gazebo|gz_sim\.launch)"),
    "gazebo-classic": re.compile(rb"\b(?:gazebo_ros\b|gzserver\b|spawn_entity\.py)"),
}
_COMMENT = re.compile(rb"(?m)^[ \t]*#.*$")
_LOOKUP = rb"\b(?:FindPackageShare|get_package_share_\w+|find-pkg-share|find)"
_LAUNCH_ENDINGS = ("*.py", "*.xml", "*.launch", "*.yaml")


class Evidence(NamedTuple):
    """Statement of one place about a target.

    Attributes:
        target: The target.
        source: Kind of the place: ``package.xml``, ``a launch file`` …
        path: Path of the file.
        line: Line in it, from 1; 0 is the whole file.
        text: What it says, such as ``depends on ros_gz_sim``.
    """

    target: str
    source: str
    path: str
    line: int
    text: str


@dataclass
class Signs:
    """The evidence of a description, each kind read on demand."""

    robot: Robot
    description: Description

    @cached_property
    def package(self) -> Path | None:
        """The folder of the package of the description."""
        own = None if self.description.path == "-" else self.description.packages.own
        return None if own is None else own[1]

    @cached_property
    def manifest(self) -> tuple[Evidence, ...]:
        """What the package.xml of the description says."""
        if self.package is None:
            return ()
        return read_manifest(self.description.workspace, self.package / "package.xml")

    @cached_property
    def launches(self) -> tuple[Evidence, ...]:
        """What the launch files of its package start."""
        if self.package is None:
            return ()
        return read_launch_files(self.description.workspace, self.package)

    @cached_property
    def dependents(self) -> tuple[Evidence, ...]:
        """Statements of packages of the repository whose launch files use its package."""
        own = None if self.package is None else self.description.packages.own
        if own is None:
            return ()
        workspace = self.description.workspace
        found: list[Evidence] = []
        for folder in self.description.packages.list_neighbors():
            if folder != own[1] and _is_package_used(workspace, folder, own[0]):
                manifest = read_manifest(workspace, folder / "package.xml")
                statements = (*manifest, *read_launch_files(workspace, folder))
                found += [one for one in statements if one.target in GENERATIONS]
        return tuple(found)

    @cached_property
    def plugins(self) -> tuple[Evidence, ...]:
        """What plugins and hardware of the robot are made for."""
        return tuple(_list_plugins(self.robot))

    @cached_property
    def elements(self) -> tuple[Evidence, ...]:
        """What elements of the robot are made for, without those of Gazebo."""
        return tuple(_list_elements(self.robot))

    @cached_property
    def companions(self) -> tuple[Evidence, ...]:
        """What files next to the description are made for."""
        if self.description.path == "-":
            return ()
        folder = Path(self.description.path).parent
        found = self.description.workspace.list_matches(folder, "*.srdf")[:1]
        return tuple(
            Evidence("moveit", "a file", shorten_path(path), 0, "an SRDF next to the description")
            for path in found
        )

    @cached_property
    def first_block(self) -> Element | None:
        """The first ``<gazebo>`` block of the robot."""
        return next((element for _, element in list_blocks(self.robot)), None)

    def list_all(self) -> list[Evidence]:
        """Return all evidence, the strongest kind first."""
        name = self.robot.format
        if name in TARGETS_OF:
            text = f"the description is {name.upper()}"
            return [
                Evidence(target, "a file", shorten_path(self.description.path), 0, text)
                for target in TARGETS_OF[name]
            ]
        return [
            *(*self.manifest, *self.launches, *self.dependents),
            *(*self.plugins, *self.elements, *self.companions),
        ]


@memoize_by_workspace
def read_manifest(workspace: Workspace, path: Path) -> tuple[Evidence, ...]:
    """Return the statements of a package.xml about ROS and the generation of Gazebo."""
    file = read_optional_file(workspace, path)
    if file is None:
        return ()
    words = list(_DEPENDENCY.finditer(blank_comments(file.data)))

    def cite(target: str, names: Iterable[bytes] | None) -> Iterator[Evidence]:
        for match in words:
            name = match[1].decode()
            if name.startswith("ament_") if names is None else match[1] in names:
                what = "build type" if match[2] == b"build_type" else "depends on"
                line = file.position(match.start(1))[0]
                yield Evidence(target, "package.xml", file.path, line, f"{what} {name}")
                return

    ros = [*cite("ros2", None)] or [*cite("ros1", (b"catkin",))]
    for target, names in _DEPENDENCIES.items():
        ros += cite(target, [name.encode() for name in names])
    return tuple(ros)


@memoize_by_workspace
def read_launch_files(workspace: Workspace, package: Path) -> tuple[Evidence, ...]:
    """Return the generations of Gazebo that the launch files of a package start."""
    found = []
    for file, text in _list_launch_files(workspace, package):
        for target, words in _LAUNCHED.items():
            match = words.search(text)
            if match is not None:
                line, what = file.position(match.start())[0], f"names {match[0].decode()}"
                found.append(Evidence(target, "a launch file", file.path, line, what))
    return tuple(found)


@memoize_by_workspace
def _list_launch_files(workspace: Workspace, package: Path) -> list[tuple[SourceFile, bytes]]:
    """Return the launch files of a package, each with its text without comments."""
    found = []
    for ending in _LAUNCH_ENDINGS:
        for path in workspace.list_matches(package / "launch", ending):
            file = read_optional_file(workspace, path)
            if file is not None:
                blank = _COMMENT.sub(lambda match: b" " * len(match[0]), blank_comments(file.data))
                found.append((file, blank))
    return found


@memoize_by_workspace
def _is_package_used(workspace: Workspace, folder: Path, name: str) -> bool:
    """Tell whether a launch file of a package looks up the folder of another one."""
    word = re.escape(name.encode())
    lookup = re.compile(_LOOKUP + rb"[\s(\"']+" + word + rb"(?![\w-])(?!\)?/xacro)")
    return any(lookup.search(text) for _, text in _list_launch_files(workspace, folder))


def _list_plugins(robot: Robot) -> Iterator[Evidence]:
    for plugin in robot.plugins:
        library = plugin.filename.rpartition("/")[2]
        if is_for_gz(plugin.element):
            yield _make_evidence(
                "gz", "a plugin", plugin.element, f"plugin {library or plugin.name}"
            )
        elif library.startswith(_CLASSIC_PREFIXES):
            yield _make_evidence("gazebo-classic", "a plugin", plugin.element, f"plugin {library}")
    for element in robot.old_plugins:
        library = element.attributes["plugin"].rpartition("/")[2]
        if library.startswith(_CLASSIC_PREFIXES):
            yield _make_evidence("gazebo-classic", "a plugin", element, f"plugin {library}")
    for control in robot.ros2_controls:
        hardware = control.plugin or ""
        if hardware.startswith(("gz_ros2_control/", "ign_ros2_control/")):
            yield _make_evidence("gz", "a plugin", control.element, f"hardware {hardware}")
        elif hardware.startswith("gazebo_ros2_control/"):
            yield _make_evidence(
                "gazebo-classic", "a plugin", control.element, f"hardware {hardware}"
            )


def _list_elements(robot: Robot) -> Iterator[Evidence]:
    """Yield the first element of each kind that is made for one target."""
    for control in robot.ros2_controls[:1]:
        yield _make_evidence("ros2", "an element", control.element, "<ros2_control>")
    for transmission in robot.transmissions:
        if any(joint.hardware_interfaces for joint in transmission.joints):
            what = "<hardwareInterface> of ros_control in a joint"
            yield _make_evidence("ros1", "an element", transmission.element, what)
            break
    element = None if robot.xml is None else robot.xml.find_child("mujoco")
    if element is not None:
        yield _make_evidence("mujoco", "an element", element, "<mujoco>")


def _make_evidence(target: str, source: str, element: Element, text: str) -> Evidence:
    place = element.place
    return Evidence(target, source, place.file.path, place.file.position(place.start)[0], text)


def make_guess(target: str, block: Element) -> Evidence:
    """Return the evidence of a ``<gazebo>`` block where nothing names a generation of Gazebo."""
    return _make_evidence(target, "an element", block, "<gazebo>, and nothing names its generation")
