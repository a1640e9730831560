"""What every command with worker processes needs: how many, and that they end quietly."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress


def cores() -> int:
    """The cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def ignore_interrupts() -> None:
    """Ctrl-C ends the parent, which ends its workers."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def signals_later() -> Iterator[None]:
    """Hold back signals while a process is started, which takes them by :func:`take_signals`.

    It is forked with handlers that would raise in the midst of its start.
    """
    _mask(hold=True)
    try:
        yield
    finally:
        _mask(hold=False)


def take_signals() -> None:
    """Take what was held back since before this process was started."""
    _mask(hold=False)


def _mask(*, hold: bool) -> None:
    import signal

    if hasattr(signal, "pthread_sigmask"):
        how = signal.SIG_BLOCK if hold else signal.SIG_UNBLOCK
        signal.pthread_sigmask(how, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})


@contextmanager
def leaving_when_told() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end by an exception, so that what is temporary is removed.

    The exit code is that of a shell for a process that a signal ended. A signal that is ignored, as
    ``nohup`` does, stays so; outside the main thread nothing is changed.
    """
    import signal

    numbers = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]

    def leave(number: int, _: object) -> None:
        for other in numbers:  # a second one does not come in between
            signal.signal(other, lambda *_: None)
        raise SystemExit(128 + number)

    before = {number: signal.getsignal(number) for number in numbers}
    with suppress(ValueError):
        for number, way in before.items():
            if way != signal.SIG_IGN:
                signal.signal(number, leave)
    try:
        yield
    finally:
        with suppress(ValueError, TypeError):
            for number, way in before.items():
                signal.signal(number, way)
