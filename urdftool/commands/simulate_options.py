"""Options of ``urdftool simulate`` for spawning the robot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

from .options import FiniteRange, make_decorator, parse_name_numbers

if TYPE_CHECKING:
    from ..simulation.settings import Settings


def _parse_finite(
    ctx: click.Context, parameter: click.Parameter, value: float | None
) -> float | None:
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(f"'{value}' is not a finite number", ctx, parameter)
    return value


def _parse_payloads(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, float]:
    masses = parse_name_numbers(ctx, parameter, values)
    if any(mass < 0 for mass in masses.values()):
        raise click.BadParameter("a payload mass must not be negative", ctx, parameter)
    return masses


_OPTIONS = (
    click.option(
        "--duration",
        type=FiniteRange(0, 3600, min_open=True),
        default=5.0,
        show_default=True,
        metavar="S",
        help="Maximum simulated time [s].",
    ),
    click.option(
        "--timestep",
        type=FiniteRange(1e-5, 0.05),
        default=0.002,
        show_default=True,
        metavar="S",
        help="Physics time step [s].",
    ),
    click.option(
        "--height",
        type=float,
        metavar="M",
        callback=_parse_finite,
        help="Spawn height of the root link [m].  [default: just above contact]",
    ),
    click.option(
        "--hold",
        "hold",
        flag_value="all",
        default="all",
        help="Hold all joints at --pose or zero within effort limits (default).",
    ),
    click.option(
        "--hold-actuated",
        "hold",
        flag_value="actuated",
        help="Hold only the joints that have an actuator in the file.",
    ),
    click.option(
        "--limp",
        "hold",
        flag_value="none",
        help="Leave all joints unactuated.",
    ),
    click.option(
        "--pose",
        multiple=True,
        metavar="JOINT=VALUE",
        callback=parse_name_numbers,
        help="Initial and held position of a joint [rad or m]. Repeatable.",
    ),
    click.option("--fixed-base", is_flag=True, help="Fix the root link to the world."),
    click.option(
        "--payload",
        multiple=True,
        metavar="LINK=KG",
        callback=_parse_payloads,
        help="Point mass at the center of mass of a link [kg]. Repeatable.",
    ),
    click.option(
        "--slope",
        type=FiniteRange(-60, 60),
        default=0.0,
        metavar="DEG",
        help="Slope of the plane, downward along +x [degrees].",
    ),
    click.option(
        "--friction",
        type=FiniteRange(0),
        default=1.0,
        show_default=True,
        metavar="MU",
        help="Friction coefficient where the file has none.",
    ),
    click.option(
        "--self-collision",
        is_flag=True,
        help="Enable contacts between links, except parent and child of a joint.",
    ),
    click.option(
        "--trials",
        type=click.IntRange(1, 1000),
        default=1,
        show_default=True,
        metavar="N",
        help="Number of trials, randomly tilted and turned.",
    ),
    click.option(
        "--seed",
        type=int,
        default=0,
        show_default=True,
        metavar="N",
        help="Seed of random tilts (up to 6°) and yaws after trial 1.",
    ),
    click.option("--sweep", is_flag=True, help="Also move each joint from limit to limit."),
    click.option(
        "--time-limit",
        type=FiniteRange(0.1, 86400),
        default=60.0,
        show_default=True,
        metavar="S",
        help="Limit of the engine's processor time [s].",
    ),
)

add_simulation_options = make_decorator(_OPTIONS)
"""Add the options; :func:`make_settings` makes settings of their values."""


def make_settings(values: dict[str, Any]) -> Settings:
    """Make the settings from the values of the options, by parameter name."""
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
