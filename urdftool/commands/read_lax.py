"""A robot as lax readers see it, for commands that only look at it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console

if TYPE_CHECKING:
    from ..model.elements import Robot


def read_lax(
    console: Console,
    path: str,
    arguments: Mapping[str, str],
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
) -> Robot:
    """Read a robot; XML that is wrong and that ROS reads all the same is said and passed over.

    Raises:
        UrdftoolError: As ``read_description`` and ``robot_of``.
    """
    from ..configuration import find_configuration
    from ..errors import XmlError
    from ..model.load import robot_of
    from ..source.description import is_xacro, read_description
    from ..source.document import read_file
    from ..source.well_formed import mend

    file = read_file(path)
    configured = find_configuration(path, console.config).packages
    try:
        return robot_of(
            read_description(
                path,
                arguments,
                packages=packages,
                package_paths=package_paths,
                configured=configured,
                file=file,
            )
        )
    except XmlError as error:
        mended = None if is_xacro(file) else mend(file)
        if mended is None:
            raise
        try:
            description = read_description(
                path,
                arguments,
                packages=packages,
                package_paths=package_paths,
                configured=configured,
                file=mended,
            )
        except XmlError:
            raise error from None
        console.note(f"{error.where}: warning: {error.message}; lax readers pass over it")
        return robot_of(description)
