"""``urdftool simulate``: spawn a robot on a plane in a physics engine and judge the result."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import add_gltf_option, add_package_options
from .simulate_engine_options import add_engine_options, add_robots_argument
from .simulate_options import add_simulation_options

_GROUPS = {
    "Simulation": "engine duration timestep trials seed sweep fleet",
    "Robot and ground": "fixed_base pose height payload self_collision friction slope",
    "Joint control": "hold controllers",
    "Output": "strict style plot picture video junit",
    "Performance": "time_limit jobs scheduler",
}


@click.command("simulate", cls=GroupedCommand, groups=_GROUPS)
@add_robots_argument
@add_simulation_options
@add_engine_options
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "json", "junit"]),
    default="text",
    show_default=True,
    metavar="FORMAT",
    help="Output format: text, json (with time series of a single robot), junit.",
)
@add_gltf_option
@add_package_options
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
    """Spawn the robot IN above a plane, let it settle, and report whether it stands.

    The report names the links and joints that cause a fall, tip-over, ground penetration,
    divergence, joint drift or lasting motion, with the probable cause and the lint rule.

    \b
        urdftool simulate mira.urdf
        urdftool simulate arm.urdf.xacro --limp
        urdftool simulate rover.urdf --trials 10 --seed 1 --slope 10

    Exit code 0: the robot stands. 1: it does not stand, or has another error. 2: it could not be
    simulated. With --fleet: 2 if a robot could not be simulated, else 1 if one has an error.
    Masses and inertia tensors that lint reports are warnings, and errors with --strict.
    """  # noqa: D301 -- click reads the escape
    from ..extras import require
    from ..parallel import terminate_gracefully
    from ..simulation.engine_process import EngineProcess
    from ..simulation.engines.registry import (
        check_engines,
        choose_default_engine,
        get_engine_names,
        get_library,
    )
    from ..simulation.mesh_cache import set_cache_folder
    from .cache_options import choose_cache_folder
    from .load_tolerant import load_tolerant
    from .simulate_control import apply_controllers, report_start, take_robot_of_scene
    from .simulate_fleet import Fleet, simulate_fleet
    from .simulate_one import print_old_thresholds, read_configured_thresholds, simulate_one
    from .simulate_options import make_settings
    from .simulate_outputs import Outputs, check_output

    engines = get_engine_names(values["engine"] or choose_default_engine())
    controllers, strict, junit = values["controllers"], values["strict"], values["junit"]
    outputs = Outputs(values["plot"], values["picture"], values["video"])
    outputs.check()
    if junit is not None:
        check_output("--junit", junit, "")
    check_engines(engines)
    require("'urdftool simulate'", "scipy", "manifold3d")
    settings = make_settings(values)
    cache = choose_cache_folder("simulate", values["cache_dir"], values["no_cache"])
    paths, arguments = robot
    if values["scheduler"] and not values["fleet"]:
        raise click.UsageError("--scheduler requires --fleet")
    if values["fleet"]:
        if outputs.is_requested:
            raise click.UsageError("--plot, --picture and --video do not support --fleet")
        fleet = Fleet(
            console, arguments, package, package_path, settings, engines, controllers, strict,
            frozenset(paths), cache,
        )  # fmt: skip
        with terminate_gracefully():
            return simulate_fleet(
                fleet,
                paths,
                style=style,
                junit=junit,
                jobs=values["jobs"],
                scheduler=values["scheduler"],
            )
    thresholds = read_configured_thresholds(console, paths[0])
    print_old_thresholds(console, paths)
    with (
        terminate_gracefully(),
        EngineProcess(get_library(engines[0])) as child,  # starts in parallel
    ):
        model = load_tolerant(console, paths[0], arguments, package, package_path)
        model = take_robot_of_scene(console, model)
        set_cache_folder(model, cache)
        settings = apply_controllers(console, settings, model, controllers, strict=strict)
        settings = report_start(console, model, settings)
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
            strict=strict,
        )
