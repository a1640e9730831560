"""An engine in a process of its own, which may crash or hang."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..errors import UrdftoolError
from ..isolated import IsolatedProcess, ProcessDied, ProcessTimeout

MODULES = __package__


class EngineDied(UrdftoolError):  # noqa: N818 -- reads as what happened
    """The engine ended without an answer, or took too long."""


class EngineProcess(IsolatedProcess):
    """A process that waits for a job; it starts while the parent still prepares.

    Use it in a ``with``: however that ends, the process has ended, too.
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
            module: Of this package, such as ``engines.driver``.
            function: In it.
            arguments: Anything that pickles.
            time_limit: The longest it may take [s].
            on_emit: Receives what the function emits before it returns; the function then takes
                ``emit`` as its last argument.

        Raises:
            EngineDied: It took longer, or the process ended.
            UrdftoolError: As the function.
        """
        try:
            return super().call(
                f"{MODULES}.{module}", function, *arguments,
                time_limit=time_limit, on_message=on_emit,
            )  # fmt: skip
        except ProcessTimeout as error:
            raise EngineDied(
                f"the engine {error.message}; give it more "
                "with --time-limit, or less to do with --duration"
            ) from None
        except ProcessDied as error:
            raise EngineDied(
                f"the engine died ({error.message}) without an answer; "
                "'urdftool lint' may say what it choked on",
                notes=error.output,
            ) from None
