"""A function mapped over tasks by several processes, with limits; and what all processes need.

A task whose worker is killed or takes too long is reported, and the others go on. For one call of a
library that may crash or hang there is :mod:`urdftool.isolated`.
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
"""Called with the number of finished tasks and the tasks that are running."""

_LEAVING = 3.0  # s: for a process to remove its temporary files after SIGTERM


def cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@dataclass(frozen=True)
class Loss:
    """Why a worker gave no result.

    Attributes:
        exit_code: Of the process, negative for a signal; None if it was ended after its time limit.
    """

    exit_code: int | None

    @property
    def timed_out(self) -> bool:
        """Tell whether the time limit ended it."""
        return self.exit_code is None


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

    A task whose worker is killed, as by a system that is out of memory, runs again with no other
    beside it. Ctrl-C and a closed iterator end all workers.

    Args:
        function: What to apply. Tasks and results must pickle; where processes are not forked, the
            function must, too.
        tasks: Its arguments.
        workers: Number of processes. With one, or one task, the function runs in this process.
        on_lost: Makes the result of a task whose worker was lost.
        on_progress: Called when a task begins or ends.
        time_limit: Of a task [s].
        memory_limit: Of a worker's address space [bytes], where the system has such a limit.
        tries: How often a task may lose its worker.
        isolate: Use a new process for each task, even for a single one.

    Yields:
        The index of a task, and its result.

    Raises:
        UrdftoolError: A worker was lost and ``on_lost`` is None.
        Exception: As the function.
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
                outcome = _Result(_lost(tasks[index], outcome, on_lost))
            done += 1
            yield index, outcome.value
        todo = killed
    announce([])


def in_order(results: Iterator[tuple[int, R]]) -> Iterator[R]:
    """Yield the results of :func:`map_tasks` in the order of the tasks."""
    early: dict[int, R] = {}
    following = 0
    for index, result in results:
        early[index] = result
        while following in early:
            yield early.pop(following)
            following += 1


def _lost(task: T, loss: Loss, on_lost: Callable[[T, Loss], R] | None) -> R:
    if on_lost is not None:
        return on_lost(task, loss)
    how = "took too long" if loss.timed_out else f"ended with exit code {loss.exit_code}"
    raise UrdftoolError(f"a worker process {how}; use fewer workers if memory is short")


@dataclass(frozen=True)
class _Result(Generic[R]):
    """What the function returned."""

    value: R


class _Crew(Generic[T, R]):
    """Worker processes of one function."""

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
        """Yield the outcome of each task in ``todo``, by its index."""
        from multiprocessing import connection

        waiting = deque(todo)
        idle: list[_Worker] = []
        busy: dict[Any, _Worker] = {}
        try:
            while waiting or busy:
                while waiting and len(busy) < workers:
                    worker = idle.pop() if idle else _Worker(self.arguments)
                    busy[worker.connection] = worker  # so that it is ended if it cannot begin
                    worker.begin(waiting[0], tasks[waiting[0]])
                    waiting.popleft()
                announce([worker.index for worker in busy.values()])
                for ready in connection.wait(list(busy), self._patience(busy.values())):
                    worker = busy.pop(ready)
                    outcome: Any = worker.receive()
                    if self.isolate or isinstance(outcome, Loss):
                        worker.close()
                    else:
                        idle.append(worker)
                    yield worker.index, outcome
                for worker in self._overdue(busy):
                    del busy[worker.connection]
                    end_processes([worker.process])
                    worker.connection.close()
                    yield worker.index, Loss(None)
        finally:
            left = [*idle, *busy.values()]
            end_processes([worker.process for worker in left])
            for worker in left:
                worker.connection.close()

    def _patience(self, running: Collection[_Worker]) -> float | None:
        """Return how long no worker is overdue [s]."""
        if self.time_limit is None:
            return None
        first = min(worker.began for worker in running)
        return max(0.0, first + self.time_limit - monotonic())

    def _overdue(self, busy: Mapping[Any, _Worker]) -> list[_Worker]:
        limit = self.time_limit
        if limit is None:
            return []
        return [worker for worker in busy.values() if monotonic() - worker.began >= limit]


class _Worker:
    """A process that applies a function to what it is sent."""

    def __init__(self, arguments: tuple[Any, int | None]) -> None:
        from multiprocessing import get_context

        context: Any = get_context("fork" if sys.platform == "linux" else "spawn")
        self.connection, other = context.Pipe()
        self.process = context.Process(target=_work, args=(*arguments, other))
        with _blocked_signals():
            self.process.start()
        other.close()
        self.index = -1
        self.began = 0.0

    def begin(self, index: int, task: object) -> None:
        """Send a task."""
        self.index, self.began = index, monotonic()
        with suppress(BrokenPipeError, ConnectionError):  # it has died: receive() will tell
            self.connection.send((task,))

    def receive(self) -> _Result[Any] | Loss:
        """Return the result.

        Raises:
            Exception: As the function.
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
        """Let the process end by itself."""
        with suppress(OSError):
            self.connection.send(())
        self.process.join(_LEAVING)
        end_processes([self.process])
        self.connection.close()


