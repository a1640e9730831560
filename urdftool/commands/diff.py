"""``urdftool diff``: what changed between two robots."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .options import ASSIGN, output_option, package_options, split_arguments

if TYPE_CHECKING:
    from ..compare.revision import Checkout
    from ..model.elements import Robot

Side = tuple[str, dict[str, str]]


@click.command("diff")
@click.argument("words", nargs=-1, metavar="A [name:=value ...] B [name:=value ...]")
@output_option("Write it there; without it, to standard output.")
@click.option(
    "--tolerance",
    type=click.FloatRange(0.0),
    metavar="T",
    help="Numbers that differ by less are equal: relative, and for origins in metres and radians. "
    "[default: 1e-9]",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "json", "markdown"]),
    default="text",
    help="How the result is shown.",
)
@package_options
@click.pass_obj
def command(
    console: Console,
    words: tuple[str, ...],
    output: str | None,
    tolerance: float | None,
    style: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Say what changed from the robot A to the robot B, as a reviewer means it.

    Links, joints, origins as poses, masses, limits, geometry, and the blocks for simulators and
    controllers; not order, layout or how a number is written. A and B are .urdf or .xacro files;
    REV:PATH is a file at a git revision, with its includes. xacro arguments follow the file they
    are for; those after B hold for A too if A has none.

    \b
        urdftool diff HEAD:arm.urdf.xacro arm.urdf.xacro
        urdftool diff arm.urdf.xacro prefix:=left_ arm.urdf.xacro prefix:=right_
        urdftool diff main:arm.urdf arm.urdf --format markdown

    Exit 1 if they differ.
    """  # noqa: D301 -- click reads the escape
    from ..compare.closeness import TOLERANCE
    from ..compare.differences import compare
    from ..output import write_result
    from ..report import compare as report

    one, two = _sides(words)
    if one[0] == two[0] == "-":
        raise click.UsageError("standard input can be one of the two, not both")
    limit = TOLERANCE if tolerance is None else tolerance
    a = _read(console, one, package, package_path)
    b = _read(console, two, package, package_path)
    changes = list(compare(a, b, tolerance=limit))
    names = one[0], two[0]
    if style == "json":
        text = report.to_json(names, changes, limit)
    elif style == "markdown":
        text = report.markdown(names, changes)
    else:
        text = report.text(changes, colors=console.colors(to_file=output not in (None, "-")))
    inputs = [file.path for robot in (a, b) if robot.source for file in robot.source.files]
    write_result(text, output, inputs=inputs)
    console.note(report.summary(names, changes))
    return int(bool(changes))


def _sides(words: tuple[str, ...]) -> tuple[Side, Side]:
    """Both files with their xacro arguments."""
    sides: list[list[str]] = []
    for word in words:
        if ASSIGN not in word:
            sides.append([word])
        elif sides:
            sides[-1].append(word)
        else:
            raise click.UsageError(f"'{word}' stands before the file it is for")
    if len(sides) != 2:
        raise click.UsageError(f"two robots are wanted, not {len(sides)}")
    a, b = (split_arguments(tuple(side))[1] for side in sides)
    return (sides[0][0], a or b), (sides[1][0], b)


def _read(
    console: Console, side: Side, package: dict[str, Path], package_path: tuple[str, ...]
) -> Robot:
    from ..compare.revision import checked_out, named
    from .read_lax import read_lax

    path, arguments = side
    wanted = None if path == "-" else named(path)
    if wanted is None:
        return read_lax(console, path, arguments, package, package_path)
    with checked_out(wanted) as checkout, _at_revision(checkout):
        robot = read_lax(
            console,
            str(checkout.path),
            arguments,
            {name: checkout.there(folder) for name, folder in package.items()},
            [str(checkout.there(folder)) for folder in package_path],
            neighbours=checkout.neighbours(),
            shown=checkout.shown,
        )
    return checkout.renamed(robot)


@contextmanager
def _at_revision(checkout: Checkout) -> Iterator[None]:
    """Errors say the revision, not the temporary folder."""
    from ..errors import UrdftoolError

    try:
        yield
    except UrdftoolError as error:
        raise checkout.renamed_error(error) from None
