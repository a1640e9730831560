"""Simulate several robots, and report them in one table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .progress import Progress

if TYPE_CHECKING:
    from ..simulation.fleet import Row
    from ..simulation.settings import Settings


@dataclass(frozen=True)
class Fleet:
    """Function that simulates one robot in a worker process; pickled with its options."""

    console: Console
    arguments: Mapping[str, str]
    packages: Mapping[str, Path]
    package_paths: tuple[str, ...]
    settings: Settings
    engines: tuple[str, ...]
    controllers: str | None
    strict: bool
    named: frozenset[str]
    cache: str | None

    def __call__(self, path: str, notes: list[str]) -> Row:
        """Simulate and judge one robot.

        Args:
            path: Its description.
            notes: Receives the lines to print; a worker of a cluster prints elsewhere.

        Raises:
            UrdftoolError: The robot cannot be read or simulated.
        """
        from ..simulation.fleet import Row, make_row
        from ..simulation.mesh_cache import set_cache_folder
        from .load_tolerant import load_tolerant
        from .simulate_control import apply_controllers, take_robot_of_scene
        from .simulate_one import read_configured_thresholds, simulate_and_judge

        console = replace(self.console, collected=notes)
        robot = load_tolerant(
            console, path, self.arguments, self.packages, self.package_paths, many=True
        )
        robot = take_robot_of_scene(console, robot)
        set_cache_folder(robot, self.cache)
        if not robot.links and path not in self.named:
            return Row(path, robot.name, skipped="the file has only macros and no link")
        settings = apply_controllers(
            console, self.settings, robot, self.controllers, strict=self.strict
        )
        thresholds = read_configured_thresholds(console, path)
        verdicts, comparison = simulate_and_judge(
            robot, settings, self.engines, thresholds, strict=self.strict
        )
        differ = comparison.report_faults(robot) if comparison is not None else []
        return make_row(path, robot.name, [v for some in verdicts for v in some], differ)


def simulate_fleet(
    fleet: Fleet,
    paths: Sequence[str],
    *,
    style: str,
    junit: str | None,
    jobs: int | None,
    scheduler: str | None = None,
) -> int:
    """Simulate files and the descriptions in folders, and return the exit code.

    Raises:
        OutputError: The JUnit file cannot be written.
    """
    from ..lint.discover import describe_links, explain_nothing_found, find_descriptions
    from ..output import write_file
    from ..report import simulate_fleet as report
    from ..simulation import verdict  # noqa: F401 -- loaded before workers are forked
    from ..simulation.engine_process import SLOWEST
    from ..simulation.fleet import PATIENCE, run_in_parallel
    from .simulate_one import print_old_thresholds

    console = fleet.console
    links: list[str] = []
    descriptions = find_descriptions(paths, links)
    if not descriptions:
        raise click.UsageError(explain_nothing_found(paths))
    if links:
        console.print_note(describe_links(links))
    print_old_thresholds(console, descriptions)
    limit = len(fleet.engines) * SLOWEST * fleet.settings.time_limit + PATIENCE
    rows = {}
    with Progress(console, "robots") as progress:
        for row in run_in_parallel(
            descriptions, fleet, jobs=jobs, limit=limit, scheduler=scheduler
        ):
            rows[row.path] = row
            progress(len(rows), len(descriptions), row.path)
    ordered = [rows[path] for path in descriptions]
    for row in ordered:
        for line in row.notes:
            console.print_line(line)
    if junit is not None:
        write_file(junit, report.to_junit(ordered).encode("utf-8"), inputs=descriptions)
    if style == "json":
        click.echo(report.to_json(ordered, timings=console.verbosity > 0), nl=False)
    elif style == "junit":
        click.echo(report.to_junit(ordered), nl=False)
    else:
        text = report.format_table(
            ordered, colors=console.has_colors(), skipped=console.verbosity > 0
        )
        click.echo(text, nl=False)
    for row in ordered:
        if row.error is not None and (style != "text" or console.verbosity > 0):
            console.print_error(row.error)
    if any(row.error is not None for row in ordered):
        return 2
    return 1 if any(row.passes is False for row in ordered) else 0
