"""Robots in formats other than URDF, for commands that take any format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from ..console import Console
from .read_strict import say_unknown

if TYPE_CHECKING:
    from ..formats.registry import Format
    from ..model.elements import Robot
    from ..source.location import SourceFile
    from ..source.packages import Packages


def read_other(
    console: Console,
    found: Format,
    file: SourceFile,
    arguments: Mapping[str, str],
    packages: Packages,
    *,
    shown: Callable[[str], str] = str,
) -> Robot:
    """Read a robot, and print what the model does not hold of its source.

    Args:
        console: Where losses are printed.
        found: The format of the file.
        file: The file.
        arguments: xacro arguments, of which the format has none.
        packages: Finder of files.
        shown: Formats a path.

    Raises:
        UrdftoolError: The file cannot be read.
    """
    from ..formats.common.loss_report import format_lines

    reading = found.read(file.path, file=file, packages=packages, workspace=packages.workspace)
    for line in format_lines(reading.losses):
        console.note(shown(line))
    robot = reading.robot
    if robot.source is not None:
        robot.source.arguments.update(arguments)
        robot.source.gltf_up = console.gltf_up or robot.source.gltf_up
        say_unknown(console, robot.source, shown=shown)
    return robot
