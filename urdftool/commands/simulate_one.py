"""One robot simulated, judged and told of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..console import Console
from .simulate_options import Progress

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..simulation.settings import Settings
    from .simulate_outputs import Outputs


def simulate_one(
    console: Console,
    robot: Robot,
    settings: Settings,
    engines: tuple[str, ...],
    *,
    style: str,
    outputs: Outputs,
) -> int:
    """Simulate a robot in one engine or two, and say how it went; the exit code.

    Args:
        console: Where it is said.
        robot: The robot.
        settings: How it is spawned.
        engines: Modules of ``simulation``; two are compared.
        style: ``text`` or ``json``.
        outputs: What is drawn of the first trial.

    Raises:
        UrdftoolError: It cannot be simulated.
    """
    from ..report import simulate as report
    from ..simulation.run import simulate
    from ..simulation.verdict import judge

    outputs.read(console, robot)
    runs = []
    for engine in engines:
        with Progress(console) as progress:
            runs.append(simulate(robot, settings, engine=engine, progress=progress))
    verdicts = [[judge(robot, run) for run in some] for some in runs]
    stands = all(verdict.stands for some in verdicts for verdict in some)
    if style == "json":
        everything = [verdict for some in verdicts for verdict in some]
        click.echo(report.to_json(robot, everything), nl=False)
    else:
        for some in verdicts:
            click.echo(report.text(robot, some, colors=console.colors()), nl=False)
    outputs.write(console, robot, [some[0] for some in runs])
    return 0 if stands else 1
