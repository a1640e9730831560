"""``urdftool info``: the robot in one table."""

from __future__ import annotations

import sys
from pathlib import Path
from time import monotonic

import click

from ..console import Console
from .options import output_option, package_options, robot_argument


@click.command("info")
@robot_argument
@output_option("Write it there; without it, to standard output.")
@click.option(
    "--format",
    "style",
    type=click.Choice(["table", "json"]),
    default="table",
    help="How the result is shown.",
)
@package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    style: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Say what IN is made of, in one table.

    Links, joints by type, degrees of freedom, mass, size at zero pose, meshes and triangles,
    packages, plugins, sensors. A mesh that cannot be read is named with the reason.

    \b
        urdftool info arm.urdf.xacro prefix:=left_
        urdftool info arm.urdf --format json
    """  # noqa: D301 -- click reads the escape
    from ..info.counts import count
    from ..info.size import measure
    from ..output import write_result
    from ..report import info as report
    from .read_lax import read_lax

    path, arguments = robot
    model = read_lax(console, path, arguments, package, package_path)
    progress = _Progress(console)
    try:
        measured = measure(model, progress)
    finally:
        progress.end()
    counts = count(model)
    if style == "json":
        text = report.to_json(model, counts, measured)
    else:
        colors = console.colors(to_file=output not in (None, "-"))
        text = report.table(model, counts, measured, colors=colors)
    inputs = [file.path for file in model.source.files] if model.source else []
    write_result(text, output, inputs=inputs)
    return 0


_PATIENCE = 1.0  # seconds


class _Progress:
    """A line on stderr while meshes are read, once that takes a while and at a terminal."""

    def __init__(self, console: Console) -> None:
        self.begin = monotonic()
        self.wanted = sys.stderr.isatty() and not console.quiet
        self.shown = False

    def __call__(self, number: int, count: int, uri: str) -> None:
        if self.wanted and monotonic() - self.begin > _PATIENCE:
            self.shown = True
            click.echo(f"\r\033[Kmeshes {number}/{count}  {uri[-50:]!r}", err=True, nl=False)

    def end(self) -> None:
        if self.shown:
            click.echo("\r\033[K", err=True, nl=False)
