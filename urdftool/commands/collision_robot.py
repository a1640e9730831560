"""The work of ``urdftool collision`` on one robot or a fleet: read, compute, write, tell."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..collision.links import LinkPlan, Wishes, plan
from ..collision.parallel import compute_all
from ..collision.rewrite import Layout, layout_for, name_pieces, rewritten
from ..configuration import find_configuration
from ..console import Console
from ..errors import UrdftoolError
from ..model.load import robot_of
from ..report import collision as report
from ..source.description import read_description
from .collision_options import Progress, cache_of, given_names, settings_of
from .picture_file import write_picture
from .read_lax import take_world
from .read_strict import say_unknown

if TYPE_CHECKING:
    from ..collision.cache import Cache
    from ..collision.compute import Result, Task
    from ..model.elements import Robot

Values = dict[str, Any]


@dataclass
class Job:
    """A robot on its way: read, and what is to be done to it."""

    path: str
    robot: Robot
    plans: list[LinkPlan]
    output: str | None

    @property
    def tasks(self) -> list[Task]:
        """The meshes it needs."""
        return [use.task for item in self.plans for use in item.uses if use.task is not None]


def one(
    ctx: click.Context, console: Console, path: str, arguments: dict[str, str], values: Values
) -> int:
    """One robot; what is wrong with it ends the command."""
    robot = _read(console, path, arguments, values)
    wishes = _wishes(ctx, console, path, values)
    if values["check"]:
        from .collision_check import check

        code = check(console, [(robot, wishes)], values)
        if values["picture"]:
            _draw(values["picture"], robot, [], {})
        return code
    job = _planned(console, path, robot, wishes, values["output"])
    cache = cache_of(values)
    results = _compute(console, job.tasks, cache, values)
    problems = [found for found in results.values() if isinstance(found, UrdftoolError)]
    _refuse(console, problems)
    done = {task: found for task, found in results.items() if not isinstance(found, UrdftoolError)}
    text = _write(console, job, done, values)
    _tell(console, [text], values)
    if values["picture"]:
        _draw(values["picture"], robot, job.plans, done)
    if cache.trouble:
        console.note(f"results could not be kept in the cache: {cache.trouble}")
    return 0


def _draw(
    picture: str, robot: Robot, plans: Sequence[LinkPlan], results: dict[Task, Result]
) -> None:
    from ..collision.picture import robot_picture

    write_picture(robot_picture(robot, plans, results), picture, robot)


def fleet(
    ctx: click.Context,
    console: Console,
    paths: Sequence[str],
    arguments: dict[str, str],
    values: Values,
) -> int:
    """Many robots, their meshes in one heap; what is wrong with one does not stop the others."""
    from ..lint.discover import find_descriptions

    files = find_descriptions(paths)
    if not files:
        raise click.UsageError(f"no .urdf or .urdf.xacro below {', '.join(paths)}")
    if values["picture"]:
        raise click.UsageError("--picture draws one robot, not several")
    root = os.path.commonpath([os.path.abspath(p) for p in paths])
    root = root if os.path.isdir(root) else os.path.dirname(root)
    code = 0
    jobs: list[Job] = []
    checks: list[tuple[Robot, Wishes]] = []
    for path in files:
        try:
            robot = _read(console, path, arguments, values)
            if not robot.links:
                console.note(f"{path}: skipped, it has no links of its own", level=1)
                continue
            wishes = _wishes(ctx, console, path, values)
            if values["check"]:
                checks.append((robot, wishes))
                continue
            jobs.append(_planned(console, path, robot, wishes, _place(values, path, root)))
        except UrdftoolError as error:
            console.error(error)
            code = 2
    if values["check"]:
        from .collision_check import check

        return max(code, check(console, checks, values))
    cache = cache_of(values)
    results = _compute(console, [task for job in jobs for task in job.tasks], cache, values)
    reports = []
    for job in jobs:
        try:
            _refuse(
                console,
                [f for t in job.tasks if isinstance(f := results[t], UrdftoolError)],
            )
            own = {t: f for t in job.tasks if not isinstance(f := results[t], UrdftoolError)}
            reports.append(_write(console, job, own, values))
        except UrdftoolError as error:
            console.error(error)
            code = 2
    _tell(console, reports, values)
    return code


def _read(console: Console, path: str, arguments: dict[str, str], values: Values) -> Robot:
    description = read_description(
        path,
        arguments,
        packages=values["package"],
        package_paths=values["package_path"],
        configured=find_configuration(path, console.config).packages,
    )
    say_unknown(console, description)
    return take_world(console, robot_of(description))


def _wishes(ctx: click.Context, console: Console, path: str, values: Values) -> Wishes:
    configuration = find_configuration(path, console.config)
    return Wishes(
        settings_of(values),
        values["source"],
        values["only"],
        values["skip"],
        values["keep_primitives"],
        configuration.collision,
        configuration.path,
        given_names(ctx),
    )


def _planned(console: Console, path: str, robot: Robot, wishes: Wishes, output: str | None) -> Job:
    plans, problems = plan(robot, wishes)
    _refuse(console, problems)
    return Job(path, robot, plans, output)


def _refuse(console: Console, problems: Sequence[UrdftoolError]) -> None:
    """Say all that is wrong with meshes, the last as the error that ends the work."""
    unique = list({str(problem): problem for problem in problems}.values())
    for problem in unique[:-1]:
        console.error(problem)
    if unique:
        last = unique[-1]
        last.notes = (*last.notes, "nothing was written; --skip-link NAME leaves a link as it is")
        raise last


def _compute(
    console: Console, tasks: Sequence[Task], cache: Cache, values: Values
) -> dict[Task, Result | UrdftoolError]:
    with Progress(console) as progress:
        return compute_all(
            tasks,
            cache,
            jobs=values["jobs"],
            scheduler=values["scheduler"],
            progress=progress,
        )


def _place(values: Values, path: str, root: str) -> str | None:
    """Where a robot of a fleet goes: below the output folder as it lies below the given ones."""
    if values["output"] is None:
        return None
    relative = os.path.relpath(os.path.abspath(path), root)
    name = relative.removesuffix(".xacro")
    return os.path.join(values["output"], name)


def _write(
    console: Console, job: Job, results: dict[Task, Result], values: Values
) -> report.Report:
    from ..collision.mesh_files import write_all

    to_stdout = job.output == "-"
    target = Path(job.output if job.output and not to_stdout else job.path)
    if to_stdout:
        target = Path.cwd() / (Path(job.path).name if job.path != "-" else "robot.urdf")
    mesh_dir = Path(values["mesh_dir"]) if values["mesh_dir"] else None
    layout = layout_for(job.robot, target, mesh_dir, values["uri"], f".{values['mesh_format']}")
    name_pieces(layout, results)
    assert job.robot.source is not None
    inputs = [file.path for file in job.robot.source.files]
    if values["in_place"]:
        from ..collision.in_place import edited

        found = edited(job.robot, job.plans, results, layout)
        for refusal in found.refused:
            console.say(refusal)
        keep = {path for task in found.used for path in _paths(layout, results[task])}
        files = {path: data for path, data in layout.files.items() if path in keep}
        files.update({Path(name): data for name, data in found.files.items()})
        write_all(files, overwrite=values["overwrite"])
        plans = found.plans
    else:
        text = rewritten(job.robot, job.plans, results, layout)
        files = dict(layout.files)
        if not to_stdout:
            files[target] = text
            if target.suffix.lower() not in (".urdf", ".xml"):
                raise click.UsageError(f"OUT wants to end in .urdf; '{job.output}' does not")
        _need_folder(target, values)
        write_all(files, overwrite=values["overwrite"], inputs=inputs)
        if to_stdout:
            click.echo(text.decode("utf-8", "replace"), nl=False)
        plans = job.plans
    touched = {item.link.name for item in plans}
    left = [link.name for link in job.robot.links if link.name not in touched]
    output = job.path if values["in_place"] else str(job.output)
    return report.Report(job.path, output, _rows(plans, results, layout), left)


def _need_folder(target: Path, values: Values) -> None:
    from ..errors import OutputError

    above = Path(os.path.abspath(target)).parent
    if not above.is_dir() and not values["output"]:
        raise OutputError(f"the folder {above} does not exist", path=target)


def _paths(layout: Layout, result: Result) -> list[Path]:
    uris = set(layout.names[id(result)])
    from ..collision.rewrite import uri_of

    return [path for path in layout.files if uri_of(path, layout) in uris]


def _rows(
    plans: Sequence[LinkPlan], results: dict[Task, Result], layout: Layout
) -> list[report.Row]:
    rows = []
    for item in plans:
        for use in item.uses:
            if use.task is None:
                continue
            result = results[use.task]
            rows.append(
                report.Row(
                    item.link.name,
                    str(use.task.path),
                    use.task.scale,
                    result,
                    use.task.settings.max_error,
                    tuple(layout.names[id(result)]),
                    item.source,
                    use.task.settings.method,
                )
            )
    return rows


def _tell(console: Console, reports: Sequence[report.Report], values: Values) -> None:
    to_stderr = values["output"] == "-"
    if values["style"] == "json":
        click.echo(report.as_json(reports), nl=False, err=to_stderr)
    for found in reports:
        if values["style"] == "table":
            click.echo(report.table(found.rows), nl=False, err=to_stderr)
        for line in (*report.remarks(found.rows), *report.failures(found.rows)):
            console.say(line)
        for line in report.notes(found.rows):
            console.note(line, level=1)
        console.note(report.summary(found))
