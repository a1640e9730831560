"""``urdftool inertia robot``: check, complete, recompute or lump the inertia of a robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import (
    add_gltf_option,
    add_jobs_option,
    add_package_options,
    add_robot_argument,
    make_format_option,
)
from .progress import Progress
from .read_other import read_any

if TYPE_CHECKING:
    from ..inertia.link_review import LinkReview
    from ..inertia.masses import Masses
    from ..model.elements import Robot


def _parse_pairs(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, float]:
    """Parse ``NAME=NUMBER`` values."""
    values_by_link: dict[str, float] = {}
    for value in values:
        name, equals, number = value.rpartition("=")
        if not (equals and name):
            raise click.BadParameter(f"'{value}' is not {parameter.metavar}", ctx, parameter)
        try:
            values_by_link[name] = float(number)
        except ValueError:
            raise click.BadParameter(
                f"'{number}' in '{value}' is not a number", ctx, parameter
            ) from None
    return values_by_link


_GROUPS = {
    "What to do": "write diff all_links lump pose",
    "Mass and geometry": "masses mass_file density total source only",
    "Output": "output style",
    "Performance": "jobs",
}


@click.command("robot", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="Output file.  [default: standard output; with --write, the source files]",
)
@click.option(
    "--from",
    "source",
    type=click.Choice(["collision", "visual"]),
    help="Geometry for the inertia.  [default: collision; visual for links without collisions]",
)
@click.option(
    "--mass",
    "masses",
    multiple=True,
    callback=_parse_pairs,
    metavar="LINK=KG",
    help="Mass of a link [kg]. Repeatable.",
)
@click.option(
    "--masses", "mass_file", metavar="FILE", help="CSV or YAML file with links and masses [kg]."
)
@click.option("--density", type=float, metavar="D", help="Density of the other links [kg/m³].")
@click.option(
    "--total-mass",
    "total",
    type=float,
    metavar="KG",
    help="Total mass of the robot [kg]; the remainder is divided among the other links by volume.",
)
@click.option(
    "--link", "only", multiple=True, metavar="NAME", help="Process only this link. Repeatable."
)
@click.option("--write", is_flag=True, help="Add missing inertials to the source files or to OUT.")
@click.option("--diff", is_flag=True, help="Print the changes of --write as a diff; write no file.")
@click.option(
    "--all", "all_links", is_flag=True, help="Recompute the existing masses and inertials, too."
)
@click.option(
    "--lump", is_flag=True, help="Lump links with fixed joints together; also the whole robot."
)
@click.option(
    "--pose",
    multiple=True,
    callback=_parse_pairs,
    metavar="JOINT=VALUE",
    help="With --lump: position of a joint [rad or m]. Repeatable.",
)
@make_format_option("table", "json")
@add_jobs_option
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    source: str | None,
    masses: dict[str, float],
    mass_file: str | None,
    density: float | None,
    total: float | None,
    only: tuple[str, ...],
    write: bool,
    diff: bool,
    all_links: bool,
    lump: bool,
    pose: dict[str, float],
    style: str,
    jobs: int | None,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Check the inertia of every link of the robot IN, add what is missing, or recompute it.

    A table compares the values of the file with those of the geometry at uniform density, and marks
    physically inconsistent ones. --write edits the source files and changes only the bytes of these
    values; values that xacro computes are reported and not changed.

    \b
        urdftool inertia robot arm.urdf.xacro
        urdftool inertia robot arm.urdf --diff --total-mass 18.4
        urdftool inertia robot arm.urdf --write --total-mass 18.4
        urdftool inertia robot arm.urdf --write --mass base_link=4.5 --density 2700 -o filled.urdf
        urdftool inertia robot arm.urdf --lump --pose elbow=1.57

    Exit code 1: a value is physically inconsistent; with --diff, something would be written.
    """  # noqa: D301 -- \b is a character that click looks for
    _check_options(density, total, write or diff, lump, pose, output)
    if diff and output is not None:
        raise click.UsageError("--diff writes no file; remove -o")
    from ..inertia.mass_file import read_masses
    from ..inertia.masses import Masses, check_masses
    from ..inertia.review import review
    from ..lint.validate import require
    from .load_tolerant import add_implicit_world

    path = robot[0]
    if write and path == "-" and output is None:
        raise click.UsageError("standard input cannot be edited in place; add -o OUT to --write")
    by_link = {**(read_masses(mass_file) if mass_file else {}), **masses}
    edit = "--write" if write else "--diff" if diff else ""
    read = read_any(console, robot, package, package_path, edit=edit)
    model = add_implicit_world(console, require(read, "links"))
    names = [link.name for link in model.links]
    check_masses(Masses(dict.fromkeys(only, 1.0)), names)
    amounts = Masses(by_link, density, total, all_links)
    with Progress(console, "meshes") as progress:
        reviews = review(
            model,
            _make_reader(model.source, jobs, progress),
            masses=amounts,
            source=source,
            only=only,
        )
    if lump:
        return _lump(console, model, reviews, pose, style, output)
    if diff:
        return _print_diff(console, model, reviews, amounts)
    if write:
        return _write(console, model, reviews, amounts, style, output)
    return _show(console, model, reviews, style, output)


