"""``urdftool info``: print the properties of a robot in one table."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import (
    add_gltf_option,
    add_package_options,
    add_robot_argument,
    make_format_option,
    make_output_option,
)
from .progress import Progress


@click.command("info", cls=GroupedCommand, groups={"Output": "style output"})
@add_robot_argument
@make_output_option("Output file.  [default: standard output]")
@make_format_option("table", "json")
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    style: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Print the properties of the robot IN in one table.

    Links, joints by type, degrees of freedom, mass, bounding box at the zero pose, meshes and
    triangles, packages, plugins and sensors; mesh files that cannot be read, with the reason.

    \b
        urdftool info arm.urdf.xacro prefix:=left_
        urdftool info arm.urdf --format json
    """  # noqa: D301 -- click reads the escape
    from ..info.counts import count
    from ..info.size import measure
    from ..lint.validate import validate
    from ..model.files import list_sources
    from ..output import write_result
    from ..report import info as report
    from .load_tolerant import load_tolerant

    path, arguments = robot
    model = load_tolerant(console, path, arguments, package, package_path)
    for finding in validate(model, "links"):
        console.print_note(f"{finding.location}: {finding.message}")
    with Progress(console, "meshes") as progress:
        measured = measure(model, progress)
    counts = count(model)
    if style == "json":
        text = report.to_json(model, counts, measured)
    else:
        colors = console.has_colors(to_file=output not in (None, "-"))
        text = report.format_table(model, counts, measured, colors=colors)
    write_result(text, output, inputs=sorted(list_sources(model)))
    return 0
