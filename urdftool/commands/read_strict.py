"""A description as it is written, for commands that build on it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..source.description import Description
    from ..source.location import SourceFile


def read_strict(
    console: Console,
    robot: tuple[str, Mapping[str, str]],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
) -> Description:
    """Read a description; what is wrong with its XML stops the command.

    Args:
        console: The configuration that was named.
        robot: Its path, and values for its xacro arguments.
        packages: Folders by package name, from the command line.
        package_paths: Folders with packages below.

    Raises:
        SourceError: It cannot be read, parsed or expanded.
    """
    path, arguments = robot
    description = read_configured(console, path, arguments, packages, package_paths)
    say_unknown(console, description)
    say_assumed(console, description)
    return description


def read_configured(
    console: Console,
    path: str,
    arguments: Mapping[str, str],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    neighbours: Mapping[str, Path] | None = None,
    file: SourceFile | None = None,
) -> Description:
    """Read a description as the command line and its configuration say.

    Args:
        console: The configuration that was named, and what the line says of glTF.
        path: The description.
        arguments: Values for its xacro arguments.
        packages: Folders by package name, from the command line.
        package_paths: Folders with packages below.
        neighbours: Folders by package name that count as configured.
        file: The file, where it has been read already.

    Raises:
        SourceError: It cannot be read, parsed or expanded.
    """
    from ..configuration import find_configuration
    from ..source.description import read_description

    configuration = find_configuration(path, console.config)
    return read_description(
        path,
        arguments,
        packages=packages,
        package_paths=package_paths,
        configured={**(neighbours or {}), **configuration.packages},
        file=file,
        gltf_up=console.gltf_up or configuration.gltf_up,
    )


def say_gltf(console: Console, robot: Robot) -> None:
    """Say that glTF meshes are turned, which not every reader does.

    Args:
        console: Where it is said.
        robot: Any robot.
    """
    from ..model.gltf_axes import gltf_note

    if axes := gltf_note(robot):
        console.note(f"note: {axes}")


def say_unknown(
    console: Console, description: Description, *, shown: Callable[[str], str] = str
) -> None:
    """Say which of the xacro arguments that were given nothing declares.

    Args:
        console: Where it is said.
        description: What was read with them.
        shown: How a path is said.
    """
    if not description.arguments:
        return
    from ..report.expansion import unknown_arguments

    path = shown(description.files[0].path)
    for line in unknown_arguments(path, description.arguments, description.expansion):
        console.note(line)


def say_assumed(
    console: Console, description: Description, *, shown: Callable[[str], str] = str
) -> None:
    """Say which packages are folders of their name, because they are not found.

    Args:
        console: Where it is said.
        description: Any description.
        shown: How a path is said.
    """
    from ..errors import UrdftoolError
    from ..source.packages import shown_path

    packages = description.packages
    first: dict[str, str] = {}
    for element in description.document.root.walk():
        uri = element.get("filename") or ""
        if element.tag == "mesh" and uri.startswith("package://"):
            first.setdefault(uri[10:].partition("/")[0], uri)
    for uri in first.values():
        try:
            packages.resolve(uri)
        except UrdftoolError:
            continue  # whoever needs it says so
    for name, folder in packages.assumed.items():
        console.note(
            f"{shown(description.files[0].path)}: warning: package '{name}' is not found; "
            f"its files are read from '{shown_path(folder)}'"
        )
