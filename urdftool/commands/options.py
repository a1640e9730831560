"""Arguments and options that have the same meaning in every command."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console
from ..source.description_formats import SEVERAL_SUFFIXES
from .grouped_help import NAMED

if TYPE_CHECKING:
    from ..source.description import GltfUp

F = TypeVar("F", bound=Callable[..., Any])

ASSIGN = ":="

CHOSEN = "-r"
"""Key, among the xacro arguments, of the name of one of several robots in a file."""

"""Suffixes of files of several robots, one of which ``-r NAME`` after the file chooses."""


def make_decorator(options: Sequence[Callable[[Any], Any]]) -> Callable[[F], F]:
    """Make a decorator that adds options, in their order in the help."""

    def decorate(function: F) -> F:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


class FiniteRange(click.FloatRange):
    """A number in a range; NaN, which no bound excludes, and infinity are refused."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number, or stop with a message."""
        number: float = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"'{value}' is not a finite number", param, ctx)
        return number


def split_arguments(words: tuple[str, ...]) -> tuple[list[str], dict[str, str]]:
    """Separate paths from xacro arguments, which are written ``name:=value``.

    A robot by name becomes its path.

    Raises:
        UsageError: An argument has no name, or a missing file looks like ``name=value``.
        UrdftoolError: A robot by name is not found.
    """
    words = tuple(_find_robots(words))
    paths = [word for word in words if ASSIGN not in word]
    for word in paths:
        name, equals, value = word.partition("=")
        if equals and name.isidentifier() and not os.path.exists(word):
            raise click.UsageError(f"file '{word}' does not exist; did you mean {name}:={value}?")
    pairs = (word.partition(ASSIGN) for word in words if ASSIGN in word)
    arguments = {}
    for name, _, value in pairs:
        if not name.strip():
            raise click.UsageError(
                f"xacro argument '{name}{ASSIGN}{value}' has no name; write name:=value"
            )
        arguments[name.strip()] = value.strip()
    return paths, arguments


def split_robots(words: tuple[str, ...]) -> list[tuple[str, dict[str, str]]]:
    """Split words into robots: paths, each followed by its xacro arguments.

    A robot by name becomes its path.

    Raises:
        UsageError: An argument precedes the first path, or has another form.
        UrdftoolError: A robot by name is not found.
    """
    sides: list[list[str]] = []
    for word in _find_robots(words):
        if ASSIGN not in word:
            sides.append([word])
        elif sides:
            sides[-1].append(word)
        else:
            raise click.UsageError(f"xacro argument '{word}' must follow a file")
    return [(side[0], split_arguments(tuple(side))[1]) for side in sides]


def add_robot_argument(function: F) -> F:
    """Add ``IN [name:=value …]``, whose value is the path and the xacro arguments by name."""
    function = click.argument(
        "robot",
        nargs=-1,
        type=str,
        metavar="IN [name:=value ...]",
        callback=_parse_robot,
    )(function)
    return add_name_option(function)


def add_name_option(function: F) -> F:
    """Add ``-r NAME``, a robot in place of a path, or one of those in the file before it.

    It requires a :class:`GroupedCommand`.
    """
    return click.option(
        "-r",
        "named",
        metavar="NAME",
        expose_value=False,
        help="Robot of the Python package robot_descriptions or mujoco-menagerie, in place of a "
        "file; after an SDF or USD file, one of its models.",
    )(function)


def _find_robots(words: Iterable[str]) -> Iterator[str]:
    """Yield words with the path of each robot by name; or an argument after a file of several."""
    file = ""
    for word in words:
        if not word.startswith(NAMED):
            file = file if ASSIGN in word else word
            yield word
        elif file.endswith(SEVERAL_SUFFIXES) and os.path.isfile(file):
            yield f"{CHOSEN}{ASSIGN}{word.removeprefix(NAMED)}"
            file = ""
        else:
            file = ""
            yield _find_named(word)


def _find_named(word: str) -> str:
    if not word.startswith(NAMED):
        return word
    from ..source.named_robots import find_named_robot

    return find_named_robot(word.removeprefix(NAMED))


