"""Options that mean the same in every export."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from ..formats.common.inertia_repair import REPAIRS

F = TypeVar("F", bound=Callable[..., Any])


def export_options(*, mesh_dir: str, verify: str) -> Callable[[F], F]:
    """Where meshes go, what may be replaced, how strict it is, and the form of the result.

    Args:
        mesh_dir: The folder of the meshes, if none is named.
        verify: What ``--verify`` does, in a sentence.
    """
    options = [
        click.option(
            "--mesh-dir",
            metavar="DIR",
            default=mesh_dir,
            show_default=True,
            callback=_beside,
            help="Folder of the meshes, beside the model.",
        ),
        click.option("--overwrite", is_flag=True, help="Replace also what urdftool did not write."),
        click.option("--strict", is_flag=True, help="What cannot be carried is an error."),
        click.option("--force", is_flag=True, help="Go on past errors where a robot is left."),
        click.option("--verify", "verified", is_flag=True, help=verify),
        click.option(
            "--format",
            "style",
            type=click.Choice(("text", "json")),
            default="text",
            help="How the result is shown.",
        ),
    ]

    def decorate(function: F) -> F:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


def fix_inertia_option(function: F) -> F:
    """``--fix-inertia``: what becomes of a tensor that no rigid body has."""
    return click.option(
        "--fix-inertia",
        type=click.Choice(REPAIRS),
        default="none",
        help="What to do with a tensor that no rigid body has; none: refuse it.",
    )(function)


def _beside(ctx: click.Context, parameter: click.Parameter, value: str) -> str:
    """A folder beside the model, with single slashes."""
    folder = Path(value)
    if folder.is_absolute() or ".." in folder.parts:
        raise click.UsageError(
            f"--mesh-dir is a folder beside the model, such as {parameter.default}", ctx
        )
    return folder.as_posix()
