"""``urdftool expand``: xacro to URDF."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .options import output_option, package_options, robot_argument


@click.command("expand")
@robot_argument
@output_option("Write the URDF there; without it, to standard output.")
@click.option("--deps", is_flag=True, help="List the files that are read, and expand nothing.")
@click.option("--depfile", metavar="OUT.d", help="Write a make rule for OUT with those files.")
@click.option("--list-args", is_flag=True, help="List the xacro arguments with their defaults.")
@click.option(
    "--check", metavar="OUT", help="Compare with a committed URDF; exit 1 if it is stale."
)
@click.option(
    "--source-map",
    metavar="FILE",
    help="Write where each element came from, as JSON ('-': stdout).",
)
@package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    deps: bool,
    depfile: str | None,
    list_args: bool,
    check: str | None,
    source_map: str | None,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Expand the xacro file IN to URDF, equal as XML to what xacro prints.

    IN is a .xacro or .urdf.xacro file, or '-'. Arguments follow it as name:=value. ROS is not
    needed: $(find NAME) looks in the file's workspace, the configuration, ROS_PACKAGE_PATH and
    AMENT_PREFIX_PATH, and follows install() rules.

    \b
        urdftool expand arm.urdf.xacro prefix:=left_ -o arm.urdf
        urdftool expand arm.urdf.xacro --check arm.urdf
        urdftool expand arm.urdf.xacro -o arm.urdf --depfile arm.d
    """  # noqa: D301 -- click reads the escape
    from ..configuration import find_configuration
    from ..output import check_targets, write_result
    from ..report import expansion as report
    from ..source.document import STDIN, read_file
    from ..source.expand import expand_xacro
    from ..source.packages import Packages

    path, arguments = robot
    if depfile and not output:
        raise click.UsageError("--depfile wants -o OUT, the file its rule is for")
    if sum(map(bool, (deps, list_args, check))) > 1:
        raise click.UsageError("--deps, --list-args and --check exclude each other")
    file = read_file(path)
    packages = Packages(
        None if file.path == STDIN else path,
        named=package,
        paths=package_path,
        configured=find_configuration(path, console.config).packages,
    )
    expansion = expand_xacro(file, arguments, packages)
    for line in report.warnings(expansion, arguments):
        console.note(line)
    inputs = [] if file.path == STDIN else report.files_read(expansion)
    check_targets((None if check else output, source_map, depfile), inputs=inputs)
    if source_map:
        write_result(report.source_map(expansion), source_map, inputs=inputs)
    if deps:
        write_result("".join(f"{name}\n" for name in inputs), output, inputs=inputs)
    elif list_args:
        write_result(report.argument_list(expansion), output, inputs=inputs)
    elif check:
        return _check(console, report.stale(expansion, check), check)
    elif not (source_map == "-" and output is None):
        write_result(expansion.text, output, inputs=inputs)
    if depfile and output:
        write_result(report.make_rule(output, inputs), depfile, inputs=inputs)
    return 0


def _check(console: Console, difference: str, check: str) -> int:
    if difference:
        click.echo(difference, nl=False)
        console.note(f"{check}: is stale; expand again with -o {check}")
        return 1
    console.note(f"{check}: is up to date", level=1)
    return 0
