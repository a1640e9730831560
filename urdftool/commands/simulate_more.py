"""The options of ``urdftool simulate`` that say what simulates, what drives, and what is drawn."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from ..simulation.engines.registry import BOTH, REGISTRY
from .cache_options import CACHE_OPTIONS
from .options import one_robot, split_arguments

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--engine",
        type=click.Choice([*REGISTRY, BOTH]),
        help="What simulates; mujoco runs our own MJCF export, both compares the two.  [default: "
        "pybullet; mujoco where PyBullet has no wheels: from Python 3.12 on, and on ARM]",
    ),
    click.option(
        "--controllers",
        metavar="FILE.yaml",
        help="Drive the joints as the controllers of this ros_control or ros2_control file do, "
        "told to hold the pose.",
    ),
    click.option(
        "--strict",
        is_flag=True,
        help="Refuse --controllers of an unknown type. Without it their joints are not actuated.",
    ),
    click.option(
        "--plot",
        metavar="FILE.png",
        help="Draw height, tilt, kinetic energy, joints and their efforts over time.",
    ),
    click.option("--picture", metavar="FILE.png", help="Draw the robot where it came to rest."),
    click.option("--video", metavar="FILE.gif", help="Draw it on its way there."),
    click.option(
        "--fleet",
        is_flag=True,
        is_eager=True,
        help="Simulate many: every IN, and each .urdf and .urdf.xacro below an IN that is a "
        "folder; one line each.",
    ),
    click.option(
        "--junit", metavar="FILE", help="Write JUnit XML there, too, with a case for each robot."
    ),
    click.option(
        "-j",
        "--jobs",
        type=click.IntRange(1),
        metavar="N",
        help="Robots of a --fleet at once.  [default: one for each core]",
    ),
    *CACHE_OPTIONS,
)


def robots_argument(function: F) -> F:
    """``IN [name:=value …]``: a path, or with ``--fleet`` several, and the xacro arguments."""
    return click.argument(
        "robot", nargs=-1, type=str, metavar="IN [name:=value ...]", callback=_robots
    )(function)


def _robots(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> tuple[list[str], dict[str, str]]:
    paths, arguments = split_arguments(words)
    if not ctx.params.get("fleet"):
        path, arguments = one_robot(ctx, words)
        return [path], arguments
    if not paths:
        raise click.UsageError("robots are wanted: files, or folders that have some", ctx)
    if "-" in paths:
        raise click.UsageError("a fleet is not read from standard input", ctx)
    return paths, arguments


def more_options(function: F) -> F:
    """All of them."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function
