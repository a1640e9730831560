"""Arguments that mean the same in every command."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console

if TYPE_CHECKING:
    from ..source.description import GltfUp

F = TypeVar("F", bound=Callable[..., Any])

ASSIGN = ":="


def split_arguments(words: tuple[str, ...]) -> tuple[list[str], dict[str, str]]:
    """Paths, and xacro arguments written ``name:=value``."""
    paths = [word for word in words if ASSIGN not in word]
    for word in paths:
        name, equals, value = word.partition("=")
        if equals and name.isidentifier() and not os.path.exists(word):
            raise click.UsageError(f"no file is called '{word}'; did you mean {name}:={value}?")
    pairs = (word.partition(ASSIGN) for word in words if ASSIGN in word)
    arguments = {}
    for name, _, value in pairs:
        if not name.strip():
            raise click.UsageError(f"'{name}{ASSIGN}{value}' has no name; write name:=value")
        arguments[name.strip()] = value.strip()
    return paths, arguments


def robot_argument(function: F) -> F:
    """``IN [name:=value …]``: the path and the xacro arguments, as a pair in ``robot``."""
    return click.argument(
        "robot",
        nargs=-1,
        type=str,
        metavar="IN [name:=value ...]",
        callback=_robot,
    )(function)


def _robot(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> tuple[str, dict[str, str]]:
    return one_robot(ctx, words)


def one_robot(ctx: click.Context, words: tuple[str, ...]) -> tuple[str, dict[str, str]]:
    """The one path among words, and the xacro arguments.

    Raises:
        UsageError: There is none, or more than one.
    """
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError("a robot is wanted: a .urdf or .xacro file, or '-'", ctx)
    if len(paths) > 1:
        raise click.UsageError(
            f"one robot is wanted, not {len(paths)} ({' '.join(paths)}); "
            "xacro arguments are written name:=value",
            ctx,
        )
    return paths[0], arguments


def package_options(function: F) -> F:
    """Where packages are: ``package`` as a dict by name, ``package_path`` as a list."""
    function = click.option(
        "--package-path",
        "package_path",
        multiple=True,
        metavar="DIR",
        help="A folder with ROS packages in it or below. Repeatable.",
    )(function)
    return click.option(
        "-p",
        "--package",
        "package",
        multiple=True,
        metavar="NAME=DIR",
        callback=_packages,
        help="Where a ROS package is. Repeatable.",
    )(function)


def _packages(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, Path]:
    found = {}
    for value in values:
        name, equals, folder = value.partition("=")
        if not (equals and name and folder):
            raise click.BadParameter(f"'{value}' is not NAME=DIR", ctx, parameter)
        if not Path(folder).is_dir():
            raise click.BadParameter(f"'{folder}' is no folder", ctx, parameter)
        found[name] = Path(folder)
    return found


def gltf_option(function: F) -> F:
    """Which axis is up in glTF meshes: kept in the console, which what reads a robot is given."""
    return click.option(
        "--gltf-up",
        type=click.Choice(("y", "z")),
        expose_value=False,
        callback=_gltf_up,
        help="The axis that is up in glTF meshes: y by their standard, which RViz turns to Z; z "
        "keeps the axes of the file, as Gazebo does.  [default: y]",
    )(function)


def _gltf_up(ctx: click.Context, parameter: click.Parameter, value: GltfUp | None) -> None:
    if value is not None:
        console = ctx.find_object(Console)
        assert console is not None
        console.gltf_up = value


def gltf_up_for(console: Console, file: str) -> GltfUp:
    """The axis that is up in a glTF file: as the line says, or else the configuration."""
    from ..configuration import find_configuration

    return console.gltf_up or find_configuration(file, console.config).gltf_up


def scale_factors(
    ctx: click.Context, parameter: click.Parameter, value: str
) -> tuple[float, float, float]:
    """The factors of ``--scale``: three, or one for all."""
    try:
        words = [float(word) for word in value.replace(",", " ").split()]
    except ValueError:
        words = []
    if len(words) not in (1, 3):
        raise click.BadParameter(f"'{value}' is neither one factor nor three", ctx, parameter)
    x, y, z = words * 3 if len(words) == 1 else words
    return x, y, z


def output_option(help_text: str) -> Callable[[F], F]:
    """``-o FILE``; ``-`` is standard output."""
    return click.option("-o", "--output", metavar="FILE", help=help_text)


def name_numbers(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, float]:
    """Read values of the form ``NAME=NUMBER`` of an option that is repeatable."""
    found = {}
    for value in values:
        name, _, text = value.rpartition("=")
        try:
            found[name] = float(text)
        except ValueError:
            name = ""
        if not name or not math.isfinite(found[name]):
            raise click.BadParameter(f"'{value}' is not NAME=NUMBER", ctx, parameter)
    return found
