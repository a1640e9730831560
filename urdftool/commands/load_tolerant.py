"""Read a robot tolerantly, for commands that do not write descriptions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console
from .load_strict import (
    get_finder,
    read_configured,
    report_assumed_packages,
    report_unknown_arguments,
)

if TYPE_CHECKING:
    from ..model.elements import Robot


def load_tolerant(
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

    ``neighbors`` are more folders by package name, with the priority of configured ones; with
    ``many``, the arguments are for several robots, and need not be declared by this one.

    Raises:
        UrdftoolError: The robot cannot be read, as for ``read_description`` and ``make_robot``, or
            the reader of its format.
    """
    from ..errors import XmlError
    from ..formats.common.loss_report import format_lines
    from ..formats.detect import format_of
    from ..formats.reading import find_remarks
    from ..model.load import make_robot
    from ..source.description import is_xacro
    from ..source.document import read_file
    from ..source.well_formed import repair

    file = read_file(path)
    if (found := format_of(file)).name != "urdf":
        from .read_other import read_other

        finder = get_finder(console, file, packages, package_paths, neighbors=neighbors)
        return read_other(console, found, file, arguments, finder, shown=shown)
    given = console, path, arguments, packages, package_paths
    read = partial(read_configured, *given, neighbors=neighbors)
    try:
        description = read(file=file)
    except XmlError as error:
        repaired = None if is_xacro(file) else repair(file)
        if repaired is None:
            raise
        try:
            description = read(file=repaired)
        except XmlError:
            raise error from None
        console.print_note(
            f"{shown(error.where)}: warning: {error.message}; ROS ignores this error"
        )
    if not many:
        report_unknown_arguments(console, description, shown=shown)
    report_assumed_packages(console, description, shown=shown)
    robot = make_robot(description)
    for line in format_lines(find_remarks(robot)):
        console.print_note(shown(line))
    return add_implicit_world(console, robot, shown=shown)


def add_implicit_world(
    console: Console, robot: Robot, *, shown: Callable[[str], str] = str
) -> Robot:
    """Add the link ``world`` if a joint has it as parent and it is not defined; print a warning."""
    from ..model.world import add_world

    whole, joint = add_world(robot)
    if joint is not None and joint.parent_element is not None:
        place = shown(str(joint.parent_element.locate_attribute("link")))
        console.print_note(
            f"{place}: warning: parent link 'world' of joint '{joint.name}' is not defined; "
            'assuming a fixed base. Add <link name="world"/>.'
        )
    return whole
