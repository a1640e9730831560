"""``urdftool simulate``: does it stand?"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from .options import gltf_option, package_options
from .simulate_more import more_options, robots_argument
from .simulate_options import settings_options


@click.command("simulate")
@robots_argument
@settings_options
@more_options
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "json", "junit"]),
    default="text",
    help="How the verdict is shown; json has the time series of one robot, too.",
)
@gltf_option
@package_options
@click.pass_obj
def command(
    console: Console,
    /,
    robot: tuple[list[str], dict[str, str]],
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

    Exit 0 if it stands, 1 if it does not, 2 if it could not be tried; of a --fleet 2 if one could
    not be tried, else 1 if one does not stand.
    """  # noqa: D301 -- click reads the escape
    from ..extras import require
    from ..parallel import terminate_gracefully
    from ..simulation.engine_process import EngineProcess
    from ..simulation.engines.registry import (
        check_engines,
        default_engine,
        engine_names,
        library_of,
    )
    from ..simulation.hull_cache import using_cache
    from .cache_options import cache_place
    from .read_lax import read_lax
    from .simulate_control import controlled
    from .simulate_fleet import Fleet, simulate_fleet
    from .simulate_one import configured_thresholds, simulate_one
    from .simulate_options import settings_of
    from .simulate_outputs import Outputs, check_output

    engines = engine_names(values["engine"] or default_engine())
    controllers, strict, junit = values["controllers"], values["strict"], values["junit"]
    outputs = Outputs(values["plot"], values["picture"], values["video"])
    outputs.check()
    if junit is not None:
        check_output("--junit", junit, "")
    check_engines(engines)
    require("'urdftool simulate'", "scipy", "manifold3d")
    settings = settings_of(values)
    cache = cache_place("simulate", values["cache_dir"], values["no_cache"])
    paths, arguments = robot
    if values["fleet"]:
        if outputs.wanted:
            raise click.UsageError("--plot, --picture and --video are of one robot, not a --fleet")
        fleet = Fleet(
            console, arguments, package, package_path, settings, engines, controllers, strict,
            frozenset(paths), cache,
        )  # fmt: skip
        with terminate_gracefully():
            return simulate_fleet(fleet, paths, style=style, junit=junit, jobs=values["jobs"])
    thresholds = configured_thresholds(console, paths[0])
    with (
        terminate_gracefully(),
        using_cache(cache),
        EngineProcess(library_of(engines[0])) as child,  # which starts meanwhile
    ):
        model = read_lax(console, paths[0], arguments, package, package_path)
        settings = controlled(console, settings, model, controllers, strict=strict)
        return simulate_one(
            console,
            model,
            settings,
            engines,
            thresholds,
            child,
            style=style,
            outputs=outputs,
            junit=junit,
        )
