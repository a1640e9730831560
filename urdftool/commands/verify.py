"""``urdftool verify``: compare robots of any format as mechanisms."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import (
    FiniteRange,
    add_gltf_option,
    add_name_option,
    add_package_options,
    make_output_option,
    split_robots,
)

_MOST = 8  # robots of one comparison, each of which is a column; chosen, no source

_GROUPS = {"Comparison": "only tolerance names", "Output": "style output"}


@click.command("verify", cls=GroupedCommand, groups=_GROUPS)
@click.argument("words", nargs=-1, metavar="A [name:=value ...] B [name:=value ...] ...")
@add_name_option
@make_output_option("Output file.  [default: standard output]")
@click.option(
    "--only",
    metavar="ROWS",
    default="",
    help="Rows of the table to compare, separated by commas, such as frames,mass.  [default: all]",
)
@click.option(
    "--tolerance",
    type=FiniteRange(0.0),
    metavar="T",
    help="Tolerance of every row, in the unit of the row.  [default: that of the row]",
)
@click.option(
    "--map",
    "names",
    metavar="FILE",
    type=Path,
    help=(
        'Names that belong together: lines "joint NAME_IN_A NAME_IN_B" or "link ...". Also '
        'how B was made of A, such as "root OLD NEW".'
    ),
)
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="Output format.",
)
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    words: tuple[str, ...],
    output: str | None,
    only: str,
    tolerance: float | None,
    names: Path | None,
    style: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Compare the robots A, B, ... of any format as mechanisms.

    Frames, axes, limits, masses, shapes and mass matrices of all pairs are compared. Joints are
    matched by name, then by the structure of the tree. Links that fixed joints connect are compared
    as one rigid body if their masses are distributed differently; names of roots may differ. Each
    difference is printed with both values and both places, and with three or more robots, which of
    them is alone.

    \b
        urdftool verify arm.urdf.xacro arm.xml
        urdftool verify arm.urdf model.sdf arm.xml --only frames,mass
        urdftool verify a.urdf b.xml --map names.txt --format json

    Exit code 1: the robots differ, a mesh or part was not read, or nothing was compared.
    """  # noqa: D301 -- click reads the escape
    from ..compare.correspondence import Correspondence, read_correspondence
    from ..compare.rows import limit_tolerances, select_rows
    from ..compare.several import compare_all
    from ..model.files import list_sources
    from ..output import write_result
    from ..report import verification as report
    from .load_tolerant import load_tolerant

    sides = split_robots(words)
    if not 2 <= len(sides) <= _MOST:
        given = "1 file is" if len(sides) == 1 else f"{len(sides)} files are"
        raise click.UsageError(f"{given} given, but the command compares 2 to {_MOST} robots")
    paths = [path for path, _ in sides]
    if paths.count("-") > 1:
        raise click.UsageError("only one of the robots can be standard input ('-')")
    rows = select_rows(only, tolerance)
    declared = Correspondence() if names is None else read_correspondence(names, len(sides))
    if declared.is_declared and tolerance is None:
        rows = limit_tolerances(rows, declared.tolerance)
    robots = [
        load_tolerant(console, path, arguments, package, package_path) for path, arguments in sides
    ]
    agreement = compare_all(robots, rows=rows, names=declared)
    text = (report.to_json if style == "json" else report.format_text)(paths, agreement)
    write_result(text, output, inputs=sorted(set().union(*map(list_sources, robots))))
    totals = [sum(not joint.is_fixed for joint in robot.joints) for robot in robots]
    console.print_note(report.summarize(paths, agreement, totals))
    return int(not agreement.is_equal)
