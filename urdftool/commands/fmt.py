"""``urdftool fmt``: format XML files of robots."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from ..console import Console
from .grouped_help import GroupedCommand

if TYPE_CHECKING:
    from ..fmt.run import Formatted


@click.command("fmt", cls=GroupedCommand, groups={"What to do": "check diff"})
@click.argument("paths", nargs=-1, required=True, metavar="PATH...")
@click.option(
    "--check", is_flag=True, help="Write no file; exit with 1 if a file would be changed."
)
@click.option("--diff", is_flag=True, help="Print the changes as a diff; write no file.")
@click.pass_obj
def command(console: Console, paths: tuple[str, ...], check: bool, diff: bool) -> int:
    """Format URDF, xacro, SDF, MJCF and SRDF files in place.

    PATH is a file, a folder, or '-' (standard input, to standard output). Lines are indented by two
    spaces an element; attributes keep their order, lines and quotes; comments, texts and blank
    lines stay, and more than one blank line becomes one. A file is written only if it is the same
    XML afterwards.

    \b
        urdftool fmt urdf/
        urdftool fmt urdf/ --check
        urdftool fmt arm.urdf.xacro --diff

    Exit code 1, with --check or --diff: a file would be changed. Exit code 2: a file could not be
    read, is not well-formed or could not be written.
    """  # noqa: D301 -- click reads the escape
    from ..fmt.discover import ENDINGS, find_files
    from ..lint.discover import describe_links
    from ..lint.skipped import exclude_files
    from ..workspace import Workspace

    links: list[str] = []
    files = find_files(paths, links)
    if not files:
        raise click.UsageError(f"no {', '.join(ENDINGS)} or MJCF file below {', '.join(paths)}")
    if links:
        console.print_note(describe_links(links))
    files, _ = exclude_files(files, paths, console.config, Workspace())
    code = 0
    changed: list[Formatted] = []
    for path in files:
        done = _format(console, path)
        if done is None:
            code = 2
        elif path == "-" and not (check or diff):
            sys.stdout.flush()
            sys.stdout.buffer.write(done.after)
            sys.stdout.buffer.flush()
        elif done.is_changed:
            changed.append(done)
    if check or diff:
        _show(changed, diff=diff)
    else:
        code = max(code, _write(console, changed))
    if files != ["-"]:
        _report_count(console, changed, len(files), would=check or diff)
    return code or int(bool(changed) and (check or diff))


def _format(console: Console, path: str) -> Formatted | None:
    """Return a formatted file; print why it cannot be, and return None."""
    from ..errors import UrdftoolError
    from ..fmt.run import format_file
    from ..source.document import read_file

    try:
        return format_file(read_file(path))
    except UrdftoolError as error:
        console.print_error(error)
        return None


def _show(changed: Iterable[Formatted], *, diff: bool) -> None:
    """Print the changes, or the first line that would change in each file."""
    from ..output import write_result
    from ..report.file_diff import format_file_diff

    if diff:
        lines = [format_file_diff(one.path, one.before, one.after) for one in changed]
    else:
        lines = [f"{one.path}:{one.first_line}: would be formatted\n" for one in changed]
    write_result("".join(lines), None)


def _write(console: Console, changed: Iterable[Formatted]) -> int:
    """Write the files, each whole or not at all, and return the exit code."""
    from ..errors import OutputError
    from ..output import rewrite

    code = 0
    for one in changed:
        try:
            rewrite({one.path: one.before}, {one.path: one.after})
        except OutputError as error:
            console.print_error(error)
            code = 2
    return code


def _report_count(console: Console, changed: list[Formatted], total: int, *, would: bool) -> None:
    count = len(changed)
    verb = "Would format" if would else "Formatted"
    console.print_note(f"{verb} {count} of {total} file{'s' * (total != 1)}.")
