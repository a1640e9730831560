"""``urdftool export``: convert a robot to the format of a simulator."""

from __future__ import annotations

import os
from collections.abc import Sequence
from importlib import import_module

import click

from ..formats.registry import FORMATS
from ..suggestions import suggest_name
from .general_options import accept_general_options
from .grouped_help import CommandGroup


class Formats(CommandGroup):
    """Group with a command for each output format, imported on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return their names."""
        return [target.name for target in FORMATS]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of a format; None for another name."""
        if cmd_name not in self.list_commands(ctx):
            return None
        return accept_general_options(import_module(f".export_{cmd_name}", __package__).command)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Resolve the format as click does; list the formats for another word."""
        names = self.list_commands(ctx)
        if args and args[0] not in names and not args[0].startswith("-"):
            ctx.fail(_explain_no_format(args[0], names))
        return super().resolve_command(ctx, args)


def _explain_no_format(word: str, names: Sequence[str]) -> str:
    """Return what to write instead of a word that is not a format."""
    choice = f"{', '.join(names[:-1])} or {names[-1]}"
    if os.path.exists(word) or "." in word:
        return f"missing format ({choice}) before '{word}'; write export sdf {word} -o OUT"
    hint = suggest_name(word, names, 0.6) or f"; choose {choice}"
    return f"export format '{word}' does not exist{hint}"


@click.command("export", cls=Formats)
def command() -> None:
    """Convert a robot to the format of a simulator."""
