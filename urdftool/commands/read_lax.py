"""A robot as lax readers see it, for commands that only look at it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console
from .read_strict import read_configured, say_assumed, say_unknown

if TYPE_CHECKING:
    from ..model.elements import Robot


def read_lax(
    console: Console,
    path: str,
    arguments: Mapping[str, str],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    neighbours: Mapping[str, Path] | None = None,
    shown: Callable[[str], str] = str,
    many: bool = False,
) -> Robot:
    """Read a robot; XML that is wrong and that ROS reads all the same is said and passed over.

    Args:
        console: Where it is said, and the configuration that was named.
        path: The description.
        arguments: Values for its xacro arguments.
        packages: Folders by package name, from the command line.
        package_paths: Folders with packages below.
        neighbours: Folders by package name that count as configured.
        shown: How its path is said.
        many: The arguments are for many robots, and need not be for this one.

    Raises:
        UrdftoolError: As ``read_description`` and ``robot_of``.
    """
    from ..errors import XmlError
    from ..model.load import robot_of
    from ..source.description import is_xacro
    from ..source.document import read_file
    from ..source.well_formed import mend

    file = read_file(path)
    given = console, path, arguments, packages, package_paths
    read = partial(read_configured, *given, neighbours=neighbours)
    try:
        description = read(file=file)
    except XmlError as error:
        mended = None if is_xacro(file) else mend(file)
        if mended is None:
            raise
        try:
            description = read(file=mended)
        except XmlError:
            raise error from None
        console.note(f"{shown(error.where)}: warning: {error.message}; lax readers pass over it")
    if not many:
        say_unknown(console, description, shown=shown)
    say_assumed(console, description, shown=shown)
    return take_world(console, robot_of(description), shown=shown)


def take_world(console: Console, robot: Robot, *, shown: Callable[[str], str] = str) -> Robot:
    """A robot with the world that it names and does not declare, which is said.

    Args:
        console: Where it is said.
        robot: Any robot.
        shown: How a path is said.
    """
    from ..model.world import with_world

    whole, joint = with_world(robot)
    if joint is not None and joint.parent_element is not None:
        place = shown(str(joint.parent_element.attribute_place("link")))
        console.note(
            f"{place}: warning: parent link 'world' of joint '{joint.name}' does not exist; it is "
            'taken for the world, to which the robot is fixed: write <link name="world"/>'
        )
    return whole
