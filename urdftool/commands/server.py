"""``urdftool server``: the language server for editors."""

from __future__ import annotations

import io
import logging
import os
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import add_package_options

if TYPE_CHECKING:
    from ..server.answer_stream import AnswerStream


@click.command("server", cls=GroupedCommand, groups={"Rules": "select ignore target"})
@click.option("--select", multiple=True, metavar="RULES", help="Check only these rules.")
@click.option("--ignore", multiple=True, metavar="RULES", help="Skip these rules.")
@click.option(
    "--target",
    multiple=True,
    metavar="TARGET",
    help="Target program, as in 'urdftool lint'. Repeatable.  [default: detected from the file]",
)
@add_package_options
@click.pass_obj
def command(
    console: Console,
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    target: tuple[str, ...],
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Serve an editor: findings, fixes, hover, outline and formatting while you type.

    The editor starts this command and speaks the Language Server Protocol over standard input and
    output. docs/editors.md lists what to write in the settings of each editor. It requires the
    extra 'server': pip install 'urdftool[server]'.
    """
    from ..extras import require

    require("urdftool server", "pygls", "lsprotocol")
    from ..server.answer_stream import AnswerStream
    from ..server.features import serve
    from ..server.protocol import ServerSettings

    settings = ServerSettings(
        {name: str(folder) for name, folder in package.items()},
        package_path,
        target,
        select or None,
        ignore,
    )
    if not console.debug:
        log = logging.getLogger("pygls")
        log.addHandler(_Log(console, logging.WARNING))
        log.propagate = False
    answers = AnswerStream(os.dup(1))
    os.dup2(2, 1)  # what a library prints is not part of the protocol
    with closing(answers), _Questions(io.FileIO(os.dup(0))) as questions:
        questions.answers = answers
        serve(settings, questions, answers)
    return 0


class _Log(logging.Handler):
    """Log of the library, of which an editor shows each line: errors without their traceback."""

    def __init__(self, console: Console, level: int) -> None:
        super().__init__(level)
        self._console = console

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record as one message."""
        error = record.exc_info[1] if record.exc_info else None
        why = "" if error is None else f": {type(error).__name__}: {error}"
        self._console.print_message(f"{record.getMessage()}{why}")


class _Questions(io.BufferedReader):
    """Messages of the editor; this process ends with them.

    Attributes:
        answers: Stream of the answers, the last of which are written first.
    """

    answers: AnswerStream

    def _read_line(self, size: int | None = -1) -> bytes:
        """Return a line; end the process if there is none, as many editors end without a word."""
        line = super().readline(size)
        if not line:
            self.answers.close()
            os._exit(0)
        return line

    readline = _read_line
