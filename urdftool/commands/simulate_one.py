"""Simulate one robot, judge the result and report it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from ..console import Console
from .progress import Progress

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..simulation.checks.thresholds import Thresholds
    from ..simulation.engine_comparison import EngineComparison
    from ..simulation.engine_process import EngineProcess
    from ..simulation.run import Progress as ReportProgress
    from ..simulation.settings import Settings
    from ..simulation.verdict import Verdict
    from .simulate_outputs import Outputs


def read_configured_thresholds(console: Console, path: str) -> Thresholds:
    """Read the thresholds of the configuration that applies to a description.

    Old names of thresholds are accepted; :func:`print_old_thresholds` warns of them.

    Raises:
        ConfigError: A threshold is unknown, or not a number greater than zero.
    """
    from ..configuration import find_configuration
    from ..simulation.checks.thresholds import read_thresholds

    configuration = find_configuration(path, console.config)
    return read_thresholds(configuration.simulate, configuration.path)


def print_old_thresholds(console: Console, paths: Iterable[str]) -> None:
    """Print a warning for each old name of a threshold in the configurations of descriptions."""
    from ..configuration import find_configuration
    from ..simulation.old_names import find_old_thresholds
    from ..workspace import Workspace

    workspace = Workspace()
    configurations = (find_configuration(path, console.config, workspace) for path in paths)
    tables = {configuration.path: configuration.simulate for configuration in configurations}
    for path, table in tables.items():
        for message in find_old_thresholds(table):
            console.print_note(f"{path}: {message}")


def simulate_and_judge(
    robot: Robot,
    settings: Settings,
    engines: tuple[str, ...],
    thresholds: Thresholds,
    progress: ReportProgress = lambda *_: None,
    child: EngineProcess | None = None,
    *,
    strict: bool = False,
) -> tuple[list[list[Verdict]], EngineComparison | None]:
    """Simulate and judge a robot in each engine; compare two engines.

    ``child`` is a process of the first engine that waits for work.
    ``strict`` makes warnings errors.

    Raises:
        UrdftoolError: The robot cannot be simulated.
    """
    from ..api.simulate import run_trials
    from ..simulation.checks.interpenetration import precompute_overlaps
    from ..simulation.engine_comparison import compare_engines
    from ..simulation.verdict import judge

    waiting = (child, *(None for _ in engines[1:]))
    runs = [
        run_trials(
            robot,
            settings,
            engine=engine,
            progress=progress,
            child=process,
            precompute=precompute_overlaps,
            thresholds=thresholds,
        )
        for engine, process in zip(engines, waiting, strict=True)
    ]
    verdicts = [[judge(robot, run, strict=strict) for run in some] for some in runs]
    if len(engines) < 2:
        return verdicts, None
    return verdicts, compare_engines(*verdicts)


def simulate_one(
    console: Console,
    robot: Robot,
    settings: Settings,
    engines: tuple[str, ...],
    thresholds: Thresholds,
    child: EngineProcess,
    *,
    style: str,
    outputs: Outputs,
    junit: str | None,
    strict: bool = False,
) -> int:
    """Simulate a robot in one or two engines, print the verdict and return the exit code.

    Raises:
        UrdftoolError: The robot cannot be simulated, or a file cannot be written.
    """
    from ..model.files import list_sources
    from ..output import check_targets, write_file
    from ..report import simulate as report
    from ..report import simulate_fleet as rows
    from ..simulation.fleet import make_row

    files = (junit, outputs.plot, outputs.picture, outputs.video)
    check_targets(files, inputs=sorted(list_sources(robot)))
    outputs.read(console, robot)
    with Progress(console, "trials", timed=True) as progress:
        verdicts, comparison = simulate_and_judge(
            robot, settings, engines, thresholds, progress, child, strict=strict
        )
    everything = [verdict for some in verdicts for verdict in some]
    path = robot.source.path if robot.source is not None else ""
    differ = comparison.report_faults(robot) if comparison is not None else []
    row = make_row(path, robot.name, everything, differ)
    if style == "json":
        timings = console.verbosity > 0
        text = report.to_json(robot, everything, timings=timings, comparison=comparison)
        click.echo(text, nl=False)
    elif style == "junit":
        click.echo(rows.to_junit([row]), nl=False)
    else:
        for some in verdicts:
            click.echo(report.format_text(robot, some, colors=console.has_colors()), nl=False)
        if comparison is not None:
            click.echo(
                report.format_comparison_text(comparison, colors=console.has_colors()), nl=False
            )
    if junit is not None:
        write_file(junit, rows.to_junit([row]).encode("utf-8"), inputs=sorted(list_sources(robot)))
    outputs.write(console, robot, [some[0].run for some in verdicts])
    return 0 if row.passes else 1
