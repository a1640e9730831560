"""``urdftool inertia macros``: write inertia as xacro macros."""

from __future__ import annotations

import click

from .grouped_help import GroupedCommand
from .options import make_output_option


@click.command("macros", cls=GroupedCommand, groups={"Output": "output"})
@make_output_option("Output file.  [default: standard output]")
def command(output: str | None) -> int:
    """Write a xacro file with an inertia macro for each shape, solid and hollow.

    \b
        urdftool inertia macros -o inertia.xacro
        <xacro:include filename="inertia.xacro"/>
        <xacro:cylinder_inertia mass="0.18" radius="0.06" length="0.09"/>
    """  # noqa: D301 -- \b is a character that click looks for
    from ..inertia.macros import get_macro_file
    from ..output import write_result

    write_result(get_macro_file(), output)
    return 0
