"""The options of ``urdftool simulate`` that say how a robot is spawned."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .options import name_numbers

if TYPE_CHECKING:
    from ..simulation.settings import Settings

F = TypeVar("F", bound=Callable[..., Any])


def _finite(ctx: click.Context, parameter: click.Parameter, value: float | None) -> float | None:
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(f"'{value}' is not a finite number", ctx, parameter)
    return value


def _payloads(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, float]:
    found = name_numbers(ctx, parameter, values)
    if any(mass < 0 for mass in found.values()):
        raise click.BadParameter("a payload weighs zero or more", ctx, parameter)
    return found


_OPTIONS = (
    click.option(
        "--duration",
        type=click.FloatRange(0, 3600, min_open=True),
        default=5.0,
        show_default=True,
        metavar="S",
        help="Maximum simulated time [s].",
    ),
    click.option(
        "--timestep",
        type=click.FloatRange(1e-5, 0.05),
        default=0.002,
        show_default=True,
        metavar="S",
        help="Physics time step [s].",
    ),
    click.option(
        "--height",
        type=float,
        metavar="M",
        callback=_finite,
        help="Spawn height of the root above the plane [m].  [default: the lowest collision "
        "geometry is just above it]",
    ),
    click.option(
        "--hold",
        "hold",
        flag_value="all",
        default="all",
        help="Hold every joint within its effort limit, at zero or at its --pose (the default).",
    ),
    click.option(
        "--hold-actuated",
        "hold",
        flag_value="actuated",
        help="Hold only the joints that the file actuates.",
    ),
    click.option(
        "--limp",
        "hold",
        flag_value="none",
        help="Hold no joint.",
    ),
    click.option(
        "--pose",
        multiple=True,
        metavar="JOINT=VALUE",
        callback=name_numbers,
        help="Start and hold a joint at a position [rad or m]. Repeatable.",
    ),
    click.option("--fixed-base", is_flag=True, help="Fix the root link to the world."),
    click.option(
        "--payload",
        multiple=True,
        metavar="LINK=KG",
        callback=_payloads,
        help="Add a point mass [kg] to a link, at its center of mass. Repeatable.",
    ),
    click.option(
        "--slope",
        type=click.FloatRange(-60, 60),
        default=0.0,
        metavar="DEG",
        help="Slope of the plane, which falls along x [degrees].",
    ),
    click.option(
        "--friction",
        type=click.FloatRange(0),
        default=1.0,
        show_default=True,
        metavar="MU",
        help="Friction coefficient of links for which the file gives none.",
    ),
    click.option(
        "--self-collision",
        is_flag=True,
        help="Let links of the robot push each other, except the two of a joint.",
    ),
    click.option(
        "--trials",
        type=click.IntRange(1, 1000),
        default=1,
        show_default=True,
        metavar="N",
        help="Number of trials; all but the first start with a random tilt (up to 6°) and yaw.",
    ),
    click.option(
        "--seed", type=int, default=0, show_default=True, help="Seed of the random tilts and yaws."
    ),
    click.option("--sweep", is_flag=True, help="Also move each joint through its limits."),
    click.option(
        "--time-limit",
        type=click.FloatRange(0.1, 86400),
        default=60.0,
        show_default=True,
        metavar="S",
        help="Wall-clock limit for the engine [s].",
    ),
)


def settings_options(function: F) -> F:
    """All of them; :func:`settings_of` takes their values."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function


def settings_of(values: dict[str, Any]) -> Settings:
    """The settings that the options say."""
    from ..simulation.settings import Settings

    return Settings(
        duration=values["duration"],
        timestep=values["timestep"],
        height=values["height"],
        hold=values["hold"],
        pose=values["pose"],
        fixed_base=values["fixed_base"],
        payloads=values["payload"],
        friction=values["friction"],
        slope=math.radians(values["slope"]),
        self_collision=values["self_collision"],
        trials=values["trials"],
        seed=values["seed"],
        sweep=values["sweep"],
        time_limit=values["time_limit"],
    )
