"""A line on stderr while meshes are read, or joints are drawn."""

from __future__ import annotations

import sys
from time import monotonic
from types import TracebackType

import click

from ..console import Console

_PATIENCE = 1.0  # seconds


class MeshProgress:
    """Says which mesh is read, once that takes a while and at a terminal; a context to end it."""

    def __init__(self, console: Console, what: str = "meshes") -> None:
        self.what = what
        self.begin = monotonic()
        self.wanted = sys.stderr.isatty() and not console.quiet
        self.shown = False

    def __call__(self, number: int, count: int, uri: str) -> None:
        """Told of each before its turn: its number, how many there are, its name."""
        if self.wanted and monotonic() - self.begin > _PATIENCE:
            self.shown = True
            click.echo(f"\r\033[K{self.what} {number}/{count}  {uri[-50:]!r}", err=True, nl=False)

    def __enter__(self) -> MeshProgress:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self.shown:
            click.echo("\r\033[K", err=True, nl=False)
