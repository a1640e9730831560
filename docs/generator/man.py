"""Write pages for ``man`` from the help: one for urdftool and one per command."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import click

from urdftool import __version__, cli
from urdftool.commands.collision_mesh import command as collision_mesh

FOLDER = Path(__file__).resolve().parents[1] / "man"

EXIT_STATUS = (
    ("0", "Done; nothing was found."),
    ("1", "Done; the robot has findings, differences or a failed check."),
    ("2", "Not done: wrong arguments, or a missing or malformed file."),
    ("3", "A bug in urdftool."),
    ("130", "Ended by Ctrl-C."),
)
ENVIRONMENT = (
    (
        "ROS_PACKAGE_PATH, AMENT_PREFIX_PATH",
        "Folders of ROS packages, searched after the workspace of the file.",
    ),
    ("XDG_CACHE_HOME", "Parent folder of the cache."),
    ("NO_COLOR, FORCE_COLOR", "Turn colors off, or on."),
)


def list_man_pages() -> Iterator[tuple[Path, str]]:
    """Yield every page with its text."""
    context = click.Context(cli.main, info_name="urdftool", **cli.main.context_settings)
    commands = {name: cli.main.get_command(context, name) for name in cli.COMMANDS}
    others = ", ".join(rf"\fBurdftool\-{name}\fR(1)" for name in commands)
    overview = [_format_head(cli.main, ["urdftool"]), _format_synopsis(cli.main, context)]
    overview += [".SH DESCRIPTION", _format_prose(cli.main), ".SH COMMANDS"]
    for name, command in commands.items():
        assert command is not None
        overview += [".TP", rf"\fBurdftool\-{name}\fR(1)", _escape(_read_summary(command))]
    overview += [_format_options(cli.main, context), _format_end(others, ENVIRONMENT)]
    yield FOLDER / "urdftool.1", _join(overview)
    for name, command in commands.items():
        assert command is not None
        yield FOLDER / f"urdftool-{name}.1", _join(_write_command(command, name, context))


def _write_command(command: click.Command, name: str, above: click.Context) -> list[str]:
    context = click.Context(command, info_name=name, parent=above)
    parts = [_format_head(command, ["urdftool", name]), _format_synopsis(command, context)]
    parts += [".SH DESCRIPTION", _format_prose(command), _format_options(command, context)]
    for inner_name, inner in _list_subcommands(command, context):
        below = click.Context(inner, info_name=inner_name, parent=context)
        parts.append(f'.SH "{inner_name.upper()}"')
        called = _escape(f"{context.command_path} {inner_name}")
        parts += [f".B {called}", _format_usage(inner, below), ".PP", _format_prose(inner)]
        parts.append(_format_options(inner, below, heading='.SS "Options"'))
    return [*parts, _format_end(r"\fBurdftool\fR(1)", ())]


def _list_subcommands(
    command: click.Command, context: click.Context
) -> Iterator[tuple[str, click.Command]]:
    """Yield the subcommands of a command; `collision` is not a group but has one."""
    if context.info_name == "collision":
        yield "mesh", collision_mesh
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            inner = command.get_command(context, name)
            assert inner is not None
            yield name, inner


def _format_head(command: click.Command, words: list[str]) -> str:
    name = "-".join(words)
    title = f'.TH "{name.upper()}" "1" "" "urdftool {__version__}" "urdftool"'
    return f"{title}\n.SH NAME\n{_escape(name)} \\- {_escape(_read_summary(command).rstrip('.'))}"


def _format_synopsis(command: click.Command, context: click.Context) -> str:
    return f".SH SYNOPSIS\n.B {_escape(context.command_path)}\n{_format_usage(command, context)}"


def _format_usage(command: click.Command, context: click.Context) -> str:
    return _escape(" ".join(command.collect_usage_pieces(context)))


def _read_summary(command: click.Command) -> str:
    """Return the first sentence of the help of a command."""
    paragraph = inspect.cleandoc(command.help or "").partition("\n\n")[0]
    return " ".join(paragraph.split())


def _format_prose(command: click.Command) -> str:
    """Return the help as paragraphs; indented text keeps its lines."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", inspect.cleandoc(command.help or "")):
        lines = [line for line in paragraph.splitlines() if line.strip() != "\b"]
        if lines and all(line.startswith((" ", "urdftool ")) for line in lines):
            shown = "\n".join(_escape(line.strip()) for line in lines)
            parts.append(f".PP\n.RS 4\n.nf\n{shown}\n.fi\n.RE")
        elif lines:
            parts.append(".PP\n" + _escape(" ".join(line.strip() for line in lines)))
    return "\n".join(parts).removeprefix(".PP\n")


def _format_options(
    command: click.Command, context: click.Context, heading: str = ".SH OPTIONS"
) -> str:
    parts = [heading]
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if record is not None and isinstance(parameter, click.Option):
            parts += [".TP", rf"\fB{_escape(record[0])}\fR", _escape(record[1])]
    return "\n".join(parts)


def _format_end(others: str, environment: tuple[tuple[str, str], ...]) -> str:
    parts = [".SH EXIT STATUS"]
    for code, meaning in EXIT_STATUS:
        parts += [".TP", rf"\fB{code}\fR", _escape(meaning)]
    if environment:
        parts.append(".SH ENVIRONMENT")
        for name, meaning in environment:
            parts += [".TP", rf"\fB{name}\fR", _escape(meaning)]
    return "\n".join([*parts, ".SH SEE ALSO", others, ".PP", "https://urdftool.readthedocs.io"])


def _escape(words: str) -> str:
    """Escape text for roff, so that hyphens of options can be searched and copied."""
    words = words.replace("\\", r"\e").replace("-", r"\-")
    return re.sub(r"^(['.])", r"\\&\1", words, flags=re.MULTILINE)


def _join(parts: list[str]) -> str:
    return "\n".join(part for part in parts if part) + "\n"
