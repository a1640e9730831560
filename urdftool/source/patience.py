"""How long one expression may take, and how much memory: a program may also run without end.

No bound on single functions stops ``[0 for x in range(999999) for y in range(999999)]``. Where the
system has timers, one looks in from time to time and ends what takes longer than any robot needs.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SECONDS = 10.0
"""Processor time that one expression may take."""

MEMORY = 2 << 30
"""Bytes by which the process may grow during an expansion."""

_INTERVAL = 0.25


class Patience:
    """Of one expansion.

    Attributes:
        since: The processor time when the expression began that is evaluated; None between them.
    """

    def __init__(self) -> None:
        """Nothing is evaluated yet."""
        self.since: float | None = None
        self._memory = 0

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Look in from time to time, where that is possible: in the main thread, on POSIX."""
        main = threading.current_thread() is threading.main_thread()
        if sys.platform == "win32" or not main or signal.getitimer(signal.ITIMER_REAL)[0]:
            yield
            return
        self._memory = _largest()
        before = signal.signal(signal.SIGALRM, self._look)
        signal.setitimer(signal.ITIMER_REAL, _INTERVAL, _INTERVAL)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def _look(self, number: int, frame: FrameType | None) -> None:
        if self.since is None:
            return
        if time.process_time() - self.since > SECONDS:
            self.since = None
            raise TimeoutError(f"takes more than {SECONDS:g} s of the processor")
        if _largest() - self._memory > MEMORY:
            self.since = None
            raise OverflowError(f"takes more than {MEMORY >> 30} GiB of memory")


def _largest() -> int:
    """The most memory the process has had [bytes]."""
    import resource

    found = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return found if sys.platform == "darwin" else found * 1024
