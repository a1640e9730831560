"""Many robots simulated and told of in one table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
    """How each robot is simulated; it is sent to the process that does it.

    Attributes:
        console: The configuration that was named.
        arguments: Values for xacro arguments.
        packages: Folders by package name.
        package_paths: Folders with packages below.
        settings: How each is spawned.
        engines: Names of engines.
        controllers: A file of controllers.
        strict: Whether controllers of an unknown type are refused.
        named: Descriptions that were named, and not found in a folder.
        cache: Where what is needed of meshes is kept; None keeps nothing.
    """

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

    def __call__(self, path: str) -> Row:
        """Simulate and judge one robot.

        Raises:
            UrdftoolError: It cannot be.
        """
        from ..simulation.fleet import Row, make_row
        from ..simulation.hull_cache import using_cache
        from .read_lax import read_lax
        from .simulate_control import controlled
        from .simulate_one import configured_thresholds, judged

        robot = read_lax(
            self.console, path, self.arguments, self.packages, self.package_paths, many=True
        )
        if not robot.links and path not in self.named:
            return Row(path, robot.name, skipped="only macros: it has no link of its own")
        settings = controlled(
            self.console, self.settings, robot, self.controllers, strict=self.strict
        )
        with using_cache(self.cache):
            thresholds = configured_thresholds(self.console, path)
            verdicts, comparison = judged(robot, settings, self.engines, thresholds)
        differ = comparison.faults(robot) if comparison is not None else []
        return make_row(path, robot.name, [v for some in verdicts for v in some], differ)


def simulate_fleet(
    fleet: Fleet,
    paths: Sequence[str],
    *,
    style: str,
    junit: str | None,
    jobs: int | None,
) -> int:
    """Simulate descriptions, and those below folders; the exit code.

    Args:
        fleet: How.
        paths: Files and folders.
        style: ``text``, ``json`` or ``junit``.
        junit: A file for JUnit XML, beside what is shown.
        jobs: Processes; None is one for each core.

    Raises:
        OutputError: The file cannot be written.
    """
    from ..lint.discover import find_descriptions, nothing_below
    from ..output import write_file
    from ..report import simulate_fleet as report
    from ..simulation import verdict  # noqa: F401 -- forked workers then have it
    from ..simulation.fleet import PATIENCE, in_parallel

    console = fleet.console
    found = find_descriptions(paths)
    if not found:
        raise click.UsageError(nothing_below(paths))
    limit = len(fleet.engines) * fleet.settings.time_limit + PATIENCE
    rows = {}
    with Progress(console, "robots") as progress:
        for row in in_parallel(found, fleet, jobs=jobs, limit=limit):
            rows[row.path] = row
            progress(len(rows), len(found), row.path)
    ordered = [rows[path] for path in found]
    if junit is not None:
        write_file(junit, report.to_junit(ordered).encode("utf-8"), inputs=found)
    if style == "json":
        click.echo(report.to_json(ordered, timings=console.verbosity > 0), nl=False)
    elif style == "junit":
        click.echo(report.to_junit(ordered), nl=False)
    else:
        text = report.table(ordered, colors=console.colors(), skipped=console.verbosity > 0)
        click.echo(text, nl=False)
    for row in ordered:
        if row.error is not None and (style != "text" or console.verbosity > 0):
            console.error(row.error)
    if any(row.error is not None for row in ordered):
        return 2
    return 1 if any(row.stands is False for row in ordered) else 0
