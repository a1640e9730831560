"""The options of ``urdftool simulate`` that say what simulates, what drives, and what is drawn."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--engine",
        type=click.Choice(["pybullet", "mujoco", "both"]),
        default="pybullet",
        show_default=True,
        help="What simulates; mujoco runs our own MJCF export, both compares the two.",
    ),
    click.option(
        "--controllers",
        metavar="FILE.yaml",
        help="Drive the joints as the controllers of this ros_control or ros2_control file do, "
        "told to hold the pose.",
    ),
    click.option(
        "--plot",
        metavar="FILE.png",
        help="Draw height, tilt, kinetic energy, joints and their efforts over time.",
    ),
    click.option("--picture", metavar="FILE.png", help="Draw the robot where it came to rest."),
    click.option("--video", metavar="FILE.gif", help="Draw it on its way there."),
)


def more_options(function: F) -> F:
    """All of them."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function
