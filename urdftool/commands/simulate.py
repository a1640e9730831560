"""``urdftool simulate``: does it stand?"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from .options import package_options, robot_argument
from .simulate_more import more_options
from .simulate_options import settings_options


@click.command("simulate")
@robot_argument
@settings_options
@more_options
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "json"]),
    default="text",
    help="How the verdict is shown; json has the time series, too.",
)
@package_options
@click.pass_obj
def command(
    console: Console,
    /,
    robot: tuple[str, dict[str, str]],
    style: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
    **values: Any,
) -> int:
    """Spawn IN above a plane, let it settle, and say whether it stands.

    Headless, in a second or two. Where it falls, tips over, sinks in, blows up, sags or never comes
    to rest, the links and joints are named, with the probable cause and the lint rule that tells
    more.

    \b
        urdftool simulate mira.urdf
        urdftool simulate arm.urdf.xacro --limp
        urdftool simulate rover.urdf --trials 10 --seed 1 --slope 10

    Exit 0 if it stands, 1 if it does not, 2 if it could not be tried.
    """  # noqa: D301 -- click reads the escape
    from ..simulation.engines import ENGINES, check_engines
    from .read_lax import read_lax
    from .simulate_control import controlled
    from .simulate_one import simulate_one
    from .simulate_options import settings_of
    from .simulate_outputs import Outputs

    engines = ENGINES[values["engine"]]
    outputs = Outputs(values["plot"], values["picture"], values["video"])
    outputs.check()
    check_engines(engines)
    settings = settings_of(values)
    path, arguments = robot
    model = read_lax(console, path, arguments, package, package_path)
    settings = controlled(console, settings, model, values["controllers"])
    return simulate_one(console, model, settings, engines, style=style, outputs=outputs)
