"""Simplify the collision geometry of one robot or several: read, compute, write, report."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

import click

from ..collision.links import CollisionOptions, LinkPlan, plan
from ..collision.parallel import compute_all
from ..collision.robot import SUFFIXES, Place, check_place, collect_tasks, write_robot
from ..configuration import find_configuration
from ..console import Console
from ..errors import UrdftoolError
from ..lint.validate import require
from ..report import collision as report
from .collision_options import list_given, make_settings, open_cache
from .load_tolerant import add_implicit_world
from .picture_file import check_picture, write_picture
from .progress import Progress
from .read_other import read_any

if TYPE_CHECKING:
    from ..collision.compute import Result, Task
    from ..model.elements import Robot
    from ..storage import DiskCache

Values = dict[str, Any]

_FEW = 6  # links up to which a message names each


@dataclass
class Job:
    """Robot that was read, with the plans for its links and the place of its output."""

    path: str
    robot: Robot
    plans: list[LinkPlan]
    place: Place
    output: str

    @property
    def tasks(self) -> list[Task]:
        """Meshes to simplify."""
        return collect_tasks(self.plans)


def process_one(
    ctx: click.Context, console: Console, path: str, arguments: dict[str, str], values: Values
) -> int:
    """Process one robot, and return the exit code.

    Raises:
        UrdftoolError: The robot cannot be read, or a mesh cannot be simplified.
    """
    robot = require(_read(console, path, arguments, values), "links")
    check_picture(values["picture"], robot)
    options = _make_collision_options(ctx, console, path, values)
    if values["check"]:
        from .collision_check import check

        code = check(console, [(robot, options)], values)
        if values["picture"]:
            _draw(values["picture"], robot, [], {})
        return code
    job = _make_job(console, path, robot, options, values["output"], values)
    cache = open_cache(values)
    results = _compute(console, job.tasks, cache, values)
    _refuse_failed(console, job, results)
    finished = {
        task: found for task, found in results.items() if not isinstance(found, UrdftoolError)
    }
    _report(console, [_write(console, job, finished)], values)
    if values["spheres_file"]:
        _write_spheres(console, values["spheres_file"], job, finished)
    if values["picture"]:
        _draw(values["picture"], robot, job.plans, finished)
    if cache.trouble:
        console.print_note(f"the results were not stored in the cache: {cache.trouble}")
    return 0


def _write_spheres(console: Console, path: str, job: Job, results: dict[Task, Result]) -> None:
    from ..collision.planner_files import (
        collect_planner_spheres,
        format_curobo_yaml,
        format_pyroki_json,
    )
    from ..model.files import list_sources
    from ..output import write_file

    spheres = collect_planner_spheres(job.plans, results)
    text = (
        format_pyroki_json(spheres)
        if path.lower().endswith(".json")
        else format_curobo_yaml(spheres)
    )
    write_file(path, text.encode(), inputs=sorted(list_sources(job.robot)))
    count = sum(map(len, spheres.values()))
    console.print_note(f"wrote {path}, {count} spheres of {len(spheres)} links")


def _draw(
    picture: str, robot: Robot, plans: Sequence[LinkPlan], results: dict[Task, Result]
) -> None:
    from ..collision.picture import draw_robot

    write_picture(draw_robot(robot, plans, results), picture, robot)


def process_fleet(
    ctx: click.Context,
    console: Console,
    paths: Sequence[str],
    arguments: dict[str, str],
    values: Values,
) -> int:
    """Process several robots with one pool of workers; an error in one does not stop the others."""
    from ..lint.discover import describe_links, explain_nothing_found, find_descriptions

    links: list[str] = []
    files = find_descriptions(paths, links)
    if not files:
        raise click.UsageError(explain_nothing_found(paths))
    if links:
        console.print_note(describe_links(links))
    if values["picture"]:
        raise click.UsageError("--picture does not support several robots")
    root = os.path.commonpath([os.path.abspath(p) for p in paths])
    root = root if os.path.isdir(root) else os.path.dirname(root)
    code = 0
    jobs: list[Job] = []
    checks: list[tuple[Robot, CollisionOptions]] = []
    for path in files:
        try:
            robot = _read(console, path, arguments, values)
            if not robot.links:
                console.print_note(f"{path}: skipped, the file has no links", level=1)
                continue
            options = _make_collision_options(ctx, console, path, values)
            if values["check"]:
                checks.append((robot, options))
                continue
            jobs.append(
                _make_job(
                    console, path, robot, options, _make_output_path(values, path, root), values
                )
            )
        except UrdftoolError as error:
            console.print_error(error)
            code = 2
    if values["check"]:
        from .collision_check import check

        return max(code, check(console, checks, values))
    cache = open_cache(values)
    results = _compute(console, [task for job in jobs for task in job.tasks], cache, values)
    reports = []
    for job in jobs:
        try:
            _refuse_failed(console, job, results)
            own = {t: f for t in job.tasks if not isinstance(f := results[t], UrdftoolError)}
            reports.append(_write(console, job, own))
        except UrdftoolError as error:
            console.print_error(error)
            code = 2
    _report(console, reports, values)
    return code


def _read(console: Console, path: str, arguments: dict[str, str], values: Values) -> Robot:
    named, edit = (path, arguments), "" if values["check"] else "'collision' without --check"
    robot = read_any(console, named, values["package"], values["package_path"], edit=edit)
    return add_implicit_world(console, robot)


def _make_collision_options(
    ctx: click.Context, console: Console, path: str, values: Values
) -> CollisionOptions:
    configuration = find_configuration(path, console.config)
    return CollisionOptions(
        make_settings(values),
        values["source"],
        values["only"],
        values["skip"],
        values["keep_primitives"],
        values["per"] == "mesh",
        configuration.collision,
        configuration.path,
        list_given(ctx),
    )


def _make_job(
    console: Console,
    path: str,
    robot: Robot,
    options: CollisionOptions,
    output: str | None,
    values: Values,
) -> Job:
    place = _place(path, output, values)
    check_place(robot, place)
    if place.in_place and robot.source is not None and robot.source.expansion is not None:
        if values["per"] == "link":
            raise click.UsageError("--in-place edits a xacro file --per mesh; use -o OUT")
        options = replace(options, per_mesh=True)  # origins can be computed
    plans, problems = plan(robot, options)
    _refuse(console, problems)
    return Job(path, robot, plans, place, path if place.in_place else str(output))


def _place(path: str, output: str | None, values: Values) -> Place:
    """Choose the place of the output; with ``-o -``, mesh files go to the current folder."""
    bare = output == "-"
    target = Path(output if output and not bare else path)
    if bare:
        target = Path.cwd() / (target.name if path != "-" else "robot.urdf")
    elif output and target.suffix.lower() not in SUFFIXES:
        raise click.UsageError(f"OUT must end in .urdf, but is '{output}'")
    return Place(
        target,
        Path(values["mesh_dir"]) if values["mesh_dir"] else None,
        values["uri"],
        values["mesh_format"],
        values["in_place"],
        bare,
        values["overwrite"],
    )


def _refuse_failed(console: Console, job: Job, results: dict[Task, Result | UrdftoolError]) -> None:
    """Report the meshes that could not be simplified, with their links.

    Raises:
        UrdftoolError: There is such a mesh.
    """
    problems, links = [], []
    for item in job.plans:
        failed = [f for t in collect_tasks([item]) if isinstance(f := results[t], UrdftoolError)]
        problems += failed
        links += [item.link.name] * bool(failed)
    _refuse(console, problems, links)


def _refuse(console: Console, problems: Sequence[UrdftoolError], links: Sequence[str] = ()) -> None:
    """Report all problems, and raise the last of them.

    Raises:
        UrdftoolError: There is a problem.
    """
    unique = list({str(problem): problem for problem in problems}.values())
    for problem in unique[:-1]:
        console.print_error(problem)
    if unique:
        last = unique[-1]
        names = links if 0 < len(links) <= _FEW else ("NAME",)
        skips = " ".join(f"--skip-link {quote(name)}" for name in names)
        which = "skips a link" if len(names) == 1 else "skips these links"
        last.notes = (*last.notes, f"no file was written; {skips} {which}")
        raise last


def _compute(
    console: Console, tasks: Sequence[Task], cache: DiskCache, values: Values
) -> dict[Task, Result | UrdftoolError]:
    with Progress(console, "meshes", patience=0) as progress:
        return compute_all(
            tasks,
            cache,
            jobs=values["jobs"],
            scheduler=values["scheduler"],
            progress=progress,
        )


def _make_output_path(values: Values, path: str, root: str) -> str | None:
    """Return the output path of one of several robots, relative to the common input folder."""
    if values["output"] is None:
        return None
    relative = os.path.relpath(os.path.abspath(path), root)
    name = relative.removesuffix(".xacro")
    return os.path.join(values["output"], name)


def _write(console: Console, job: Job, results: dict[Task, Result]) -> report.Report:
    written = write_robot(job.robot, job.plans, results, job.place)
    for refusal in written.refused:
        console.print_message(refusal)
    if job.place.bare:
        click.echo(written.text.decode("utf-8", "replace"), nl=False)
    rows = report.get_rows(written, results)
    return report.Report(job.path, job.output, rows, written.list_unchanged(job.robot))


def _report(console: Console, reports: Sequence[report.Report], values: Values) -> None:
    to_stderr = values["output"] == "-"
    if values["style"] == "json":
        click.echo(report.as_json(reports, timings=console.verbosity > 0), nl=False, err=to_stderr)
    for found in reports:
        if values["style"] == "table":
            click.echo(report.format_table(found.rows), nl=False, err=to_stderr)
        for line in (*report.format_remarks(found.rows), *report.format_failures(found.rows)):
            console.print_message(line)
        for line in report.format_notes(found.rows):
            console.print_note(line, level=1)
        console.print_note(report.summarize(found))
