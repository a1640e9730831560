"""Run an engine in a separate process, which may crash or not return."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

from ..errors import UrdftoolError
from ..isolated import LONGEST, IsolatedProcess, ProcessDied, ProcessTimeout

MODULES = __package__

SLOWEST = 20.0
"""Wall-clock limit per limit of processor time, for a busy machine [1]. Chosen, no source."""

_START = 5.0  # s: processor time to import an engine, in addition to the limit of the call


class EngineDied(UrdftoolError):  # noqa: N818 -- reads as what happened
    """The engine crashed, or exceeded its time limit."""


_ADVICE = "increase --time-limit or reduce --duration"


def _limit_processor(time_limit: float) -> float:
    """Return the processor time after which the system ends the process [s]."""
    return min(time_limit, LONGEST) + _START


class EngineProcess(IsolatedProcess):
    """Process that waits for a job, and starts while the parent prepares the job.

    Use it in a ``with`` statement, which always ends the process.
    """

    def __init__(self, library: str) -> None:
        """Start the process, which imports an engine's library while it waits."""
        super().__init__("numpy", library, environment={"OMP_NUM_THREADS": "1"})

    def call(  # type: ignore[override]
        self,
        module: str,
        function: str,
        *arguments: Any,
        time_limit: float,
        on_emit: Callable[[Any], None] | None = None,
    ) -> Any:
        """Call a function of this package in the process, and return its result.

        The limit of processor time [s] is in addition to that of the start; with ``on_emit``, the
        function takes ``emit`` as its last argument.

        Raises:
            EngineDied: The time limit was exceeded, or the process ended.
            UrdftoolError: Error of the function.
        """
        try:
            return super().call(
                f"{MODULES}.{module}", function, *arguments,
                time_limit=SLOWEST * time_limit, processor_limit=_limit_processor(time_limit),
                on_message=on_emit,
            )  # fmt: skip
        except ProcessTimeout as error:
            raise EngineDied(f"the physics engine was {error.message}; {_ADVICE}") from None
        except ProcessDied as error:
            if error.exit_code == -getattr(signal, "SIGXCPU", 0) != 0:
                raise EngineDied(
                    f"the physics engine was stopped after the limit of {time_limit:g} s of "
                    f"processor time; {_ADVICE}"
                ) from None
            raise EngineDied(
                f"the physics engine crashed ({error.message}); run 'urdftool lint' to find the "
                "cause",
                notes=error.output,
            ) from None
