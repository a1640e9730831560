"""Separate process for one call of a library that may crash or not return."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from queue import Empty, SimpleQueue
from threading import TIMEOUT_MAX, Thread
from time import monotonic
from typing import IO, Any, TypeVar

from .errors import UrdftoolError
from .mujoco_library import WITHOUT_RENDERING
from .parallel import ignore_interrupts, limit_resources

T = TypeVar("T")

_DYING = 2.0  # s: time to exit after the end of output; chosen
LONGEST = 1e9  # s: RLIMIT_CPU must fit an integer
_PARENT_ENDED = 1  # PR_SET_PDEATHSIG of prctl(2)


class ProcessDied(UrdftoolError):  # noqa: N818 -- reads as what happened
    """Error for an isolated process that ended without a result.

    Attributes:
        exit_code: Exit code, negative for a signal.
        output: Last lines of its standard error.
    """

    def __init__(self, message: str, exit_code: int = 1, output: Sequence[str] = ()) -> None:
        """Store the exit code and the printed lines."""
        super().__init__(message, notes=output)
        self.exit_code = exit_code
        self.output = tuple(output)


class ProcessTimeout(UrdftoolError):  # noqa: N818
    """Error for an isolated process that exceeded its time limit and was killed."""


_START = f"import sys; sys.path[:] = sys.argv[2:]; from {__name__} import serve; serve()"
"""Code of the process; it uses the parent's module search path, not its working directory."""

READY = b"\0urdftool listens\n"
"""Marker sent first; the parent discards output before it, printed during start-up."""

_MESSAGE, _ANSWER, _DIED = "message", "answer", "died"


class IsolatedProcess:
    """Separate Python process that calls one function, as a context manager that ends it.

    Created early, it imports modules while the parent prepares the call. The call and its result
    are pickled and sent through standard input and output; text that a library prints is reported
    only if the process dies.
    """

    def __init__(
        self,
        *preload: str,
        environment: Mapping[str, str] | None = None,
        folder: str | None = None,
    ) -> None:
        """Start the process.

        Args:
            preload: Modules to import while waiting; missing ones are ignored.
            environment: Variables in addition to those of this process.
            folder: Working directory; None takes that of this process.
        """
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 -- closed in __exit__
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _START, ",".join(preload), *map(os.path.abspath, sys.path)],
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                env={**os.environ, **WITHOUT_RENDERING, **(environment or {})},
            )
        except BaseException:
            self._errors.close()
            raise
        self._listener: Thread | None = None

    def __enter__(self: T) -> T:
        """Return the process."""
        return self

    def __exit__(self, *_: object) -> None:
        """Kill the process if it is alive and release its resources; later calls do nothing."""
        if self._errors.closed:
            return
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        if self._listener is not None:
            self._listener.join()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(OSError):  # unread input is discarded
                if pipe is not None:
                    pipe.close()
        self._errors.close()

    def call(
        self,
        module: str,
        function: str,
        *arguments: Any,
        time_limit: float,
        processor_limit: float | None = None,
        on_message: Callable[[Any], None] | None = None,
    ) -> Any:
        """Call a function in the process, once, and return its result.

        Args:
            module: Full name of the module.
            function: Name of the function in that module.
            arguments: Picklable arguments.
            time_limit: Wall-clock limit of the call [s].
            processor_limit: Limit of processor time [s]; None uses ``time_limit`` + 5 s.
            on_message: Called with each message of the function, which then gets a function that
                sends messages as an additional last argument.

        Raises:
            ProcessTimeout: The call exceeded ``time_limit``.
            ProcessDied: The process ended without a result.
            UrdftoolError: Raised by the function.
        """
        most = min(time_limit, LONGEST) + 5 if processor_limit is None else processor_limit
        job = pickle.dumps((module, function, arguments, most, on_message is not None))
        return self._receive(job, arguments, time_limit, on_message)

    def _receive(
        self,
        job: bytes,
        arguments: Sequence[Any],
        time_limit: float,
        on_message: Callable[[Any], None] | None = None,
    ) -> Any:
        """Send a call, and return its result."""
        received: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        exchange = (job, arguments, received)
        listener = Thread(target=self._exchange, args=exchange, daemon=True)
        try:
            listener.start()
        except RuntimeError as error:  # thread limit of the system reached
            raise ProcessDied(f"no thread can be started: {error}") from None
        self._listener = listener
        ends = monotonic() + min(time_limit, TIMEOUT_MAX)
        while True:
            try:
                kind, value = received.get(timeout=max(0.0, ends - monotonic()))
            except Empty:
                raise ProcessTimeout(f"stopped after the limit of {time_limit:g} s") from None
            if kind == _DIED or (kind == _ANSWER and self._process.wait()):
                raise self._make_death_error()
            if kind == _ANSWER:
                break
            if on_message is not None:
                on_message(value)
        if isinstance(value, BaseException):
            raise value
        return value

    def _exchange(
        self, job: bytes, arguments: Sequence[Any], received: SimpleQueue[tuple[str, Any]]
    ) -> None:
        """Send the call to the process and queue its messages and its result."""
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdout is not None
        try:
            if stdin is not None:
                stdin.write(job)
                stdin.flush()  # stays open: its end signals the end of the parent
            for line in stdout:
                if line.endswith(READY):
                    break
            kind = ""
            while kind != _ANSWER:
                kind, value = _Unpickler(stdout, arguments).load()
                received.put((kind, value))
        except Exception:  # the process died within a message
            received.put((_DIED, None))

    def _make_death_error(self) -> ProcessDied:
        try:
            code = self._process.wait(timeout=_DYING)
        except subprocess.TimeoutExpired:  # alive, but its output is unreadable
            self._process.kill()
            code = self._process.wait()
        self._errors.seek(0)
        lines = self._errors.read().decode("utf-8", "replace").strip().splitlines()
        how = f"exit code {code}"
        if code < 0:
            with suppress(ValueError):
                how = signal.Signals(-code).name
        return ProcessDied(how, code, [line[:200] for line in lines[-3:]])


