"""``urdftool expand``: expand xacro to URDF."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import add_package_options, add_robot_argument, make_output_option

_GROUPS = {
    "What to do": "output check deps list_args",
    "More output": "depfile source_map",
}


@click.command("expand", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@make_output_option("Output file.  [default: standard output]")
@click.option("--deps", is_flag=True, help="Print the files that are read, instead of the URDF.")
@click.option("--depfile", metavar="OUT.d", help="Write a make rule with the dependencies of OUT.")
@click.option(
    "--list-args", is_flag=True, help="Print the xacro arguments and their defaults, not the URDF."
)
@click.option(
    "--check", metavar="OUT", help="Compare with the URDF file OUT; exit with 1 if it is outdated."
)
@click.option(
    "--source-map",
    metavar="FILE",
    help="Write the source position of each element as JSON ('-': standard output).",
)
@add_package_options
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
    """Expand the xacro file IN to URDF, without ROS; the XML equals that of xacro.

    IN is a .xacro file or '-' (standard input); xacro arguments follow as name:=value. Packages of
    $(find NAME) are searched in the file's workspace, the configuration, ROS_PACKAGE_PATH and
    AMENT_PREFIX_PATH; install() rules are followed.

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
        raise click.UsageError("--depfile requires -o OUT, the target of its make rule")
    if depfile and output and not report.is_target(output):
        raise click.UsageError(f"--depfile: a make rule cannot begin with the name '{output}'")
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
    for line in report.format_warnings(expansion, arguments):
        console.print_note(line)
    inputs = [] if file.path == STDIN else report.format_files_read(expansion)
    check_targets((None if check else output, source_map, depfile), inputs=inputs)
    if source_map:
        write_result(report.format_source_map(expansion), source_map, inputs=inputs)
    if deps:
        write_result("".join(f"{name}\n" for name in inputs), output, inputs=inputs)
    elif list_args:
        write_result(report.format_argument_list(expansion), output, inputs=inputs)
    elif check:
        return _check(console, report.make_diff_with_committed(expansion, check), check)
    elif not (source_map == "-" and output is None):
        write_result(expansion.text, output, inputs=inputs)
    if depfile and output:
        for name in report.list_not_in_rule(inputs):
            reason = f"a make rule cannot name '{name}'; make does not see its changes"
            console.print_note(f"{depfile}: warning: {reason}")
        write_result(report.make_rule(output, inputs), depfile, inputs=inputs)
    return 0


def _check(console: Console, difference: str, check: str) -> int:
    if difference:
        click.echo(difference, nl=False)
        console.print_note(f"{check}: is outdated; update it with -o {check}")
        return 1
    console.print_note(f"{check}: is up to date", level=1)
    return 0
