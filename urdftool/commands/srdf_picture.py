"""``urdftool srdf --picture``: a picture of the poses at which links touch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console
from .picture_file import check_picture, check_picture_name, write_picture
from .progress import Progress

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..model.pair_pose import PairPose

F = TypeVar("F", bound=Callable[..., Any])


def add_picture_option(function: F) -> F:
    """Add ``--picture FILE.png``."""
    return click.option(
        "--picture",
        metavar="FILE.png",
        help="Write a picture of the poses at which links touch: of the pairs that can touch; with "
        "--check and --update, of those that the SRDF disables.",
    )(function)


def check_picture_target(robot: Robot, values: dict[str, Any]) -> None:
    """Refuse a picture that cannot be written, before the proof.

    Raises:
        UsageError: Its name does not end in ``.png``, or ``--moveit`` is given.
        OutputError: It cannot be written, or is a file of the robot.
    """
    if values["picture"] is not None and values["moveit"] is not None:
        raise click.UsageError("--picture and --moveit exclude each other; draw with --check")
    check_picture_name(values["picture"])
    check_picture(values["picture"], robot)


def write_contacts(
    console: Console, robot: Robot, pairs: Sequence[PairPose], values: dict[str, Any]
) -> None:
    """Write the picture of ``--picture``, if there is something to draw."""
    from ..drawing.pair_sheet import MOST, draw_pair_sheet
    from ..drawing.png_file import encode_png
    from ..drawing.shapes import read_robot_shapes
    from ..report.counted import format_count

    target = values["picture"]
    if target is None:
        return
    if not pairs:
        console.print_message(f"no pair to draw can touch, so {target} is not written")
        return
    with Progress(console, "meshes") as progress:
        kind = "visual" if values["visual"] else "collision"
        shapes = read_robot_shapes(robot, show=kind, progress=progress)
    count = format_count(len(pairs), "pair")
    title = f"{robot.name or 'robot'}: {count} in contact"
    if len(pairs) > MOST:
        title += f", the first {MOST} are shown"
    with Progress(console, "pairs") as progress:
        image = draw_pair_sheet(robot, shapes, pairs, title=title, progress=progress)
    write_picture(encode_png(image), target, robot)
    shown = f"the first {MOST} of {count}" if len(pairs) > MOST else count
    console.print_note(f"wrote {target}: {shown} in contact")
