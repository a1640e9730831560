"""Time and memory limits of expressions.

Bounds on single functions do not stop ``[0 for x in range(999999) for y in range(999999)]``. Where
the system has interval timers, one checks the limits periodically.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

SECONDS = 10.0
"""Maximum processor time of one expression [s]."""

TOTAL_SECONDS = 60.0
"""Maximum processor time of one expansion [s]."""

MEMORY = 2 << 30
"""Maximum growth of the process during an expansion [bytes]."""

_INTERVAL = 0.25


class EvaluationLimits:
    """Limits of one expansion.

    Attributes:
        since: Processor time [s] at the start of the running expression; None between expressions.
    """

    def __init__(self, too_long: Callable[[float], Exception]) -> None:
        """Create limits with no expression running.

        Args:
            too_long: Makes the error for an expansion that takes longer than a time [s].
        """
        self.since: float | None = None
        self._too_long = too_long
        self._end: float | None = None
        self._memory = 0

    @contextmanager
    def enforce(self) -> Iterator[None]:
        """Check the limits periodically, on POSIX in the main thread if no other timer is set."""
        main = threading.current_thread() is threading.main_thread()
        if sys.platform == "win32" or not main or signal.getitimer(signal.ITIMER_REAL)[0]:
            yield
            return
        self._memory = _measure_peak_memory()
        self._end = time.process_time() + TOTAL_SECONDS
        before = signal.signal(signal.SIGALRM, self._look)
        signal.setitimer(signal.ITIMER_REAL, _INTERVAL, _INTERVAL)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def _look(self, number: int, frame: FrameType | None) -> None:
        if self._end is not None and time.process_time() > self._end:
            self._end = None
            raise self._too_long(TOTAL_SECONDS)
        if self.since is None:
            return
        if time.process_time() - self.since > SECONDS:
            self.since = None
            raise TimeoutError(f"the evaluation takes more than {SECONDS:g} s of CPU time")
        if _measure_peak_memory() - self._memory > MEMORY:
            self.since = None
            raise OverflowError(f"the evaluation requires more than {MEMORY >> 30} GiB of memory")


def _measure_peak_memory() -> int:
    """Return the maximum resident memory of the process so far [bytes]."""
    import resource

    found = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return found if sys.platform == "darwin" else found * 1024
