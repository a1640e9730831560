"""Robots in formats other than URDF, for commands that take any format."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console
from .load_strict import get_finder, load_strict, report_unknown_arguments

if TYPE_CHECKING:
    from ..formats.registry import Format
    from ..model.elements import Robot
    from ..source.location import SourceFile
    from ..source.packages import Packages


def read_any(
    console: Console,
    robot: tuple[str, Mapping[str, str]],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    edit: str = "",
    quiet: bool = False,
) -> Robot:
    """Read a robot of any format; malformed XML is an error.

    ``edit`` says what the command writes into the source, which must then be URDF or xacro;
    ``quiet``: the caller prints ``robot.unread``.

    Raises:
        UrdftoolError: The robot cannot be read, or not be edited.
    """
    from ..errors import ModelError
    from ..formats.detect import format_of
    from ..model.load import make_robot
    from ..source.document import read_file

    path, arguments = robot
    file = read_file(path)
    format_name = format_of(file)
    if format_name.name == "urdf":
        return make_robot(load_strict(console, robot, packages, package_paths, file=file))
    if edit:
        message = f"{edit} requires a URDF or xacro file; this is {format_name.title}"
        raise ModelError(message, path=path)
    finder = get_finder(console, file, packages, package_paths)
    return read_other(console, format_name, file, arguments, finder, quiet=quiet)


def read_other(
    console: Console,
    found: Format,
    file: SourceFile,
    arguments: Mapping[str, str],
    packages: Packages,
    *,
    shown: Callable[[str], str] = str,
    quiet: bool = False,
) -> Robot:
    """Read a robot, and print what the model does not hold of its source.

    ``quiet``: the caller prints ``robot.unread``.

    Raises:
        UrdftoolError: The file cannot be read.
    """
    from ..formats.common.loss_report import format_lines
    from .options import CHOSEN

    arguments = dict(arguments)
    places = {"packages": packages, "workspace": packages.workspace}
    reading = found.read(file.path, file=file, name=arguments.pop(CHOSEN, ""), **places)
    for line in () if quiet else format_lines(reading.losses):
        console.print_note(shown(line))
    robot = reading.robot
    if robot.source is not None:
        robot.source.arguments.update(arguments)
        robot.source.gltf_up = console.gltf_up or robot.source.gltf_up
        report_unknown_arguments(console, robot.source, shown=shown)
    return robot
