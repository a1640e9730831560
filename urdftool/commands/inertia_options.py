"""Options for every kind of body: its mass, its pose and the output format."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])

FORMATS = ("urdf", "sdf", "mjcf", "xacro", "json", "table")


def add_amount_options(function: F) -> F:
    """Add ``--mass`` and ``--density``."""
    function = click.option(
        "--density", type=float, metavar="D", help="Density [kg/m³]; excludes --mass."
    )(function)
    return click.option("--mass", type=float, metavar="M", help="Mass [kg].")(function)


def add_result_options(function: F) -> F:
    """Add ``--origin-xyz``, ``--origin-rpy``, ``--format`` and ``-o``."""
    for option in (
        click.option(
            "-o", "--output", metavar="FILE", help="Output file.  [default: standard output]"
        ),
        click.option(
            "--format",
            "style",
            type=click.Choice(FORMATS),
            default="urdf",
            show_default=True,
            metavar="FORMAT",
            help=f"Output format: {', '.join(FORMATS)}.",
        ),
        click.option(
            "--origin-rpy",
            type=float,
            nargs=3,
            default=(0.0, 0.0, 0.0),
            metavar="R P Y",
            help="Roll, pitch and yaw of the body's frame in the link frame [rad].",
        ),
        click.option(
            "--origin-xyz",
            type=float,
            nargs=3,
            default=(0.0, 0.0, 0.0),
            metavar="X Y Z",
            help="Position of the body's frame in the link frame [m].",
        ),
    ):
        function = option(function)
    return function


def check_amount(mass: float | None, density: float | None) -> None:
    """Refuse a mass together with a density."""
    if mass is not None and density is not None:
        raise click.UsageError(
            "--mass and --density exclude each other, because the geometry relates them"
        )


def check_pose(xyz: tuple[float, ...], rpy: tuple[float, ...]) -> None:
    """Refuse numbers that are not finite."""
    from math import isfinite

    for option, values in (("--origin-xyz", xyz), ("--origin-rpy", rpy)):
        if not all(map(isfinite, values)):
            raise click.UsageError(f"{option} requires three finite numbers")
