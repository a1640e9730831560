"""Export of several robots: each as the command exports one, in processes or on a cluster."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console
from ..report.counted import format_count
from ..report.json_text import format_json
from ..source.description_formats import SUFFIXES
from .grouped_help import GroupedCommand
from .options import (
    add_jobs_option,
    add_name_option,
    add_scheduler_option,
    parse_robot,
    split_arguments,
)
from .progress import Progress

if TYPE_CHECKING:
    from ..parallel import Loss

F = TypeVar("F", bound=Callable[..., Any])

_MOST_NAMES = 5  # robots that the last line names; chosen, no source


@dataclass(frozen=True)
class Robots:
    """Value of the argument for several robots."""

    paths: tuple[str, ...]
    arguments: dict[str, str]


@dataclass(frozen=True)
class Outcome:
    """Result of one robot."""

    code: int
    out: str
    err: str


@dataclass(frozen=True)
class Exporter:
    """Function that exports one robot in a worker process; pickled with its options."""

    console: Console
    name: str
    arguments: Mapping[str, str]
    values: Mapping[str, Any]

    def __call__(self, task: tuple[str, str]) -> Outcome:
        """Export a robot."""
        from ..cli import report_failures

        path, output = task
        command: click.Command = import_module(f".export_{self.name}", __package__).command
        function = command.callback
        assert function is not None
        values = {**self.values, "robot": (path, dict(self.arguments)), "output": output}
        context = click.Context(command, info_name=f"urdftool export {self.name}", obj=self.console)
        out, err = StringIO(), StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = report_failures(
                self.console, lambda: context.invoke(function, **values), ("export",)
            )
        return Outcome(code, out.getvalue(), err.getvalue())


class ExportCommand(GroupedCommand):
    """Command of a format, which exports one robot, or several into folders below OUT."""

    def __init__(self, *arguments: Any, groups: Mapping[str, str], **settings: Any) -> None:
        """Add the options for several robots."""
        super().__init__(
            *arguments, groups={**groups, "Several robots": "jobs scheduler"}, **settings
        )

    def invoke(self, ctx: click.Context) -> Any:
        """Call the command, or export each robot."""
        jobs, scheduler = ctx.params.pop("jobs"), ctx.params.pop("scheduler")
        robots = ctx.params["robot"]
        if isinstance(robots, Robots):
            return _export_many(ctx, robots, jobs, scheduler)
        if scheduler is not None:
            raise click.UsageError("--scheduler requires several robots, or a folder", ctx)
        return super().invoke(ctx)


def add_robots_argument(function: F) -> F:
    """Add ``IN… [name:=value …]``, and the options for several robots."""
    function = click.argument(
        "robot", nargs=-1, type=str, metavar="IN... [name:=value ...]", callback=_parse_robots
    )(function)
    return add_name_option(add_jobs_option(add_scheduler_option(function)))


def _parse_robots(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> Robots | tuple[str, dict[str, str]]:
    paths, arguments = split_arguments(words)
    if len(paths) > 1 or any(os.path.isdir(path) for path in paths):
        return Robots(tuple(paths), arguments)
    return parse_robot(ctx, words)


def _export_many(
    ctx: click.Context, robots: Robots, jobs: int | None, scheduler: str | None
) -> int:
    """Export robots into folders, report each in the order of the files; return the exit code."""
    from ..cluster import map_anywhere
    from ..parallel import count_cores

    console: Console = ctx.obj
    output = ctx.params["output"]
    if output in (None, "-") or "-" in robots.paths:
        raise click.UsageError("several robots require -o OUT, a folder, and no '-'", ctx)
    files = _find_robots(ctx, console, robots)
    places = choose_places(files, output)
    values = {key: value for key, value in ctx.params.items() if key not in ("robot", "output")}
    name = str(ctx.info_name)
    work = Exporter(replace(console, shows_progress=False), name, robots.arguments, values)
    found: dict[int, Outcome] = {}
    with Progress(console, "robots") as progress:
        for index, outcome in map_anywhere(
            work,
            list(zip(files, places, strict=True)),
            workers=jobs or count_cores(),
            scheduler=scheduler,
            on_lost=_make_lost,
            tries=1,
            isolate=True,
            preload=(f"urdftool.commands.export_{name}", "urdftool.formats.registry"),
        ):
            found[index] = outcome
            progress(len(found), len(files), files[index])
    outcomes = [found[index] for index in range(len(files))]
    return _report(console, files, places, outcomes, as_json=values["style"] == "json")


def _find_robots(ctx: click.Context, console: Console, robots: Robots) -> list[str]:
    """Return the robots among files and below folders, as ``lint`` finds them."""
    from ..formats.search import find_other_descriptions
    from ..lint.discover import describe_links, explain_nothing_found
    from ..lint.options import Options
    from ..workspace import Workspace
    from .lint_repository import find_repository, list_robot_files

    options = Options(
        packages=ctx.params["package"],
        package_paths=ctx.params["package_path"],
        config=ctx.obj.config,
        workspace=Workspace(),
    )
    found = find_repository(robots.paths, options)
    others = find_other_descriptions(robots.paths)
    files = list_robot_files([*robots.paths, *others.files], found)
    if not files:
        raise click.UsageError(explain_nothing_found(robots.paths), ctx)
    if links := describe_links([*found.links, *others.links]):
        console.print_note(links)
    return files


def choose_places(files: Sequence[str], output: str) -> list[str]:
    """Return a folder for each file, as the files are below the folder that all are in.

    Files that differ only in their ending get numbers: ``arm``, ``arm_2``.
    """
    parents = [os.path.dirname(os.path.abspath(path)) for path in files]
    root = os.path.commonpath(parents)
    places: list[str] = []
    for path in files:
        relative = os.path.relpath(os.path.abspath(path), root)
        ending = next(
            (end for end in (".urdf.xacro", *SUFFIXES) if relative.lower().endswith(end)), ""
        )
        stem = os.path.join(output, relative[: len(relative) - len(ending)])
        place, number = stem, 1
        while place in places:
            number += 1
            place = f"{stem}_{number}"
        places.append(place)
    return places


def _make_lost(task: tuple[str, str], loss: Loss) -> Outcome:
    return Outcome(2, "", f"{task[0]}: the process that exported it ended ({loss.describe()})\n")


def _report(
    console: Console,
    files: Sequence[str],
    places: Sequence[str],
    outcomes: Sequence[Outcome],
    *,
    as_json: bool,
) -> int:
    """Print what each export printed, and the number of robots; return the highest exit code."""
    for path, outcome in zip(files, outcomes, strict=True):
        click.echo(outcome.err, nl=False, err=True)
        if outcome.out and not as_json:
            click.echo(f"{path}\n{outcome.out}", nl=False)
    if as_json:
        click.echo(_format_json(files, places, outcomes), nl=False)
    failed = [path for path, one in zip(files, outcomes, strict=True) if one.code > 1]
    names = ", ".join(failed[:_MOST_NAMES])
    names += f" and {len(failed) - _MOST_NAMES} more" if len(failed) > _MOST_NAMES else ""
    ending = f"; not exported: {names}" if failed else ""
    count = format_count(len(files), "robot")
    console.print_note(f"exported {len(files) - len(failed)} of {count}{ending}")
    return max(outcome.code for outcome in outcomes)


def _format_json(files: Sequence[str], places: Sequence[str], outcomes: Sequence[Outcome]) -> str:
    robots = [
        {
            "path": path,
            "output": Path(place).as_posix(),
            "exit_code": outcome.code,
            "report": json.loads(outcome.out) if outcome.out.strip() else None,
        }
        for path, place, outcome in zip(files, places, outcomes, strict=True)
    ]
    return format_json({"version": 1, "robots": robots}, 1) + "\n"
