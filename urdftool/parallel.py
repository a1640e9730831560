"""Map a function over tasks in several processes, with time and memory limits.

A task whose worker is killed or exceeds its time limit is reported; the others continue. For one
call of a library that may crash or not return see :mod:`urdftool.isolated`.
"""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from time import monotonic
from typing import Any, Generic, TypeVar

from .errors import UrdftoolError

T = TypeVar("T")
R = TypeVar("R")

Progress = Callable[[int, Sequence[T]], None]
"""Callback that gets the number of finished tasks and the running tasks."""

WATCHER = "urdftool-watcher"
"""Name of the thread of a worker that waits for the end of the parent, and holds no lock."""

_LEAVING = 3.0  # s: time to remove temporary files after SIGTERM; chosen


def count_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@dataclass(frozen=True)
class Loss:
    """Reason why a worker returned no result.

    Attributes:
        exit_code: Exit code, negative for a signal; None if the time limit ended the worker.
        reason: What a cluster reports instead; empty for a process of this computer.
    """

    exit_code: int | None
    reason: str = ""

    @property
    def timed_out(self) -> bool:
        """Tell whether the time limit ended the worker."""
        return self.exit_code is None

    def describe(self) -> str:
        """Return what ended the worker, for a message."""
        return self.reason or ("time limit" if self.timed_out else f"exit code {self.exit_code}")


def map_tasks(
    function: Callable[[T], R],
    tasks: Sequence[T],
    *,
    workers: int,
    on_lost: Callable[[T, Loss], R] | None = None,
    on_progress: Progress[T] | None = None,
    time_limit: float | None = None,
    memory_limit: int | None = None,
    tries: int = 2,
    isolate: bool = False,
) -> Iterator[tuple[int, R]]:
    """Apply a function to tasks in several processes; yield results as they are ready.

    A task whose worker is killed, for example because memory is exhausted, runs again alone. Ctrl-C
    and closing the iterator end all workers.

    Args:
        function: Function of a task. Tasks and results must be picklable; where processes are not
            forked, the function must be picklable too.
        tasks: Arguments of the function.
        workers: Number of processes. With one worker or one task the function runs in this process.
        on_lost: Returns the result of a task whose worker was lost.
        on_progress: Called when a task starts or ends.
        time_limit: Time limit of a task [s].
        memory_limit: Limit of a worker's address space [bytes], where the system supports it.
        tries: Number of attempts for a task whose worker is killed.
        isolate: Use a new process for each task, even for a single one.

    Yields:
        The index of a task and its result.

    Raises:
        UrdftoolError: A worker was lost and ``on_lost`` is None.
        Exception: Raised by the function.
    """
    done = 0

    def announce(running: Sequence[int]) -> None:
        if on_progress is not None:
            on_progress(done, [tasks[index] for index in running])

    if min(workers, len(tasks)) <= 1 and not isolate:
        for index, task in enumerate(tasks):
            announce([index])
            result = function(task)
            done += 1
            yield index, result
        announce([])
        return
    todo: Sequence[int] = range(len(tasks))
    for attempt in range(tries):
        killed: list[int] = []
        crew = _Crew(function, time_limit, memory_limit, isolate=isolate or attempt > 0)
        for index, outcome in crew.run(tasks, todo, 1 if attempt else workers, announce):
            if isinstance(outcome, Loss):
                if not outcome.timed_out and attempt + 1 < tries:
                    killed.append(index)
                    continue
                outcome = _Result(_handle_lost(tasks[index], outcome, on_lost))
            done += 1
            yield index, outcome.value
        todo = killed
    announce([])


def yield_in_order(results: Iterator[tuple[int, R]]) -> Iterator[R]:
    """Yield the results of :func:`map_tasks` in the order of the tasks."""
    early: dict[int, R] = {}
    following = 0
    for index, result in results:
        early[index] = result
        while following in early:
            yield early.pop(following)
            following += 1


def _handle_lost(task: T, loss: Loss, on_lost: Callable[[T, Loss], R] | None) -> R:
    if on_lost is not None:
        return on_lost(task, loss)
    how = "exceeded its time limit" if loss.timed_out else f"ended with code {loss.exit_code}"
    raise UrdftoolError(f"a worker process {how}; if memory is low, use fewer processes (-j)")


@dataclass(frozen=True)
class _Result(Generic[R]):
    """Return value of the function."""

    value: R


