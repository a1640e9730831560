"""General options, which are accepted before and after the name of a command."""

from __future__ import annotations

from typing import Any

import click

from ..console import Console


def accept_general_options(command: click.Command) -> click.Command:
    """Add the general options to a command; its help does not list them."""
    known = {name for parameter in command.params for name in parameter.opts}
    if "--debug" not in known:
        command.params.extend(make_general_options(hidden=True))
    return command


def make_general_options(*, hidden: bool) -> list[click.Option]:
    """Make the options; each one changes the :class:`Console` of the context when parsed."""

    def option(*names: str, **more: Any) -> click.Option:
        return click.Option(names, expose_value=False, hidden=hidden, **more)

    return [
        option(
            *("-q", "--quiet"),
            is_flag=True,
            callback=_set_quiet,
            help="Do not print progress, summaries and warnings.",
        ),
        option(
            *("-v", "--verbose"),
            count=True,
            callback=_set_verbose,
            help="Print more details. Repeatable.",
        ),
        option(
            "--debug", is_flag=True, callback=_set_debug, help="Print the traceback of an error."
        ),
        option(
            "--trust",
            is_flag=True,
            callback=_set_trust,
            help="Trust the input: allow xacro to read the environment and all files.",
        ),
    ]


def _set_quiet(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        ctx.ensure_object(Console).verbosity = -1


def _set_verbose(ctx: click.Context, parameter: click.Parameter, value: int) -> None:
    console = ctx.ensure_object(Console)
    if value and not console.quiet:
        console.verbosity += value


def _set_debug(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        ctx.ensure_object(Console).debug = True


def _set_trust(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        from ..projects import disable_sandbox

        disable_sandbox()
