"""Options of exports on the command line: those that a format declares, and those of all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import Field
from pathlib import Path
from typing import Any, TypeVar

import click

from ..errors import ConfigError
from ..formats.common.option import Option, get_default, list_options
from .options import FiniteRange, make_decorator, make_format_option

F = TypeVar("F", bound=Callable[..., Any])


def add_declared_options(options: type, **changes: Mapping[str, Any]) -> Callable[[F], F]:
    """Make a decorator that adds the options that a format declares.

    Args:
        options: Dataclass with the options of its writer.
        changes: Settings of ``click.option``, by the name of the option, where the command line
            differs from Python.
    """
    added = [
        click.option(
            f"--{option.flag or one.name.replace('_', '-')}{_make_negation(one, option)}",
            one.name,
            **{**_make_settings(one, option), **changes.get(one.name, {})},
        )
        for one, option in list_options(options)
    ]
    return make_decorator(added)


def _make_negation(one: Field[Any], option: Option) -> str:
    """Return the second name of a switch that is neither on nor off by default."""
    return f"/--no-{one.name.replace('_', '-')}" if _is_switch(one, option) else ""


def _is_switch(one: Field[Any], option: Option) -> bool:
    return option.kind is bool and one.default is None


def _make_settings(one: Field[Any], option: Option) -> dict[str, Any]:
    """Return the settings of ``click.option`` for an option."""
    settings: dict[str, Any] = {"help": option.help, "metavar": option.metavar or None}
    if option.kind is bool:
        return settings | ({"default": None} if _is_switch(one, option) else {"is_flag": True})
    if option.words:
        settings["type"] = click.Choice(option.words)
    elif option.kind is float:
        settings["type"] = FiniteRange(min=option.minimum)
    elif option.kind is Path:
        settings["type"] = Path
    if option.check is not None:
        settings["callback"] = _make_check(option.check)
    default = get_default(one, option)
    return settings | ({"default": default, "show_default": True} if default else {})


def _make_check(check: Callable[[str], str]) -> Callable[..., str]:
    """Make a callback of click that returns a checked value, or raises UsageError."""

    def check_value(ctx: click.Context, parameter: click.Parameter, value: str) -> str:
        try:
            return check(value)
        except ConfigError as error:
            raise click.BadParameter(error.message, ctx, parameter) from error

    return check_value


def add_output_option(files: str) -> Callable[[F], F]:
    """Make a decorator that adds ``-o``."""
    return click.option(
        "-o",
        "--output",
        metavar="OUT",
        help=f"Output folder, or {files} file.  [default: standard output]",
    )


def make_export_options(verify: str) -> Callable[[F], F]:
    """Make a decorator that adds the options of strictness, verification and output."""
    return make_decorator(
        [
            click.option(
                "--overwrite", is_flag=True, help="Overwrite files not written by urdftool."
            ),
            click.option(
                "--strict",
                is_flag=True,
                help="Treat information that the format cannot hold as an error.",
            ),
            click.option("--verify", "verified", is_flag=True, help=verify),
            make_format_option("text", "json", help_text="Output format of the report."),
        ]
    )