class _Crew(Generic[T, R]):
    """Pool of worker processes for one function."""

    def __init__(
        self,
        function: Callable[[T], R],
        time_limit: float | None,
        memory_limit: int | None,
        *,
        isolate: bool,
    ) -> None:
        self.arguments = function, memory_limit
        self.time_limit = time_limit
        self.isolate = isolate

    def run(
        self,
        tasks: Sequence[T],
        todo: Sequence[int],
        workers: int,
        announce: Callable[[Sequence[int]], None],
    ) -> Iterator[tuple[int, _Result[R] | Loss]]:
        """Yield the outcome of each task in ``todo`` with its index."""
        from multiprocessing import connection

        waiting = deque(todo)
        idle: list[_Worker] = []
        busy: dict[Any, _Worker] = {}
        try:
            while waiting or busy:
                while waiting and len(busy) < workers:
                    worker = idle.pop() if idle else _Worker(self.arguments)
                    busy[worker.connection] = worker  # before begin(), which may fail
                    worker.begin(waiting[0], tasks[waiting[0]])
                    waiting.popleft()
                announce([worker.index for worker in busy.values()])
                for ready in connection.wait(list(busy), self._compute_timeout(busy.values())):
                    worker = busy.pop(ready)
                    outcome: Any = worker.receive()
                    if self.isolate or isinstance(outcome, Loss):
                        worker.close()
                    else:
                        idle.append(worker)
                    yield worker.index, outcome
                for worker in self._find_overdue(busy):
                    del busy[worker.connection]
                    end_processes([worker.process])
                    worker.connection.close()
                    yield worker.index, Loss(None)
        finally:
            left = [*idle, *busy.values()]
            end_processes([worker.process for worker in left])
            for worker in left:
                worker.connection.close()

    def _compute_timeout(self, running: Collection[_Worker]) -> float | None:
        """Return the time until the first worker exceeds its limit [s]; None without a limit."""
        if self.time_limit is None:
            return None
        first = min(worker.began for worker in running)
        return max(0.0, first + self.time_limit - monotonic())

    def _find_overdue(self, busy: Mapping[Any, _Worker]) -> list[_Worker]:
        limit = self.time_limit
        if limit is None:
            return []
        return [worker for worker in busy.values() if monotonic() - worker.began >= limit]


class _Worker:
    """Process that applies a function to the tasks that it receives."""

    def __init__(self, arguments: tuple[Any, int | None]) -> None:
        from multiprocessing import get_context

        context: Any = get_context("fork" if sys.platform == "linux" else "spawn")
        self.connection, other = context.Pipe()
        self.process = context.Process(target=_run_worker, args=(*arguments, other))
        with _block_signals():
            self.process.start()
        other.close()
        self.index = -1
        self.began = 0.0

    def begin(self, index: int, task: object) -> None:
        """Send a task to the process."""
        self.index, self.began = index, monotonic()
        with suppress(BrokenPipeError, ConnectionError):  # receive() returns the loss
            self.connection.send((task,))

    def receive(self) -> _Result[Any] | Loss:
        """Return the result, or the loss if the worker died.

        Raises:
            Exception: Raised by the function.
        """
        try:
            value, error = self.connection.recv()
        except (EOFError, OSError):
            self.process.join()
            return Loss(self.process.exitcode)
        if error is not None:
            self.close()
            raise error
        return _Result(value)

    def close(self) -> None:
        """Ask the process to exit; terminate it if it does not."""
        with suppress(OSError):
            self.connection.send(())
        self.process.join(_LEAVING)
        end_processes([self.process])
        self.connection.close()


def _run_worker(function: Callable[[Any], Any], memory_limit: int | None, connection: Any) -> None:
    """Apply a function to tasks until the parent sends no more."""
    from threading import Thread

    ignore_interrupts()
    with suppress(RuntimeError):  # thread limit of the system reached
        Thread(target=_leave_with_parent, name=WATCHER, daemon=True).start()
    with terminate_gracefully():
        hold_signals(hold=False)
        if memory_limit is not None:
            limit_resources(memory=memory_limit)
        with suppress(EOFError, ConnectionError):  # the parent has ended
            while task := connection.recv():
                _send_result(function, task[0], connection)


def _send_result(function: Callable[[Any], Any], task: object, connection: Any) -> None:
    try:
        connection.send((function(task), None))
    except ConnectionError:
        raise
    except Exception as error:
        connection.send((None, make_picklable(error)))


