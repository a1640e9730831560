"""``urdftool edit``: operations on robots, each with its proof."""

from __future__ import annotations

from importlib import import_module

import click

from .general_options import accept_general_options
from .grouped_help import CommandGroup

OPERATIONS = (
    *("attach", "prefix", "merge-fixed", "root", "mirror", "zero", "sign", "cut", "round"),
)


class Operations(CommandGroup):
    """Group with a command for each operation, imported on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return their names."""
        return list(OPERATIONS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of an operation; None for another name."""
        if cmd_name not in OPERATIONS:
            return None
        module = import_module(".edit_operations", __package__)
        return accept_general_options(getattr(module, cmd_name.replace("-", "_")))


@click.command("edit", cls=Operations)
def command() -> None:
    """Attach, prefix, merge, re-root, mirror, re-zero or cut a robot, and prove the result.

    Each operation writes a URDF, the SRDF and YAML files around it, and a file OUT.map that
    declares what changed. The result is compared with the robot before, as by urdftool verify
    --map; if a property differs from what is declared, no file is written.
    """
