"""Progress line of long computations on stderr."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from threading import Event, Thread
from time import monotonic

import click

from ..console import Console
from ..control_characters import escape_controls

PATIENCE = 1.0
"""Time after which progress is shown [s]. Chosen, no source."""

PIPE_PATIENCE, PIPE_TICK = 2.0, 5.0
"""Time before the first line where stderr is not a terminal, and between two lines [s]. Chosen, no
source."""

_TICK = 0.5  # s between two updates of the elapsed time; chosen
_BAR, _LONGEST = 24, 60  # characters; chosen


class Progress:
    """Progress line at a terminal; a context manager, which clears the line at its end.

    In a pipe or a file it is a line every few seconds, after the first two.

    It is not a live display of rich, because these move and hide the cursor, and
    :mod:`urdftool.terminal` escapes such control sequences.
    """

    def __init__(
        self, console: Console, what: str, *, patience: float = PATIENCE, timed: bool = False
    ) -> None:
        """Start the measurement of time.

        ``patience`` is the time after which it is shown [s]; ``timed`` shows the elapsed time.
        """
        self.what = what
        self.patience = patience
        self.timed = timed
        self.enabled = console.shows_progress and not console.quiet
        self._is_terminal = sys.stderr.isatty()
        self._begin = monotonic()
        self._next = self._begin + PIPE_PATIENCE
        self._shown = False
        self._state: tuple[int, int, str] = 0, 1, ""
        self._over = Event()
        self._thread: Thread | None = None

    def __enter__(self) -> Progress:
        """Return itself."""
        if self.enabled and self.timed:
            self._thread = Thread(target=self._run_timer, daemon=True)
            self._thread.start()
        return self

    def __call__(self, done: int, count: int, running: str | Sequence[str] = "") -> None:
        """Update the progress."""
        names = escape_controls(running if isinstance(running, str) else ", ".join(running))
        self._state = done, count, names
        if not self.enabled or self.timed:
            return
        if not self._is_terminal:
            if monotonic() >= self._next:
                self._write_line()
        elif monotonic() - self._begin >= self.patience:
            self._show()

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        self._over.set()
        if self._thread is not None:
            self._thread.join()
        if self._shown:
            click.echo("\r\033[K", err=True, nl=False)

    def _run_timer(self) -> None:
        if not self._is_terminal:
            wait = PIPE_PATIENCE
            while not self._over.wait(wait):
                self._write_line()
                wait = PIPE_TICK
            return
        wait = self.patience
        while not self._over.wait(wait):
            self._show()
            wait = _TICK

    def _write_line(self) -> None:
        done, count, names = self._state
        seconds = monotonic() - self._begin
        self._next = monotonic() + PIPE_TICK
        share = f"{done} of {count} {self.what}, " if count > 1 or not self.timed else ""
        more = f": {names}" if names else ""
        text = f"{share}{seconds:.0f} s{more}"
        click.echo(text if len(text) <= 2 * _LONGEST else f"{text[: 2 * _LONGEST]}…", err=True)

    def _show(self) -> None:
        done, count, names = self._state
        parts = []
        if count > 1 or not self.timed:
            filled = _BAR * done // max(count, 1)
            parts += [f"{self.what} [{'#' * filled:.<{_BAR}}] {done}/{count}"]
        if self.timed:
            parts.append(f"{monotonic() - self._begin:.0f} s")
        parts.append(names if len(names) <= _LONGEST else f"…{names[1 - _LONGEST :]}")
        self._shown = True
        click.echo(f"\r\033[K{'  '.join(filter(None, parts))}", err=True, nl=False)
