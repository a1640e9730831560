"""``urdftool inertia``: mass properties of shapes, meshes and robots."""

from __future__ import annotations

from importlib import import_module

import click

from ..console import Console
from ..inertia.shapes import SHAPES, find_shape
from .general_options import accept_general_options
from .grouped_help import CommandGroup

OTHERS = ("mesh", "robot", "macros")


class Kinds(CommandGroup):
    """Group with a command for each shape, each made on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the command names: the shapes, then the others."""
        return [*(shape.name for shape in SHAPES), *OTHERS]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command; None for an unknown name."""
        if cmd_name in OTHERS:
            module = import_module(f".inertia_{cmd_name}", __package__)
            return accept_general_options(module.command)
        shape = find_shape(cmd_name)
        if shape is None:
            return None
        from .inertia_shape import make_shape_command

        return accept_general_options(make_shape_command(shape))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Resolve the command as click does; suggest the nearest name for an unknown one."""
        names = self.list_commands(ctx)
        if args and args[0] not in names and not args[0].startswith("-"):
            from ..suggestions import suggest_name

            hint = suggest_name(args[0], names, 0.6) or f"; choose one of {', '.join(names)}"
            if args[0].lower().endswith((".urdf", ".xacro")):
                hint = f"; for a robot use 'urdftool inertia robot {args[0]}'"
            ctx.fail(f"'{args[0]}' is not a shape{hint}")
        return super().resolve_command(ctx, args)


@click.command("inertia", cls=Kinds, invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> int:
    """Compute the mass properties of a shape, a mesh or a whole robot.

    At a terminal, without a subcommand, it asks for the shape, its mass and its dimensions.

    \b
        urdftool inertia cylinder --mass 0.18 --radius 0.06 --length 0.09
        urdftool inertia mesh link3.dae --density 2700
        urdftool inertia robot arm.urdf.xacro
        urdftool inertia robot arm.urdf --write --total-mass 18.4
    """  # noqa: D301 -- \b is a character that click looks for
    if ctx.invoked_subcommand is not None:
        return 0
    from .inertia_ask import choose_shape, is_at_terminal
    from .inertia_shape import make_shape_command

    if not is_at_terminal():
        raise click.UsageError(
            "missing subcommand: " + ", ".join((ctx.command).list_commands(ctx))  # type: ignore[attr-defined]
        )
    console: Console = ctx.obj
    with make_shape_command(choose_shape()).make_context(
        None, [], parent=ctx, obj=console
    ) as inner:
        result: int = inner.command.invoke(inner)
    return result
