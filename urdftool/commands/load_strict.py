"""Read a description strictly, for commands that write descriptions or other formats."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..source.description import Description
    from ..source.location import SourceFile
    from ..source.packages import Packages


def load_strict(
    console: Console,
    robot: tuple[str, Mapping[str, str]],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    file: SourceFile | None = None,
) -> Description:
    """Read a description; malformed XML is an error.

    Raises:
        SourceError: The file cannot be read, parsed or expanded.
    """
    path, arguments = robot
    description = read_configured(console, path, arguments, packages, package_paths, file=file)
    report_unknown_arguments(console, description)
    report_assumed_packages(console, description)
    return description


def read_configured(
    console: Console,
    path: str,
    arguments: Mapping[str, str],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    neighbors: Mapping[str, Path] | None = None,
    file: SourceFile | None = None,
) -> Description:
    """Read a description with the packages and options of the command line and configuration.

    ``neighbors`` are more folders by package name, with the priority of configured ones.

    Raises:
        SourceError: The file cannot be read, parsed or expanded.
    """
    from ..configuration import find_configuration
    from ..source.description import read_description

    configuration = find_configuration(path, console.config)
    return read_description(
        path,
        arguments,
        packages=packages,
        package_paths=package_paths,
        configured={**(neighbors or {}), **configuration.packages},
        file=file,
        gltf_up=console.gltf_up or configuration.gltf_up,
    )


def get_finder(
    console: Console,
    file: SourceFile,
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    neighbors: Mapping[str, Path] | None = None,
) -> Packages:
    """Return the finder of the files of a description, as the command line and configuration say.

    ``neighbors`` count as configured.
    """
    from ..configuration import find_configuration
    from ..source.document import STDIN
    from ..source.packages import Packages

    configuration = find_configuration(file.path, console.config)
    return Packages(
        None if file.path == STDIN else file.path,
        named=packages,
        paths=package_paths,
        configured={**(neighbors or {}), **configuration.packages},
    )


def report_gltf_axes(console: Console, robot: Robot) -> None:
    """Print a note if the axes of glTF meshes are converted, which readers do differently."""
    from ..model.gltf_axes import describe_gltf_axes

    if axes := describe_gltf_axes(robot):
        console.print_note(f"note: {axes}")


def report_unknown_arguments(
    console: Console, description: Description, *, shown: Callable[[str], str] = str
) -> None:
    """Print the given xacro arguments that the description does not declare."""
    if not description.arguments:
        return
    from ..report.expansion import format_unknown_arguments

    path = shown(description.files[0].path)
    for line in format_unknown_arguments(path, description.arguments, description.expansion):
        console.print_note(line)


def report_assumed_packages(
    console: Console, description: Description, *, shown: Callable[[str], str] = str
) -> None:
    """Print the packages that are not found and replaced by folders of the same name."""
    from ..errors import UrdftoolError
    from ..source.packages import shorten_path

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
            continue  # reported by the command that reads the mesh
    for name, folder in packages.assumed.items():
        console.print_note(
            f"{shown(description.files[0].path)}: warning: package '{name}' is not found; "
            f"using the folder '{shorten_path(folder)}' instead"
        )
