"""Run an engine in a separate process, which may crash or not return."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..errors import UrdftoolError
from ..isolated import IsolatedProcess, ProcessDied, ProcessTimeout

MODULES = __package__


class EngineDied(UrdftoolError):  # noqa: N818 -- reads as what happened
    """The engine crashed, or exceeded its time limit."""


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

        Args:
            module: Module of this package, such as ``engines.driver``.
            function: Name of the function.
            arguments: Picklable arguments.
            time_limit: Time limit [s].
            on_emit: Receives what the function emits before it returns; the function then takes
                ``emit`` as its last argument.

        Raises:
            EngineDied: The time limit was exceeded, or the process ended.
            UrdftoolError: Error of the function.
        """
        try:
            return super().call(
                f"{MODULES}.{module}", function, *arguments,
                time_limit=time_limit, on_message=on_emit,
            )  # fmt: skip
        except ProcessTimeout as error:
            raise EngineDied(
                f"the physics engine was {error.message}; increase --time-limit or reduce "
                "--duration"
            ) from None
        except ProcessDied as error:
            raise EngineDied(
                f"the physics engine crashed ({error.message}); run 'urdftool lint' to find the "
                "cause",
                notes=error.output,
            ) from None
