"""``urdftool export``: the robot in the language of a simulator."""

from __future__ import annotations

from importlib import import_module

import click

from .general_options import accept_general_options

FORMATS = ("sdf", "mjcf")


class Formats(click.Group):
    """The formats, each imported when it is wanted."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Their names."""
        return list(FORMATS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """One of them; None for another name."""
        if cmd_name not in FORMATS:
            return None
        return accept_general_options(import_module(f".export_{cmd_name}", __package__).command)


@click.command("export", cls=Formats)
def command() -> None:
    """Turn a robot into what a simulator needs, and prove it is the same robot."""
