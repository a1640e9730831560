"""Messages on standard error, and the choice whether to use colors."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from .control_characters import escape_controls
from .errors import UrdftoolError

if TYPE_CHECKING:
    from typing import Protocol

    from .source.description import GltfUp

    class Transcript(Protocol):
        """What is printed, in order."""

        def add(self, stream: str, text: str) -> None:
            """Add a text that is printed to a stream."""


_LONGEST_LINE = 4000
"""Maximum length of a line of a message [characters]; chosen."""

_MOST_NOTES = 100
"""Lines of notes of one error that are printed; chosen."""


@dataclass
class Console:
    """Settings shared by all commands.

    Attributes:
        color: ``auto``, ``always`` or ``never``.
        verbosity: -1 is quiet, 0 the default; higher values print more.
        config: Configuration file named by the user.
        gltf_up: Up axis of glTF meshes; None if not given.
        debug: Whether to print tracebacks.
        shows_progress: Whether to print progress; a worker does not.
        transcript: Receives each line that is printed; None for none.
        collected: Receives the lines instead of stderr; None to print them.
    """

    color: str = "auto"
    verbosity: int = 0
    config: str | None = None
    gltf_up: GltfUp | None = None
    debug: bool = False
    shows_progress: bool = True
    transcript: Transcript | None = None
    collected: list[str] | None = None

    @property
    def quiet(self) -> bool:
        """Tell whether only errors are printed."""
        return self.verbosity < 0

    def has_colors(self, *, to_file: bool = False, stream: str = "stdout") -> bool:
        """Tell whether output is colored.

        Args:
            to_file: Whether the output is written to a file.
            stream: Name of the stream in :mod:`sys` if it is not written to a file.
        """
        if self.color != "auto":
            return self.color == "always"
        if to_file or os.environ.get("NO_COLOR"):
            return False
        if os.environ.get("FORCE_COLOR"):
            return True
        return getattr(sys, stream).isatty() and os.environ.get("TERM") != "dumb"

    def print_message(self, message: str, *more: str) -> None:
        """Print a message at every verbosity, and more lines."""
        self._write(f"urdftool: {message}")
        for line in more:
            self._write(line)

    def print_line(self, line: str) -> None:
        """Print a line at every verbosity."""
        self._write(line)

    def print_note(self, message: str, level: int = 0) -> None:
        """Print a message if the verbosity is at least ``level``."""
        if self.verbosity >= level:
            self._write(message)

    def print_error(self, error: UrdftoolError) -> None:
        """Print an error with its location, its xacro calls and its notes."""
        self._write(str(error) if error.path else f"urdftool: {error}")
        for call in error.calls:
            self._write(f"  from {call.file.path}:{call.line}:{call.column}: {call.what}")
        for note in error.notes[:_MOST_NOTES]:
            self._write(f"  {note}")
        if len(error.notes) > _MOST_NOTES:
            self._write(f"  … and {len(error.notes) - _MOST_NOTES} more")

    def _write(self, line: str) -> None:
        if self.collected is not None:
            self.collected.append(line)
            return
        if self.transcript is not None:
            self.transcript.add("stderr", line)
        with suppress(OSError):  # stderr may be closed; the exit code remains
            click.echo(escape_controls(_shorten(line)), err=True)


def _shorten(line: str) -> str:
    """Return a line without the middle of a long text from a file."""
    left_out = len(line) - _LONGEST_LINE
    if left_out <= 0:
        return line
    half = _LONGEST_LINE // 2
    return f"{line[:half]} [… {left_out} characters …] {line[-half:]}"
