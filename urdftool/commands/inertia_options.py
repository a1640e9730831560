"""Options that mean the same for every body: its mass, its pose, the form of the result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])

FORMATS = ("urdf", "sdf", "mjcf", "xacro", "json", "table")


def amount_options(function: F) -> F:
    """``--mass`` and ``--density``."""
    function = click.option(
        "--density", type=float, metavar="D", help="Density [kg/m³], instead of the mass."
    )(function)
    return click.option("--mass", type=float, metavar="M", help="Mass [kg].")(function)


def result_options(function: F) -> F:
    """``--origin-xyz``, ``--origin-rpy``, ``--format`` and ``-o``."""
    for option in (
        click.option("-o", "--output", metavar="FILE", help="Write the result there."),
        click.option(
            "--format",
            "style",
            type=click.Choice(FORMATS),
            default="urdf",
            show_default=True,
            help="The form of the result.",
        ),
        click.option(
            "--origin-rpy",
            type=float,
            nargs=3,
            default=(0.0, 0.0, 0.0),
            metavar="R P Y",
            help="Turn it: roll, pitch, yaw of its frame in the link [rad].",
        ),
        click.option(
            "--origin-xyz",
            type=float,
            nargs=3,
            default=(0.0, 0.0, 0.0),
            metavar="X Y Z",
            help="Move it: where its frame is in the link [m].",
        ),
    ):
        function = option(function)
    return function


def check_amount(mass: float | None, density: float | None) -> None:
    """Refuse both of the two."""
    if mass is not None and density is not None:
        raise click.UsageError(
            "--mass and --density exclude each other; one follows from the other"
        )


def check_pose(xyz: tuple[float, ...], rpy: tuple[float, ...]) -> None:
    """Refuse a pose that is no pose."""
    from math import isfinite

    for option, values in (("--origin-xyz", xyz), ("--origin-rpy", rpy)):
        if not all(map(isfinite, values)):
            raise click.UsageError(f"{option} wants three finite numbers")
