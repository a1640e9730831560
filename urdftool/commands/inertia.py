"""``urdftool inertia``: how heavy a body is and how it resists turning."""

from __future__ import annotations

from importlib import import_module

import click

from ..console import Console
from ..inertia.shapes import SHAPES, find_shape
from .general_options import accept_general_options

OTHERS = ("mesh", "robot", "macros")


class Kinds(click.Group):
    """What has an inertia, each command made when it is wanted."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Their names: the shapes, then the rest."""
        return [*(shape.name for shape in SHAPES), *OTHERS]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """One of them; None for another name."""
        if cmd_name in OTHERS:
            module = import_module(f".inertia_{cmd_name}", __package__)
            return accept_general_options(module.command)
        shape = find_shape(cmd_name)
        if shape is None:
            return None
        from .inertia_shape import shape_command

        return accept_general_options(shape_command(shape))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """As click does it, with the nearest name for a mistyped one."""
        names = self.list_commands(ctx)
        if args and args[0] not in names and not args[0].startswith("-"):
            from ..suggestions import did_you_mean

            hint = did_you_mean(args[0], names, 0.6) or f"; there are {', '.join(names)}"
            if args[0].lower().endswith((".urdf", ".xacro")):
                hint = f"; for a robot write 'urdftool inertia robot {args[0]}'"
            ctx.fail(f"'{args[0]}' is no shape{hint}")
        return super().resolve_command(ctx, args)


@click.command("inertia", cls=Kinds, invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> int:
    """Mass properties of a shape, a mesh or a whole robot.

    Without anything at a terminal it asks: for the shape, its mass and its sizes.

    \b
        urdftool inertia cylinder --mass 0.18 --radius 0.06 --length 0.09
        urdftool inertia mesh link3.dae --density 2700
        urdftool inertia robot arm.urdf.xacro
        urdftool inertia robot arm.urdf --write --total-mass 18.4
    """  # noqa: D301 -- \b is a character that click looks for
    if ctx.invoked_subcommand is not None:
        return 0
    from .inertia_ask import at_terminal, choose_shape
    from .inertia_shape import shape_command

    if not at_terminal():
        raise click.UsageError(
            "say of what: " + ", ".join((ctx.command).list_commands(ctx))  # type: ignore[attr-defined]
        )
    console: Console = ctx.obj
    with shape_command(choose_shape()).make_context(None, [], parent=ctx, obj=console) as inner:
        result: int = inner.command.invoke(inner)
    return result
