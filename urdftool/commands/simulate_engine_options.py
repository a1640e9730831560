"""Options of ``urdftool simulate`` for the engine, controllers, pictures and fleets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from ..simulation.engines.registry import BOTH, REGISTRY
from .cache_options import CACHE_OPTIONS
from .options import add_name_option, make_decorator, parse_robot, split_arguments

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--engine",
        type=click.Choice([*REGISTRY, BOTH]),
        metavar="ENGINE",
        help="Physics engine: pybullet, mujoco or both.  [default: first installed]",
    ),
    click.option(
        "--controllers",
        metavar="FILE.yaml",
        help="ros_control or ros2_control file, whose controllers hold the joints.",
    ),
    click.option(
        "--strict",
        is_flag=True,
        help="Warnings fail the run, and controllers of unknown type are refused.",
    ),
    click.option(
        "--plot",
        metavar="FILE.png",
        help="Write a plot of height, tilt, kinetic energy, joints and efforts.",
    ),
    click.option("--picture", metavar="FILE.png", help="Write a picture of the final state."),
    click.option("--video", metavar="FILE.gif", help="Write an animation of the simulation."),
    click.option(
        "--fleet",
        is_flag=True,
        is_eager=True,
        help="Simulate several robots (files or folders), one line of output each.",
    ),
    click.option(
        "--junit", metavar="FILE", help="Also write JUnit XML with one test case per robot."
    ),
    click.option(
        "-j",
        "--jobs",
        type=click.IntRange(1),
        metavar="N",
        help="With --fleet: number of worker processes.  [default: one per core]",
    ),
    click.option(
        "--scheduler",
        metavar="ADDRESS",
        help="With --fleet: Dask scheduler that runs the computation, instead of -j.",
    ),
    *CACHE_OPTIONS,
)


def add_robots_argument(function: F) -> F:
    """Add ``IN [name:=value …]``: one path, or with ``--fleet`` several, and xacro arguments."""
    function = click.argument(
        "robot", nargs=-1, type=str, metavar="IN [name:=value ...]", callback=_parse_robots
    )(function)
    return add_name_option(function)


def _parse_robots(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> tuple[list[str], dict[str, str]]:
    if not ctx.params.get("fleet"):
        path, arguments = parse_robot(ctx, words)
        return [path], arguments
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError("missing argument IN: files or folders for --fleet", ctx)
    if "-" in paths:
        raise click.UsageError("--fleet does not read standard input ('-')", ctx)
    return paths, arguments


add_engine_options = make_decorator(_OPTIONS)
