"""What the user sees beside the result: messages on stderr, and whether there are colours."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from .errors import UrdftoolError
from .terminal import visible

if TYPE_CHECKING:
    from .source.description import GltfUp


@dataclass
class Console:
    """The choices that hold for every command.

    Attributes:
        color: ``auto``, ``always`` or ``never``.
        verbosity: -1 is quiet, 0 usual, more says more.
        config: The configuration file the user named.
        gltf_up: The axis that is up in glTF meshes; None where the user did not say.
        debug: Whether tracebacks are wanted.
    """

    color: str = "auto"
    verbosity: int = 0
    config: str | None = None
    gltf_up: GltfUp | None = None
    debug: bool = False

    @property
    def quiet(self) -> bool:
        """Whether only errors are said."""
        return self.verbosity < 0

    def colors(self, *, to_file: bool = False, stream: str = "stdout") -> bool:
        """Whether a result or message is coloured.

        Args:
            to_file: The result goes to a file.
            stream: The stream it goes to otherwise.
        """
        if self.color != "auto":
            return self.color == "always"
        if to_file or os.environ.get("NO_COLOR"):
            return False
        if os.environ.get("FORCE_COLOR"):
            return True
        return getattr(sys, stream).isatty() and os.environ.get("TERM") != "dumb"

    def say(self, message: str) -> None:
        """A message that is always said."""
        self._write(f"urdftool: {message}")

    def note(self, message: str, level: int = 0) -> None:
        """A message for those who did not ask for quiet; above level 0, for those who asked."""
        if self.verbosity >= level:
            self._write(message)

    def error(self, error: UrdftoolError) -> None:
        """An error: its place and sentence, the calls it came through, its notes."""
        self._write(str(error) if error.path else f"urdftool: {error}")
        for call in error.calls:
            self._write(f"  from {call.file.path}:{call.line}:{call.column}: {call.what}")
        for note in error.notes:
            self._write(f"  {note}")

    def _write(self, line: str) -> None:
        with suppress(OSError):  # where nobody hears it, the exit code still tells
            click.echo(visible(line), err=True)
