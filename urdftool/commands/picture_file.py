"""Check and write picture files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from ..model.elements import Robot


def check_picture_name(picture: str | None, option: str = "--picture") -> None:
    """Refuse a picture that cannot be written, before anything is computed.

    Raises:
        UsageError: The name does not end in ``.png``.
        MissingDependency: Pillow is not installed.
        OutputError: A part of the path is a file, or the folder is read-only.
    """
    if picture is None:
        return
    if not picture.lower().endswith(".png"):
        raise click.UsageError(f"{option} requires a file that ends in .png, not {picture}")
    from ..extras import require
    from ..output import check_folder

    require(option, "PIL")
    check_folder(Path(picture).resolve().parent, picture)


def check_picture(picture: str | None, robot: Robot) -> None:
    """Refuse a picture that would overwrite a source file of a robot.

    Raises:
        OutputError: The picture has the path of a source file.
    """
    if picture is None:
        return
    from ..model.files import list_sources
    from ..output import check_target

    check_target(picture, inputs=sorted(list_sources(robot)))


def write_picture(data: bytes, target: str, robot: Robot) -> None:
    """Write a picture of a robot.

    Raises:
        OutputError: The file cannot be written, or is a source file of the robot.
    """
    from ..model.files import list_sources
    from ..output import write_file

    write_file(target, data, inputs=sorted(list_sources(robot)))
