"""Pages for ``man``: one for urdftool and one a command, from the commands' own help."""

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
    ("0", "Done, and nothing is wrong."),
    ("1", "The robot has what was looked for: findings, differences, a fall."),
    ("2", "It could not be done: a wrong call, a file that is missing or malformed."),
    ("3", "A bug in urdftool."),
    ("130", "Ended by Ctrl-C."),
)
ENVIRONMENT = (
    ("ROS_PACKAGE_PATH, AMENT_PREFIX_PATH", "Where ROS packages are, after the file's workspace."),
    ("XDG_CACHE_HOME", "Where the folder urdftool with results for the next time is."),
    ("NO_COLOR, FORCE_COLOR", "Colours never, or always."),
)


def man_pages() -> Iterator[tuple[Path, str]]:
    """Every page with its text."""
    context = click.Context(cli.main, info_name="urdftool", **cli.main.context_settings)
    commands = {name: cli.main.get_command(context, name) for name in cli.COMMANDS}
    others = ", ".join(rf"\fBurdftool\-{name}\fR(1)" for name in commands)
    overview = [_head(cli.main, ["urdftool"]), _synopsis(cli.main, context)]
    overview += [".SH DESCRIPTION", _prose(cli.main), ".SH COMMANDS"]
    for name, command in commands.items():
        assert command is not None
        overview += [".TP", rf"\fBurdftool\-{name}\fR(1)", _text(_brief(command))]
    overview += [_options(cli.main, context), _end(others, ENVIRONMENT)]
    yield FOLDER / "urdftool.1", _joined(overview)
    for name, command in commands.items():
        assert command is not None
        yield FOLDER / f"urdftool-{name}.1", _joined(_command_page(command, name, context))


def _command_page(command: click.Command, name: str, above: click.Context) -> list[str]:
    context = click.Context(command, info_name=name, parent=above)
    parts = [_head(command, ["urdftool", name]), _synopsis(command, context)]
    parts += [".SH DESCRIPTION", _prose(command), _options(command, context)]
    for inner_name, inner in _inner(command, context):
        below = click.Context(inner, info_name=inner_name, parent=context)
        parts.append(f'.SH "{inner_name.upper()}"')
        called = _text(f"{context.command_path} {inner_name}")
        parts += [f".B {called}", _usage(inner, below), ".PP", _prose(inner)]
        parts.append(_options(inner, below, heading='.SS "Options"'))
    return [*parts, _end(r"\fBurdftool\fR(1)", ())]


def _inner(command: click.Command, context: click.Context) -> Iterator[tuple[str, click.Command]]:
    """The commands in a command; `collision` is none and has one all the same."""
    if context.info_name == "collision":
        yield "mesh", collision_mesh
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            inner = command.get_command(context, name)
            assert inner is not None
            yield name, inner


def _head(command: click.Command, words: list[str]) -> str:
    name = "-".join(words)
    title = f'.TH "{name.upper()}" "1" "" "urdftool {__version__}" "urdftool"'
    return f"{title}\n.SH NAME\n{_text(name)} \\- {_text(_brief(command).rstrip('.'))}"


def _synopsis(command: click.Command, context: click.Context) -> str:
    return f".SH SYNOPSIS\n.B {_text(context.command_path)}\n{_usage(command, context)}"


def _usage(command: click.Command, context: click.Context) -> str:
    return _text(" ".join(command.collect_usage_pieces(context)))


def _brief(command: click.Command) -> str:
    """The first sentence of a command's help."""
    paragraph = inspect.cleandoc(command.help or "").partition("\n\n")[0]
    return " ".join(paragraph.split())


def _prose(command: click.Command) -> str:
    """The help as paragraphs; what is indented stands as it is."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", inspect.cleandoc(command.help or "")):
        lines = [line for line in paragraph.splitlines() if line.strip() != "\b"]
        if lines and all(line.startswith((" ", "urdftool ")) for line in lines):
            shown = "\n".join(_text(line.strip()) for line in lines)
            parts.append(f".PP\n.RS 4\n.nf\n{shown}\n.fi\n.RE")
        elif lines:
            parts.append(".PP\n" + _text(" ".join(line.strip() for line in lines)))
    return "\n".join(parts).removeprefix(".PP\n")


def _options(command: click.Command, context: click.Context, heading: str = ".SH OPTIONS") -> str:
    parts = [heading]
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if record is not None and isinstance(parameter, click.Option):
            parts += [".TP", rf"\fB{_text(record[0])}\fR", _text(record[1])]
    return "\n".join(parts)


def _end(others: str, environment: tuple[tuple[str, str], ...]) -> str:
    parts = [".SH EXIT STATUS"]
    for code, meaning in EXIT_STATUS:
        parts += [".TP", rf"\fB{code}\fR", _text(meaning)]
    if environment:
        parts.append(".SH ENVIRONMENT")
        for name, meaning in environment:
            parts += [".TP", rf"\fB{name}\fR", _text(meaning)]
    return "\n".join([*parts, ".SH SEE ALSO", others, ".PP", "https://urdftool.readthedocs.io"])


def _text(words: str) -> str:
    """Text that roff takes as it is; hyphens of options can be searched and copied."""
    words = words.replace("\\", r"\e").replace("-", r"\-")
    return re.sub(r"^(['.])", r"\\&\1", words, flags=re.MULTILINE)


def _joined(parts: list[str]) -> str:
    return "\n".join(part for part in parts if part) + "\n"
