"""``urdftool diff``: compare two robots."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from ..report.counted import format_count
from .grouped_help import GroupedCommand
from .options import (
    FiniteRange,
    add_name_option,
    add_package_options,
    make_format_option,
    make_output_option,
    split_robots,
)

if TYPE_CHECKING:
    from ..compare.revision import Checkout
    from ..model.elements import Robot

Side = tuple[str, dict[str, str]]


_GROUPS = {"Comparison": "tolerance", "Output": "style output"}


@click.command("diff", cls=GroupedCommand, groups=_GROUPS)
@click.argument("words", nargs=-1, metavar="A [name:=value ...] B [name:=value ...]")
@add_name_option
@make_output_option("Output file.  [default: standard output]")
@click.option(
    "--tolerance",
    type=FiniteRange(0.0),
    metavar="T",
    help="Tolerance of numbers, relative; of origins, absolute [m and rad].  [default: 1e-9]",
)
@make_format_option("text", "json", "markdown")
@add_package_options
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
    """List the changes from the robot A to the robot B, ignoring order and formatting.

    Links, joints, poses, masses, limits, geometry, and elements for simulators and controllers are
    compared. A and B are .urdf or .xacro files, or REV:PATH for a file of a git revision. xacro
    arguments follow their file; those of B are also used for A if A has none and is another file.

    \b
        urdftool diff HEAD:arm.urdf.xacro arm.urdf.xacro
        urdftool diff arm.urdf.xacro prefix:=left_ arm.urdf.xacro prefix:=right_
        urdftool diff main:arm.urdf arm.urdf --format markdown

    Exit code 1: the robots differ, or a part was not read and may differ.
    """  # noqa: D301 -- click reads the escape
    from ..compare.differences import compare
    from ..compare.tolerance import TOLERANCE
    from ..compare.unread import list_unseen
    from ..model.files import list_sources
    from ..output import write_result
    from ..report import compare as report

    one, two = _split_sides(words)
    if one[0] == two[0] == "-":
        raise click.UsageError("only one of A and B can be standard input ('-')")
    limit = TOLERANCE if tolerance is None else tolerance
    a = _read(console, one, package, package_path)
    b = _read(console, two, package, package_path)
    changes = list(compare(a, b, tolerance=limit))
    unread = list(list_unseen(a, b))
    names = one[0], two[0]
    shown = _format_side(one), _format_side(two)
    if style == "json":
        text = report.to_json(names, changes, limit, unread)
    elif style == "markdown":
        text = report.format_markdown(shown, changes, unread)
    else:
        text = report.format_text(
            changes, colors=console.has_colors(to_file=output not in (None, "-"))
        )
    inputs = sorted(list_sources(a) | list_sources(b))
    write_result(text, output, inputs=inputs)
    for note in report.list_notes(unread):
        console.print_note(note)
    console.print_note(report.summarize(shown, changes, unread))
    if changes and a.format != b.format:
        console.print_note(
            "the files have different formats; 'urdftool verify' compares what they mean, without "
            "names of files and frames that were added"
        )
    return int(bool(changes or unread))


def _split_sides(words: tuple[str, ...]) -> tuple[Side, Side]:
    """Split the words into both files, each with its xacro arguments."""
    sides = split_robots(words)
    if len(sides) != 2:
        given = f"{format_count(len(sides), 'file')} given"
        raise click.UsageError(f"{given}, but the command compares two robots")
    (one, a), (two, b) = sides
    return (one, a if a or one == two else b), (two, b)


def _format_side(side: Side) -> str:
    """Format a file with its arguments, as they are given."""
    path, arguments = side
    return " ".join((path, *(f"{name}:={value}" for name, value in arguments.items())))


def _read(
    console: Console, side: Side, package: dict[str, Path], package_path: tuple[str, ...]
) -> Robot:
    from ..compare.revision import check_out, parse_revision
    from .load_tolerant import load_tolerant

    path, arguments = side
    revision = None if path == "-" else parse_revision(path)
    if revision is None:
        return load_tolerant(console, path, arguments, package, package_path)
    with check_out(revision) as checkout, _restore_error_paths(checkout):
        robot = load_tolerant(
            console,
            str(checkout.path),
            arguments,
            {name: checkout.map_folder(folder) for name, folder in package.items()},
            [str(checkout.map_folder(folder)) for folder in package_path],
            neighbors=checkout.find_neighbors(),
            shown=checkout.format_path,
        )
    return checkout.restore_paths(robot)


@contextmanager
def _restore_error_paths(checkout: Checkout) -> Iterator[None]:
    """Replace the temporary folder by the revision in the paths of errors."""
    from ..errors import UrdftoolError

    try:
        yield
    except UrdftoolError as error:
        raise checkout.restore_error_paths(error) from None
