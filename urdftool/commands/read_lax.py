"""Read a robot tolerantly, for commands that do not write descriptions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console
from .read_strict import finder_of, read_configured, say_assumed, say_unknown

if TYPE_CHECKING:
    from ..model.elements import Robot


def read_lax(
    console: Console,
    path: str,
    arguments: Mapping[str, str],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
    *,
    neighbors: Mapping[str, Path] | None = None,
    shown: Callable[[str], str] = str,
    many: bool = False,
) -> Robot:
    """Read a robot; malformed XML that ROS accepts causes a warning instead of an error.

    Args:
        console: Output for warnings, and source of the configuration file.
        path: Description, in any format that can be read.
        arguments: Values of its xacro arguments by name.
        packages: Folders by package name, from the command line.
        package_paths: Folders that are searched for packages.
        neighbors: Further folders by package name, with the priority of configured ones.
        shown: Formats a path for messages.
        many: The arguments are for several robots, and need not be declared by this one.

    Raises:
        UrdftoolError: The robot cannot be read, as for ``read_description`` and ``robot_of``, or
            the reader of its format.
    """
    from ..errors import XmlError
    from ..formats.detect import format_of
    from ..model.load import robot_of
    from ..source.description import is_xacro
    from ..source.document import read_file
    from ..source.well_formed import mend

    file = read_file(path)
    if (found := format_of(file)).name != "urdf":
        from .read_other import read_other

        finder = finder_of(console, file, packages, package_paths, neighbors=neighbors)
        return read_other(console, found, file, arguments, finder, shown=shown)
    given = console, path, arguments, packages, package_paths
    read = partial(read_configured, *given, neighbors=neighbors)
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
        console.note(f"{shown(error.where)}: warning: {error.message}; ROS ignores this error")
    if not many:
        say_unknown(console, description, shown=shown)
    say_assumed(console, description, shown=shown)
    return take_world(console, robot_of(description), shown=shown)


def take_world(console: Console, robot: Robot, *, shown: Callable[[str], str] = str) -> Robot:
    """Add the link ``world`` if a joint has it as parent and it is not defined; print a warning.

    Args:
        console: Output for the warning.
        robot: Robot.
        shown: Formats a path for messages.
    """
    from ..model.world import with_world

    whole, joint = with_world(robot)
    if joint is not None and joint.parent_element is not None:
        place = shown(str(joint.parent_element.attribute_place("link")))
        console.note(
            f"{place}: warning: parent link 'world' of joint '{joint.name}' is not defined; "
            'assuming a fixed base. Add <link name="world"/>.'
        )
    return whole
