"""Time and memory limits of expressions, in the process that expands a description.

Bounds on single functions do not stop ``[0 for x in range(999999) for y in range(999999)]``. Where
the system has interval timers, one checks the limits periodically between two steps of Python; the
system itself ends a process in which one step does not end.
"""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from ..errors import XacroError
from .location import Place

SECONDS = 5.0
"""Maximum processor time of one expression [s]; chosen, 198 real expansions take 10 ms each."""

TOTAL_SECONDS = 15.0
"""Maximum processor time of one expansion [s]; chosen, the longest of 198 real ones takes 0.2 s."""

MEMORY = 512 << 20
"""Maximum growth of the process during an expansion [bytes]; chosen."""

_INTERVAL = 0.25  # s of processor time between two checks of a limit; chosen, no source


def make_time_error(at: Place | None) -> XacroError:
    """Return the error for an expansion that takes longer than ``TOTAL_SECONDS``."""
    return XacroError(
        f"the expansion was stopped because it takes more than {TOTAL_SECONDS:g} s of CPU time",
        at=at,
        rule="endless-expansion",
    )


class EvaluationLimits:
    """Limits of one expansion.

    Attributes:
        running: Number of the running expression, counted from 1; 0 between expressions.
    """

    def __init__(self, too_long: Callable[[], Exception]) -> None:
        """Create limits with no expression running.

        Args:
            too_long: Makes the error for an expansion that takes longer than ``TOTAL_SECONDS``.
        """
        self.running = 0
        self._started = 0
        self._seen = 0, 0.0
        self._too_long = too_long
        self._end: float | None = None
        self._memory = 0

    @contextmanager
    def enforce(self) -> Iterator[None]:
        """Check the limits periodically, on POSIX."""
        if sys.platform == "win32":
            yield
            return
        self._memory = _measure_peak_memory()
        self._end = time.process_time() + TOTAL_SECONDS
        signal.signal(signal.SIGALRM, self._look)
        signal.setitimer(signal.ITIMER_REAL, _INTERVAL, _INTERVAL)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)

    def start(self) -> None:
        """Begin an expression; its time is counted from the next look of the timer."""
        self._started += 1
        self.running = self._started

    def stop(self) -> None:
        """End the running expression."""
        self.running = 0

    def _look(self, number: int, frame: FrameType | None) -> None:
        if self._end is not None and time.process_time() > self._end:
            self._end = None
            raise self._too_long()
        if not self.running:
            return
        if self._seen[0] != self.running:
            self._seen = self.running, time.process_time()
        if time.process_time() - self._seen[1] > SECONDS - _INTERVAL:
            self.running = 0
            raise TimeoutError(f"the evaluation takes more than {SECONDS:g} s of CPU time")
        if _measure_peak_memory() - self._memory > MEMORY:
            self.running = 0
            raise OverflowError(f"the evaluation requires more than {MEMORY >> 20} MiB of memory")


def _measure_peak_memory() -> int:
    """Return the maximum resident memory of the process so far [bytes]."""
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
