"""Pictures as files: refused before the work is done, written whole."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from ..model.elements import Robot


def checked_picture(picture: str | None, option: str = "--picture") -> None:
    """Refuse a picture that cannot be written before the work is done."""
    if picture is None:
        return
    if not picture.lower().endswith(".png"):
        raise click.UsageError(f"{option} wants a name that ends in .png, not {picture}")
    from ..extras import require
    from ..output import check_folder

    require(option, "PIL")
    check_folder(Path(picture).resolve().parent, picture)


def check_picture(picture: str | None, robot: Robot) -> None:
    """Refuse a picture that would take the place of what a robot was read from.

    Raises:
        OutputError: It would.
    """
    if picture is None:
        return
    from ..model.files import sources
    from ..output import check_target

    check_target(picture, inputs=sorted(sources(robot)))


def write_picture(data: bytes, target: str, robot: Robot) -> None:
    """Write a picture of a robot, which must not take the place of what it was read from.

    Raises:
        OutputError: It cannot be written, or would overwrite an input.
    """
    from ..model.files import sources
    from ..output import write_file

    write_file(target, data, inputs=sorted(sources(robot)))