def _parse_robot(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> tuple[str, dict[str, str]]:
    return parse_robot(ctx, words)


def parse_robot(ctx: click.Context, words: tuple[str, ...]) -> tuple[str, dict[str, str]]:
    """Return the single path among words, and the xacro arguments by name.

    Raises:
        UsageError: There is no path, or more than one.
    """
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError(
            "missing argument IN: a robot (URDF, xacro, SDF, MJCF or USD), or '-' (standard input)",
            ctx,
        )
    if len(paths) > 1:
        raise click.UsageError(
            f"{len(paths)} files are given ({' '.join(paths)}), but the command reads one robot; "
            "write xacro arguments as name:=value",
            ctx,
        )
    return paths[0], arguments


def add_package_options(function: F) -> F:
    """Add ``-p``, a dictionary of folders by package name, and ``--package-path``, a tuple."""
    function = click.option(
        "--package-path",
        "package_path",
        multiple=True,
        metavar="DIR",
        help="Folder that is searched recursively for ROS packages. Repeatable.",
    )(function)
    return click.option(
        "-p",
        "--package",
        "package",
        multiple=True,
        metavar="NAME=DIR",
        callback=_parse_packages,
        help="Folder of the ROS package NAME. Repeatable.",
    )(function)


def _parse_packages(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, Path]:
    packages = {}
    for value in values:
        name, equals, folder = value.partition("=")
        if not (equals and name and folder):
            raise click.BadParameter(f"'{value}' is not NAME=DIR", ctx, parameter)
        if not Path(folder).is_dir():
            raise click.BadParameter(f"'{folder}' is not a folder", ctx, parameter)
        packages[name] = Path(folder)
    return packages


def add_jobs_option(function: F) -> F:
    """Add ``-j``, the number of worker processes; None for the default of the command."""
    return click.option(
        "-j",
        "--jobs",
        type=click.IntRange(1),
        metavar="N",
        help="Number of worker processes.  [default: at most one per core]",
    )(function)


def add_scheduler_option(function: F) -> F:
    """Add ``--scheduler``, the address of a Dask scheduler; None for processes of this computer."""
    return click.option(
        "--scheduler",
        metavar="ADDRESS",
        help="Dask scheduler that runs the computation, instead of -j.",
    )(function)


def add_gltf_option(function: F) -> F:
    """Add ``--gltf-up``, whose value is stored in the :class:`Console`."""
    return click.option(
        "--gltf-up",
        type=click.Choice(("y", "z")),
        expose_value=False,
        callback=_set_gltf_up,
        help="Up axis of glTF meshes: y as in the glTF standard and RViz, z as in Gazebo (axes are "
        "not converted).  [default: y]",
    )(function)


def _set_gltf_up(ctx: click.Context, parameter: click.Parameter, value: GltfUp | None) -> None:
    if value is not None:
        console = ctx.find_object(Console)
        assert console is not None
        console.gltf_up = value


def get_gltf_up(console: Console, file: str) -> GltfUp:
    """Return the up axis of a glTF file, from the command line or the configuration."""
    from ..configuration import find_configuration

    return console.gltf_up or find_configuration(file, console.config).gltf_up


def parse_scale(
    ctx: click.Context, parameter: click.Parameter, value: str
) -> tuple[float, float, float]:
    """Parse the value of ``--scale``: one factor, or three for x, y and z."""
    try:
        words = [float(word) for word in value.replace(",", " ").split()]
    except ValueError:
        words = []
    if len(words) not in (1, 3):
        raise click.BadParameter(f"'{value}' is not one number or three numbers", ctx, parameter)
    x, y, z = words * 3 if len(words) == 1 else words
    return x, y, z


def make_output_option(help_text: str) -> Callable[[F], F]:
    """Make the option ``-o FILE``; ``-`` is standard output."""
    return click.option("-o", "--output", metavar="FILE", help=help_text)


def make_format_option(*formats: str, help_text: str = "Output format.") -> Callable[[F], F]:
    """Make the option ``--format``, passed as ``style``; the first format is the default."""
    return click.option(
        "--format",
        "style",
        type=click.Choice(formats),
        default=formats[0],
        show_default=True,
        help=help_text,
    )


def parse_name_numbers(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, float]:
    """Parse ``NAME=NUMBER`` values of a repeatable option.

    Raises:
        BadParameter: A value has another form, or a number that is not finite.
    """
    numbers = {}
    for value in values:
        name, _, text = value.rpartition("=")
        try:
            numbers[name] = float(text)
        except ValueError:
            name = ""
        if not name or not math.isfinite(numbers[name]):
            raise click.BadParameter(f"'{value}' is not NAME=NUMBER", ctx, parameter)
    return numbers


def parse_pose(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> tuple[str, dict[str, float]]:
    """Parse the name of an SRDF group state, and joint positions by name."""
    names = [value for value in values if "=" not in value]
    if len(names) > 1:
        raise click.BadParameter(
            f"{' and '.join(names)}: only one group state is possible", ctx, parameter
        )
    positions = tuple(value for value in values if "=" in value)
    return "".join(names), parse_name_numbers(ctx, parameter, positions)