def make_picklable(error: Exception) -> Exception:
    """Return an error that can be pickled, replacing one that cannot."""
    import pickle

    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        if isinstance(error, UrdftoolError):
            return make_plain_error(error)
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def make_plain_error(error: UrdftoolError) -> UrdftoolError:
    """Return the same facts as a :class:`UrdftoolError`, which can be pickled."""
    return UrdftoolError(
        error.message,
        path=error.path,
        line=error.line,
        column=error.column,
        calls=error.calls,
        notes=error.notes,
        rule=error.rule,
        case=error.case,
        data=error.data,
    )


def _leave_with_parent() -> None:
    """Wait until the parent process has ended, then send SIGTERM to this one."""
    import signal
    from multiprocessing import parent_process

    parent = parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)


def end_processes(processes: Sequence[Any]) -> None:
    """Terminate processes; kill those that have not ended after 3 s."""
    for process in processes:
        process.terminate()
    until = monotonic() + _LEAVING
    for process in processes:
        process.join(max(0.0, until - monotonic()))
        if process.is_alive():
            process.kill()
            process.join()


def limit_resources(
    *,
    processor: float | None = None,
    memory: int | None = None,
    data: int | None = None,
    files: int | None = None,
    processes: int | None = None,
) -> None:
    """Limit the resources of this process, where the system supports it; disable core dumps.

    Args:
        processor: Processor time [s] after which the system ends the process.
        memory: Address space [bytes] beyond which allocations fail.
        data: Memory that is not of files [bytes] beyond which allocations fail.
        files: Number of files beyond which none can be opened; 0 also forbids to write to files.
        processes: Number of processes and threads of the user beyond which none is started; the
            superuser has no limit.
    """
    try:
        import resource
    except ImportError:  # Windows
        return
    bounds: dict[int, tuple[int, int]] = {resource.RLIMIT_CORE: (0, 0)}
    if processor is not None:
        bounds[resource.RLIMIT_CPU] = int(processor), int(processor) + 1
    if memory is not None:
        bounds[resource.RLIMIT_AS] = memory, memory
    if data is not None:
        bounds[resource.RLIMIT_DATA] = data, data
    if files is not None:
        bounds[resource.RLIMIT_NOFILE] = files, files
    if processes is not None:
        bounds[resource.RLIMIT_NPROC] = processes, processes
    if files == 0:
        bounds[resource.RLIMIT_FSIZE] = 0, 0
    for limit, bound in bounds.items():
        with suppress(ValueError, OSError):  # the hard limit is lower
            resource.setrlimit(limit, bound)


def measure_memory() -> tuple[int, int] | None:
    """Return the address space of this process and the part that is data [bytes], if known."""
    try:
        with open("/proc/self/statm", "rb") as stream:
            pages = stream.read().split()
    except OSError:
        return None
    size = os.sysconf("SC_PAGE_SIZE")
    return int(pages[0]) * size, int(pages[5]) * size


def can_fork() -> bool:
    """Tell whether a fork of this process can go on: on Linux, without threads that hold locks."""
    import threading

    here = threading.current_thread()
    others = (one for one in threading.enumerate() if one is not here)
    return sys.platform == "linux" and all(one.name == WATCHER for one in others)


def ignore_interrupts() -> None:
    """Ignore SIGINT: the parent process handles Ctrl-C and ends this process."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _block_signals() -> Iterator[None]:
    """Block signals while a process is forked, until :func:`hold_signals` runs in it.

    The new process inherits the signal handlers of this one, which would raise during its start.
    """
    hold_signals(hold=True)
    try:
        yield
    finally:
        hold_signals(hold=False)


def hold_signals(*, hold: bool) -> None:
    """Block the signals that end a process, or unblock them."""
    import signal

    if hasattr(signal, "pthread_sigmask"):
        how = signal.SIG_BLOCK if hold else signal.SIG_UNBLOCK
        signal.pthread_sigmask(how, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})


@contextmanager
def terminate_gracefully() -> Iterator[None]:
    """Convert SIGTERM and SIGHUP to :class:`SystemExit`, so that temporary files are removed.

    The exit code is 128 + signal number, as in a shell. A signal that is ignored, as by ``nohup``,
    stays ignored; outside the main thread nothing changes.
    """
    import signal

    numbers = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]

    def leave(number: int, _: object) -> None:
        for other in numbers:  # a second signal must not interrupt the cleanup
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