def begin() -> None:
    """End this process when its parent ends, also when that is killed; ignore Ctrl-C."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PARENT_ENDED, signal.SIGKILL)
    ignore_interrupts()


def serve() -> None:
    """Run one call and send its result; the main function of an isolated process."""
    begin()
    answer = os.dup(1)
    os.dup2(2, 1)
    os.write(answer, READY)
    for library in filter(None, sys.argv[1].split(",")):
        with suppress(ImportError):
            import_module(library)
    module, function, arguments, processor_limit, talks = pickle.load(sys.stdin.buffer)
    with suppress(RuntimeError):  # thread limit of the system reached
        Thread(target=_end_with_input, daemon=True).start()
    limit_resources(processor=processor_limit)
    run_call(getattr(import_module(module), function), arguments, answer, talks=talks)


def run_call(
    function: Callable[..., Any], arguments: Sequence[Any], answer: int, *, talks: bool = False
) -> None:
    """Call a function, send its result, and exit.

    Args:
        function: The function.
        arguments: Its arguments.
        answer: File descriptor for the result.
        talks: Whether the function gets a function that sends messages.
    """
    with os.fdopen(answer, "wb") as out:

        def emit(value: Any, kind: str = _MESSAGE) -> None:
            _Pickler(out, arguments).dump((kind, value))
            out.flush()

        try:
            more = (emit,) if talks else ()
            result = function(*arguments, *more)
        except UrdftoolError as error:
            result = error
        emit(result, _ANSWER)
    os._exit(0)  # a library may crash while it is unloaded


class _Pickler(pickle.Pickler):
    """Pickler that sends the arguments of a call as their numbers."""

    def __init__(self, out: IO[bytes], arguments: Sequence[Any]) -> None:
        super().__init__(out, pickle.HIGHEST_PROTOCOL)
        kept = [(number, one) for number, one in enumerate(arguments) if _is_shared(one)]
        self._numbers = {id(one): number for number, one in kept}

    def _get_number(self, value: Any) -> int | None:
        """Return the number of an argument; None for another object."""
        return self._numbers.get(id(value))

    persistent_id = _get_number


class _Unpickler(pickle.Unpickler):
    """Unpickler that takes the arguments of a call from this process."""

    def __init__(self, stream: IO[bytes], arguments: Sequence[Any]) -> None:
        super().__init__(stream)
        self._arguments = arguments

    def _get_argument(self, number: Any) -> Any:
        """Return an argument."""
        return self._arguments[number]

    persistent_load = _get_argument


def _is_shared(argument: object) -> bool:
    """Tell whether an argument has an identity, which numbers and text have not."""
    return type(argument).__module__ != "builtins"


def _end_with_input() -> None:
    """Wait until the other end of standard input is closed, then exit."""
    with suppress(OSError):
        os.read(0, 1)  # sys.stdin would hold a lock that Python needs at exit
    os._exit(1)
