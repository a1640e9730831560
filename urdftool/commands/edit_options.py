"""Options of all operations of ``urdftool edit``; reading of robots, and the report."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console
from .options import add_gltf_option, add_name_option, add_package_options, split_arguments

if TYPE_CHECKING:
    from ..edit.finish import Edited
    from ..model.elements import Robot

F = TypeVar("F", bound=Callable[..., Any])

GROUPS = {"Output": "output files force style"}

VECTOR = (float, float, float)


def add_edit_options(function: F) -> F:
    """Add the options of all operations: output, files around, packages."""
    for option in (
        add_package_options,
        add_gltf_option,
        click.option(
            "--format",
            "style",
            type=click.Choice(["text", "json"]),
            default="text",
            show_default=True,
            help="Format of the report.",
        ),
        click.option(
            "--force", is_flag=True, help="Write the result also if the comparison differs."
        ),
        click.option(
            "--with",
            "files",
            metavar="FILE",
            multiple=True,
            help="YAML file to edit, too, or the SRDF in place of one that is found. Repeatable.",
        ),
        click.option(
            "-o",
            "--output",
            metavar="OUT",
            help="Output URDF; other files are written next to it. attach and prefix also write "
            "OUT.xacro, which includes the sources.  [default: standard output, only the URDF]",
        ),
        add_name_option,
    ):
        function = option(function)
    return function


class Words:
    """Words of a command line: a robot, its xacro arguments, and operands."""

    def __init__(self, words: tuple[str, ...], count: int | None, names: str) -> None:
        """Split words."""
        named = [word for word in words if "=" in word and ":=" not in word]
        rest, self.arguments = split_arguments(tuple(w for w in words if w not in named))
        rest = sorted([*rest, *named], key=[*rest, *named].index)
        self.path, self.operands = (rest or [""])[0], rest[1:]
        is_wrong = not self.operands if count is None else len(self.operands) != count
        if not rest or is_wrong:
            given = " ".join(words) or "nothing"
            raise click.UsageError(f"the arguments are {names}; given: {given}")


def load_source(
    console: Console,
    path: str,
    arguments: Mapping[str, str],
    package: Mapping[str, Path],
    package_path: tuple[str, ...],
) -> Robot:
    """Read a robot in URDF or xacro.

    Raises:
        UrdftoolError: It cannot be read, or has another format.
    """
    from .read_other import read_any

    return read_any(console, (path, arguments), package, package_path, edit="edit")


def report_edit(
    console: Console, edited: Edited, output: str | None, *, force: bool, style: str
) -> int:
    """Write an edited robot and print its notes and its comparison; return the exit code."""
    from ..diagnostic import Severity
    from ..formats.common.loss_report import count_messages, format_lines
    from ..report import edits as report

    writes = edited.is_proved or force
    is_printed = output in (None, "-")
    written: list[Path] = []
    if writes and output is not None and not is_printed:
        written = edited.write(output)
    if style == "json":
        click.echo(report.to_json(output, written, edited), nl=False)
    else:
        for line in format_lines(edited.notes):
            console.print_note(line)
        if is_printed and writes:
            click.echo(edited.data, nl=False)
        click.echo(report.format_text(edited), nl=False, err=is_printed)
    lost = count_messages(n for n in edited.notes if n.severity is Severity.WARNING)
    console.print_note(report.summarize(output, written, edited, lost, is_written=writes))
    return int(not edited.is_proved)
