"""``urdftool lint --watch``: report again when a file of a robot changes."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import click

from ..console import Console
from ..errors import UrdftoolError
from ..report.counted import format_count

if TYPE_CHECKING:
    from ..lint.options import Options
    from ..lint.outcome import Report

CheckFiles = Callable[["Sequence[str]", "Options", "int | None"], "Iterator[Report]"]

_OTHER_WORK = {
    "fix": "--fix",
    "diff": "--diff",
    "write_baseline": "--write-baseline",
    "list_robots": "--list",
    "changed_since": "--changed-since",
}
_MOST_NAMES = 3  # robots that a line lists; chosen, no source


def watch_files(
    console: Console,
    paths: Sequence[str],
    given: Mapping[str, Any],
    run: Callable[[CheckFiles], int],
    sleep: Callable[[float], object] = time.sleep,
) -> NoReturn:
    """Report findings, and again after each change, until Ctrl-C.

    Raises:
        click.UsageError: An option does not go with ``--watch``.
        KeyboardInterrupt: Ctrl-C.
    """
    from ..lint.watch import Watch

    for name, option in _OTHER_WORK.items():
        if given[name]:
            raise click.UsageError(f"--watch reports findings; it does not go with {option}")
    if "-" in paths:
        raise click.UsageError("--watch requires files; standard input does not change")
    watch = Watch(paths)
    run(watch.check_files)
    while True:
        sys.stdout.flush()
        files = format_count(watch.count_files(), "file")
        console.print_note(f"watching {files}; Ctrl-C ends")
        console.print_note(f"changed: {_name_files(watch.wait(sleep))}")
        try:
            run(watch.check_files)
        except UrdftoolError as error:  # a configuration that is edited
            console.print_error(error)
        except click.UsageError as error:  # no file is left
            console.print_message(error.format_message())


def _name_files(paths: Sequence[str]) -> str:
    """Return the names of the first files, relative to the present folder."""
    names = [os.path.relpath(path) for path in paths]
    more = len(names) - _MOST_NAMES
    return ", ".join(names[:_MOST_NAMES]) + (f" and {more} more" if more > 0 else "")
