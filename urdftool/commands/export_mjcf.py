"""``urdftool export mjcf``: a MuJoCo model."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .options import package_options, robot_argument

if TYPE_CHECKING:
    from ..formats.check import Check
    from ..formats.defects import Refused
    from ..formats.written import Written

FILES = (".xml", ".mjcf")
"""Suffixes of an output that is one file."""


@click.command("mjcf")
@robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="A folder, or a file that ends in .xml or .mjcf; '-' is standard output.",
)
@click.option(
    "--actuators",
    type=click.Choice(("auto", "none", "position", "velocity", "motor")),
    default="auto",
    help="As transmissions and ros2_control say (auto), none, or one kind for all joints.",
)
@click.option(
    "--base",
    type=click.Choice(("auto", "fixed", "free")),
    default="auto",
    help="Whether the root is held; auto: as the description says, held where it says nothing.",
)
@click.option("--scene", is_flag=True, help="Write also scene.xml, with a floor and light.")
@click.option("--srdf", metavar="FILE", type=Path, help="Take over an SRDF's disabled collisions.")
@click.option(
    "--fix-inertia",
    type=click.Choice(("none", "lift", "balance", "box")),
    default="none",
    help="What to do with a tensor that no rigid body has; none: refuse it.",
)
@click.option(
    "--mesh-dir",
    metavar="DIR",
    default="assets",
    show_default=True,
    help="Folder of the meshes, beside the model.",
)
@click.option("--overwrite", is_flag=True, help="Replace also what urdftool did not write.")
@click.option("--strict", is_flag=True, help="What cannot be carried is an error.")
@click.option("--force", is_flag=True, help="Go on past errors where a robot is left.")
@click.option("--verify", "verified", is_flag=True, help="Compile it in MuJoCo and compare.")
@click.option("--format", "style", type=click.Choice(("text", "json")), default="text")
@package_options
@click.pass_obj
def command(
    console: Console,
    /,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    package: dict[str, Path],
    package_path: tuple[str, ...],
    mesh_dir: str,
    overwrite: bool,
    strict: bool,
    verified: bool,
    style: str,
    **choices: Any,
) -> int:
    """Turn the robot IN into a MuJoCo model, and prove that it is the same robot.

    One body a link, with its mass, names and limits as they are; meshes are copied or converted.
    What is lost is said, with its place.

    \b
        urdftool export mjcf panda.urdf -o panda/ --scene --verify
        urdftool export mjcf quadruped.urdf.xacro -o q/ --base free --actuators position
    """  # noqa: D301 -- click's mark for lines it must not wrap
    from ..configuration import find_configuration
    from ..formats import said
    from ..formats.defects import Refused
    from ..formats.directory import write_export
    from ..formats.mjcf.options import Options
    from ..formats.mjcf.verify import verify_copy
    from ..formats.mjcf.write import write
    from ..model.load import robot_of
    from ..source.description import read_description

    if Path(mesh_dir).is_absolute() or ".." in Path(mesh_dir).parts:
        raise click.UsageError("--mesh-dir is a folder beside the model, such as assets")
    path, arguments = robot
    description = read_description(
        path,
        arguments,
        packages=package,
        package_paths=package_path,
        configured=find_configuration(path, console.config).packages,
    )
    file = Path(output).name if output and Path(output).suffix.lower() in FILES else ""
    folder = Path(mesh_dir).as_posix()
    options = Options(mesh_dir="" if folder == "." else folder, file=file, **choices)
    try:
        written = write(robot_of(description), options)
        if strict and (lost := said.strict(written.losses)):
            raise Refused(lost)
    except Refused as refused:
        return _refused(refused, style)
    checks = verify_copy(robot_of(description), options, written) if verified else []
    if output is None or output == "-":
        _print(written, style)
    else:
        inputs: list[str | Path] = [source.path for source in description.files]
        inputs += [options.srdf] if options.srdf is not None else []
        write_export(output, written, single=bool(file), overwrite=overwrite, inputs=inputs)
    return _report(console, written, checks, output, style)


def _refused(refused: Refused, style: str) -> int:
    """Every defect, one a line; nothing is written."""
    from ..formats import said

    if style == "json":
        from ..report.exports import to_json

        click.echo(to_json(None, (), refused.findings, ()), nl=False)
    lines = list(said.lines(refused.findings))
    for line in lines:
        click.echo(line, err=True)
    count = "1 error" if len(lines) == 1 else f"{len(lines)} errors"
    click.echo(f"urdftool: nothing is written: {count}", err=True)
    return 2


def _print(written: Written, style: str) -> None:
    """A model without companions on standard output."""
    from ..errors import OutputError

    content = written.files[written.main]
    if len(written.files) > 1 or not isinstance(content, bytes):
        raise OutputError("meshes or a scene come with the model; say where to with -o OUT")
    if style != "json":
        click.echo(content, nl=False)


def _report(
    console: Console, written: Written, checks: list[Check], output: str | None, style: str
) -> int:
    """Losses on stderr, the table or JSON on stdout; the exit code."""
    from ..finding import Severity
    from ..formats import said
    from ..formats.check import check_table, is_faithful

    shown = [f for f in written.losses if f.severity > Severity.INFO or console.verbosity > 0]
    hidden = len(said.merged(written.losses)) - len(said.merged(shown))
    if style == "json":
        from ..report.exports import to_json

        click.echo(to_json(output, written.files, written.losses, checks), nl=False)
    else:
        for line in said.lines(shown):
            console.note(line)
        if checks:
            click.echo(check_table(checks), nl=False, err=output in (None, "-"))
    if output not in (None, "-"):
        more = f", {hidden} notes (-v shows them)" if hidden else ""
        console.note(f"{output}: {written.main}, {len(written.files)} files{more}")
    return 0 if is_faithful(checks) else 1