def _work(function: Callable[[Any], Any], memory_limit: int | None, connection: Any) -> None:
    """Apply a function to tasks until there are no more."""
    from threading import Thread

    ignore_interrupts()
    with suppress(RuntimeError):  # the system may give no more threads
        Thread(target=_leave_with_parent, daemon=True).start()
    with terminate_gracefully():
        _unblock_signals()
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
        connection.send((None, _portable(error)))


def _portable(error: Exception) -> Exception:
    """Return an error that can be sent; some are not made from their message alone."""
    import pickle

    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        if isinstance(error, UrdftoolError):
            return plain_error(error)
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def plain_error(error: UrdftoolError) -> UrdftoolError:
    """Return the same facts as an error that can be sent to another process."""
    return UrdftoolError(
        error.message,
        path=error.path,
        line=error.line,
        column=error.column,
        calls=error.calls,
        notes=error.notes,
        rule=error.rule,
    )


def _leave_with_parent() -> None:
    """Wait until the parent process has ended, and ask this one to leave."""
    import signal
    from multiprocessing import parent_process

    parent = parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)


def end_processes(processes: Sequence[Any]) -> None:
    """End processes: ask them to, and kill those that do not."""
    for process in processes:
        process.terminate()
    until = monotonic() + _LEAVING
    for process in processes:
        process.join(max(0.0, until - monotonic()))
        if process.is_alive():
            process.kill()
            process.join()


def limit_resources(*, processor: float | None = None, memory: int | None = None) -> None:
    """Limit this process, where the system can; no limit is raised, no core is dumped.

    Args:
        processor: Processor time [s], after which the system ends it.
        memory: Address space [bytes], beyond which allocations fail.
    """
    try:
        import resource
    except ImportError:  # Windows
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if processor is not None:
        with suppress(ValueError):  # the present limit is lower
            resource.setrlimit(resource.RLIMIT_CPU, (int(processor), int(processor) + 1))
    if memory is not None:
        with suppress(ValueError):
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def ignore_interrupts() -> None:
    """Ignore Ctrl-C, which ends the parent process, which ends this one."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _blocked_signals() -> Iterator[None]:
    """Hold back signals while a process is forked, until :func:`_unblock_signals` in it.

    It begins with the handlers of this process, which would raise in the middle of its start.
    """
    _mask(hold=True)
    try:
        yield
    finally:
        _mask(hold=False)


def _unblock_signals() -> None:
    _mask(hold=False)


def _mask(*, hold: bool) -> None:
    import signal

    if hasattr(signal, "pthread_sigmask"):
        how = signal.SIG_BLOCK if hold else signal.SIG_UNBLOCK
        signal.pthread_sigmask(how, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})


@contextmanager
def terminate_gracefully() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end by an exception, so that temporary files are removed.

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
