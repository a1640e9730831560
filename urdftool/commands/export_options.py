"""Options that have the same meaning in every export."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from ..formats.common.inertia_repair import REPAIRS
from .options import make_format_option

F = TypeVar("F", bound=Callable[..., Any])


def make_export_options(*, mesh_dir: str, verify: str) -> Callable[[F], F]:
    """Make a decorator that adds the options of meshes, strictness, verification and output.

    Args:
        mesh_dir: Default of ``--mesh-dir``; empty for a format without mesh files.
        verify: Help text of ``--verify``.
    """
    folder = [
        click.option(
            "--mesh-dir",
            metavar="DIR",
            default=mesh_dir,
            show_default=True,
            callback=_parse_mesh_folder,
            help="Folder of the mesh files, relative to the model.",
        ),
    ]
    options = [
        *(folder if mesh_dir else ()),
        click.option("--overwrite", is_flag=True, help="Overwrite files not written by urdftool."),
        click.option(
            "--strict",
            is_flag=True,
            help="Treat information that the format cannot hold as an error.",
        ),
        click.option(
            "--force", is_flag=True, help="Export despite errors, if a usable robot remains."
        ),
        click.option("--verify", "verified", is_flag=True, help=verify),
        make_format_option("text", "json", help_text="Output format of the report."),
    ]

    def decorate(function: F) -> F:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


def add_fix_inertia_option(function: F) -> F:
    """Add ``--fix-inertia``, the repair of physically inconsistent inertia tensors."""
    return click.option(
        "--fix-inertia",
        type=click.Choice(REPAIRS),
        default="none",
        metavar="REPAIR",
        show_default=True,
        help="Repair of physically inconsistent inertia: lift, balance, box, or none (refuse it).",
    )(function)


def _parse_mesh_folder(ctx: click.Context, parameter: click.Parameter, value: str) -> str:
    """Return a folder relative to the model, with single slashes.

    Raises:
        UsageError: The folder is absolute, or outside of the model's folder.
    """
    folder = Path(value)
    if folder.is_absolute() or ".." in folder.parts:
        raise click.UsageError(
            f"--mesh-dir must be a folder relative to the model, such as {parameter.default}", ctx
        )
    return folder.as_posix()