def _check_options(
    density: float | None,
    total: float | None,
    write: bool,
    lump: bool,
    pose: dict[str, float],
    output: str | None,
) -> None:
    if density is not None and total is not None:
        raise click.UsageError(
            "--density and --total-mass exclude each other, because the geometry relates them"
        )
    if write and lump:
        raise click.UsageError("--lump excludes --write and --diff")
    if pose and not lump:
        raise click.UsageError("--pose requires --lump")
    if output and output.endswith((".urdf", ".xacro")) and not write:
        raise click.UsageError(f"the output is a table; add --write to write the robot to {output}")


def _make_reader(description: Any, jobs: int | None, progress: Progress) -> Any:
    from ..inertia.mesh_files import read_meshes

    return lambda names: read_meshes(description, names, jobs=jobs, progress=progress)


def _show(
    console: Console, model: Robot, found: list[LinkReview], style: str, output: str | None
) -> int:
    from ..model.files import list_sources
    from ..output import write_result
    from ..report import inertia_robot as report

    assert model.source is not None
    colors = console.has_colors(to_file=output not in (None, "-"))
    if style == "json":
        text = report.as_json(report.as_dict(found, model.name, model.source.path))
    else:
        text = report.format_table(found, colors=colors)
        lines = report.format_remarks(found, form=model.format, colors=colors)
        remarks = [f"{line}\n" for line in lines]
        text += "".join(["\n", *remarks] if remarks else [])
    write_result(text, output, inputs=sorted(list_sources(model)))
    console.print_note(report.summarize(found))
    return int(any(item.status == "wrong" for item in found))


def _lump(
    console: Console,
    model: Robot,
    found: list[LinkReview],
    pose: dict[str, float],
    style: str,
    output: str | None,
) -> int:
    from ..inertia.lump import lump
    from ..model.files import list_sources
    from ..output import write_result
    from ..report import inertia_lump as report
    from ..report.inertia_robot import format_geometry_remarks

    assert model.source is not None
    lumped = lump(model, found, pose)
    text = report.as_json(lumped, model) if style == "json" else report.format_table(lumped)
    write_result(text, output, inputs=sorted(list_sources(model)))
    implied = {note.data["link"] for note in lumped.notes if note.code == "implied-inertia"}
    for item in found:
        if item.link.name in implied:
            for line in format_geometry_remarks(item):
                console.print_message(line)
    for note in lumped.notes:
        console.print_note(note.message)
    return int(any(item.status == "wrong" for item in found))


def _write(
    console: Console,
    model: Robot,
    found: list[LinkReview],
    amounts: Masses,
    style: str,
    output: str | None,
) -> int:
    from ..inertia.fill_check import plan_checked_filling
    from ..output import write_result
    from ..report import inertia_fill as report
    from .inertia_write import write_files

    assert model.source is not None
    filling, edited = plan_checked_filling(model, found, amounts, single=output is not None)
    files = write_files(model, edited, output)
    text = report.as_json(filling, model) if style == "json" else report.format_text(filling)
    if output == "-":
        click.echo(text, err=True, nl=False)
    else:
        write_result(text, None)
    for line in report.format_remarks(filling):
        console.print_message(line)
    console.print_note(report.summarize(filling, files))
    return int(bool(filling.refused) or filling.still_wrong)


def _print_diff(console: Console, model: Robot, found: list[LinkReview], amounts: Masses) -> int:
    """Print the changes as a unified diff; return 1 if there are any."""
    from ..inertia.fill_check import plan_checked_filling
    from ..report import inertia_fill as report
    from ..report.file_diff import format_file_diff

    assert model.source is not None
    filling, edited = plan_checked_filling(model, found, amounts)
    before = {file.path: file.data for file in model.source.files}
    click.echo(
        "".join(format_file_diff(path, before[path], edited[path]) for path in edited), nl=False
    )
    for line in report.format_remarks(filling):
        console.print_message(line)
    return int(bool(edited) or bool(filling.refused) or filling.still_wrong)
