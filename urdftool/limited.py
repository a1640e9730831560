"""Calls of a library on a file that may be hostile, in a process with limits.

A description of a kilobyte can be a robot that fills all memory. The system ends the process that
reads it, and the call raises an exception.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from time import monotonic, sleep
from typing import IO, Any, NamedTuple, TypeVar, cast

from .isolated import READY, IsolatedProcess, ProcessDied, ProcessTimeout, begin, run_call
from .parallel import WATCHER, can_fork, limit_resources, make_picklable, measure_memory

T = TypeVar("T")

_MOST_ARENAS = -8, 2  # M_ARENA_MAX of mallopt(3): each thread would reserve 64 MiB of addresses
_MAPPED = 1 << 30  # bytes: mapped files, and addresses that are only reserved; chosen
_PAUSE = 0.005  # s: between two looks at a process; chosen


class Limits(NamedTuple):
    """Limits of a call in another process; memory and processor time where the system has them.

    Attributes:
        time: Wall-clock time [s].
        processor: Processor time of all its threads [s]; None for no limit.
        memory: Memory in addition to that of the loaded libraries [bytes]; None for no limit.
    """

    time: float
    processor: float | None = None
    memory: int | None = None


class LimitExceeded(ProcessDied):
    """Error for a call that exceeded its limits; the message is the exceeded limit."""

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the message and the exit code."""
        return type(self), (self.message, self.exit_code)


def call_with_limits(
    function: Callable[..., T],
    *arguments: Any,
    limits: Limits,
    prepare: Callable[[], None] | None = None,
    threaded: str = "",
) -> T:
    """Call a function in a process with limits, and return its result.

    Where it is safe, the process is a fork of this one, which starts in milliseconds. Arguments to
    which the result refers are the same objects there.

    Args:
        function: A function of a module.
        arguments: Arguments of the function; they and the result are picklable.
        limits: The limits.
        prepare: Function of a module that imports libraries before the limit of memory is set; a
            worker of :mod:`urdftool.parallel` calls it once for all its forks.
        threaded: Library that the function uses and that keeps threads, which a fork lacks if
            this process has loaded it.

    Raises:
        LimitExceeded: The call exceeded a limit.
        ProcessDied: The process crashed.
        Exception: Raised by the function.
    """
    everything = (function, limits, prepare, *arguments)
    try:
        if _can_fork(threaded):
            if prepare is not None and _is_worker():
                prepare()
            with _ForkedProcess(everything) as forked:
                result = forked.receive(limits.time)
        else:
            with IsolatedProcess() as process:
                result = process.call(
                    __name__, _call_guarded.__name__, *everything, time_limit=limits.time
                )
    except ProcessTimeout:
        raise LimitExceeded(f"{limits.time:g} s") from None
    except ProcessDied as error:
        raise _explain(error, limits) from None
    if isinstance(result, _Raised):
        raise result.error
    return cast("T", result)


def _explain(error: ProcessDied, limits: Limits) -> ProcessDied:
    """Return the exceeded limit that ended a process; the error itself if none did."""
    exceeded = getattr(signal, "SIGXCPU", None)
    if limits.processor is not None and exceeded and error.exit_code == -exceeded:
        return LimitExceeded(f"{limits.processor:g} s of processor time", error.exit_code)
    if _NO_MEMORY.search("\n".join(error.output)):
        return _make_memory_error(limits)
    return error


_NO_MEMORY = re.compile("bad_alloc|MemoryError")


def _make_memory_error(limits: Limits) -> LimitExceeded:
    most = "the available" if limits.memory is None else f"{limits.memory >> 20} MiB of"
    return LimitExceeded(f"{most} memory")


class _Raised(NamedTuple):
    """Exception of a function."""

    error: Exception


def _call_guarded(
    function: Callable[..., Any],
    limits: Limits,
    prepare: Callable[[], None] | None,
    *arguments: Any,
) -> Any:
    """Call a function with limits; an exception is returned."""
    if prepare is not None:
        prepare()
    _limit_arenas()
    data = memory = None
    if limits.memory is not None and (used := measure_memory()) is not None:
        data, memory = used[1] + limits.memory, used[0] + limits.memory + _MAPPED
    limit_resources(processor=limits.processor, memory=memory, data=data)
    try:
        result = function(*arguments)
    except MemoryError:
        result = None
        return _Raised(_make_memory_error(limits))
    except Exception as error:
        return _Raised(make_picklable(error))
    return result


def _limit_arenas() -> None:
    if sys.platform == "linux":
        import ctypes

        with suppress(AttributeError):  # a C library without it
            ctypes.CDLL(None).mallopt(*_MOST_ARENAS)


@contextmanager
def open_no_files() -> Iterator[None]:
    """Make each attempt to open a file in this process fail, where the system can."""
    try:
        import resource
    except ImportError:  # Windows
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def _can_fork(threaded: str) -> bool:
    """Tell whether a fork of this process can use a library that keeps threads; "" is none."""
    return can_fork() and (_is_worker() or threaded not in sys.modules)


def _is_worker() -> bool:
    """Tell whether this process is a worker, which uses libraries only as ``prepare`` does."""
    return any(one.name == WATCHER for one in threading.enumerate())


class _ForkedProcess(IsolatedProcess):
    """Fork of this process that calls one function; a context manager that ends it."""

    def __init__(self, arguments: Sequence[Any]) -> None:
        """Start the process with the arguments of :func:`_call_guarded`."""
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 -- closed in __exit__
        self._listener = None
        self._arguments = arguments

        def work(answer: int) -> None:
            os.dup2(self._errors.fileno(), 1)
            os.dup2(self._errors.fileno(), 2)
            run_call(_call_guarded, arguments, answer)

        try:
            self._process = cast("subprocess.Popen[bytes]", _Fork(work))
        except BaseException:
            self._errors.close()
            raise

    def receive(self, time_limit: float) -> Any:
        """Return the result of the call; it raises as :meth:`call`."""
        return self._receive(b"", self._arguments, time_limit)


class _Fork:
    """Fork of this process, with the interface of :class:`subprocess.Popen`."""

    stdin: IO[bytes] | None = None

    def __init__(self, work: Callable[[int], None]) -> None:
        """Start the process.

        Args:
            work: Called in the fork with the file descriptor for its output.
        """
        self.returncode: int | None = None
        receive, send = os.pipe()
        with warnings.catch_warnings():  # threads of numpy stop before a fork
            warnings.simplefilter("ignore", DeprecationWarning)
            self._pid = os.fork()
        if not self._pid:
            try:
                signal.signal(signal.SIGTERM, signal.SIG_DFL)
                begin()
                os.write(send, READY)
                work(send)
            except BaseException as error:
                os.write(2, type(error).__name__.encode())
            finally:
                os._exit(1)
        os.close(send)
        self.stdout: IO[bytes] = os.fdopen(receive, "rb")

    def poll(self) -> int | None:
        """Return the exit code; None if the process is running."""
        return self._wait(os.WNOHANG)

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the process, and return its exit code.

        Raises:
            TimeoutExpired: It is running after the time.
        """
        until = None if timeout is None else monotonic() + timeout
        while (code := self._wait(0 if until is None else os.WNOHANG)) is None:
            if until is not None and monotonic() > until:
                raise subprocess.TimeoutExpired("fork", timeout or 0.0)
            sleep(_PAUSE)
        return code

    def kill(self) -> None:
        """End the process."""
        if self.poll() is None:
            os.kill(self._pid, signal.SIGKILL)

    def _wait(self, options: int) -> int | None:
        if self.returncode is None:
            pid, status = os.waitpid(self._pid, options)
            if pid:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode
