"""``urdftool export``: convert a robot to the format of a simulator."""

from __future__ import annotations

from importlib import import_module

import click

from ..formats.registry import get_writable_formats
from .general_options import accept_general_options


class Formats(click.Group):
    """Group with a command for each output format, imported on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return their names."""
        return [target.name for target in get_writable_formats()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of a format; None for another name."""
        if cmd_name not in self.list_commands(ctx):
            return None
        return accept_general_options(import_module(f".export_{cmd_name}", __package__).command)


@click.command("export", cls=Formats)
def command() -> None:
    """Convert a robot to the format of a simulator."""
