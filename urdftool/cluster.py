"""Map a function over tasks on a Dask cluster, as :func:`urdftool.parallel.map_tasks` does here.

Each thread of a Dask worker has a process of its own (:mod:`urdftool.cluster_child`), which it
keeps between tasks. So a library that crashes costs one task, not the worker.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any, TypeVar

from . import __version__
from .errors import UrdftoolError
from .extras import make_missing_error
from .parallel import Loss, Progress, map_tasks

T = TypeVar("T")
R = TypeVar("R")

ENVIRONMENT = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH")
"""Environment variables that workers take from the process that asks."""

_CONNECTING = 10.0  # s: time to reach the scheduler; chosen
_POLL = 2.0  # s: time between two looks at the workers; chosen
_WITHOUT_WORKERS = 30.0  # s: time after which a cluster without workers is given up; chosen
_GROUPS = 16
"""Groups of tasks per thread of the cluster, because Dask takes some 5 ms for each; chosen, so that
the last groups end at about the same time."""

_START = "import sys; sys.path[:] = sys.argv[1:]; from urdftool.cluster_child import serve; serve()"


@dataclass(frozen=True)
class Job:
    """Function that workers call, and how.

    Attributes:
        function: Picklable function of a task.
        time_limit: Time limit of a task [s]; None for none.
        isolate: Whether each task has a process of its own.
        preload: Modules to import before a task is forked.
        folder: Working directory; relative paths of tasks refer to it.
        environment: Values of :data:`ENVIRONMENT`.
        version: Version of urdftool.
    """

    function: Callable[[Any], Any]
    time_limit: float | None
    isolate: bool
    preload: tuple[str, ...]
    folder: str
    environment: dict[str, str]
    version: str = __version__


def map_anywhere(
    function: Callable[[T], R],
    tasks: Sequence[T],
    *,
    workers: int,
    scheduler: str | None,
    on_lost: Callable[[T, Loss], R],
    on_progress: Progress[T] | None = None,
    time_limit: float | None = None,
    tries: int = 2,
    isolate: bool = False,
    preload: tuple[str, ...] = (),
) -> Iterator[tuple[int, R]]:
    """Apply a function to tasks in processes here or on a cluster; yield results as they are ready.

    Arguments are those of :func:`.parallel.map_tasks`; ``tries`` counts for a task whose process
    here is killed, and workers of a cluster import ``preload`` first.

    Yields:
        The index of a task and its result.

    Raises:
        MissingDependency: distributed is not installed.
        UrdftoolError: No scheduler answers, or a worker has another version of urdftool.
        Exception: Raised by the function.
    """
    if scheduler is None or not tasks:
        yield from map_tasks(
            function,
            tasks,
            workers=workers,
            on_lost=on_lost,
            on_progress=on_progress,
            time_limit=time_limit,
            tries=tries,
            isolate=isolate,
        )
        return
    environment = {name: os.environ[name] for name in ENVIRONMENT if name in os.environ}
    job = Job(function, time_limit, isolate, preload, os.getcwd(), environment)
    for done, (index, outcome) in enumerate(_run_on_cluster(job, tasks, scheduler), 1):
        if isinstance(outcome, Exception):
            raise outcome
        if on_progress is not None:
            on_progress(done, [tasks[index]])
        yield index, on_lost(tasks[index], outcome) if isinstance(outcome, Loss) else outcome


def _run_on_cluster(job: Job, tasks: Sequence[Any], address: str) -> Iterator[tuple[int, Any]]:
    """Yield the index and outcome of each task: the result, an exception or a :class:`Loss`."""
    client = _connect(address)
    plugin = make_plugin()
    received: SimpleQueue[Any] = SimpleQueue()
    with client:
        try:
            client.register_plugin(plugin)
            sent = pickle.dumps(job)
            futures: dict[Any, range] = {}

            def submit(group: range) -> None:
                """Submit a group of tasks, given by their indices."""
                words = plugin.name, sent, [pickle.dumps(tasks[index]) for index in group]
                future = client.submit(run_tasks, *words, pure=False)
                futures[future] = group
                future.add_done_callback(received.put)

            size = max(1, len(tasks) // (_GROUPS * max(1, sum(client.nthreads().values()))))
            everything = range(len(tasks))
            for start in everything[::size]:
                submit(everything[start : start + size])
            yield from _receive(client, futures, received, submit)
        finally:
            with suppress(Exception):  # the scheduler may be gone
                client.unregister_worker_plugin(plugin.name)


def _connect(address: str) -> Any:
    """Return a client of the scheduler at an address.

    Raises:
        MissingDependency: distributed is not installed.
        UrdftoolError: No scheduler answers at the address.
    """
    try:
        import distributed
    except ImportError as error:
        raise make_missing_error("distributed", "--scheduler") from error
    library: Any = distributed
    try:
        return library.Client(address, timeout=_CONNECTING)
    except (OSError, ValueError, TimeoutError) as error:
        raise UrdftoolError(
            f"no Dask scheduler answers at {address}; start one with `dask scheduler`"
        ) from error


def _receive(
    client: Any,
    futures: dict[Any, range],
    received: SimpleQueue[Any],
    submit: Callable[[range], None],
) -> Iterator[tuple[int, Any]]:
    """Yield outcomes in the order in which they arrive; what is missing without workers is lost.

    The tasks of a lost group are submitted once more, one by one, so that one of them is lost.
    """
    missing = {index for group in futures.values() for index in group}
    seen = monotonic()
    while missing:
        try:
            future = received.get(timeout=_POLL)
        except Empty:
            if _has_workers(client):
                seen = monotonic()
            elif monotonic() - seen > _WITHOUT_WORKERS:
                yield from ((index, Loss(1, "no worker is left")) for index in sorted(missing))
                return
            continue
        seen = monotonic()
        group = futures.pop(future)
        outcome = _read_outcome(future)
        if isinstance(outcome, Loss) and len(group) > 1:
            for index in group:
                submit(range(index, index + 1))
            continue
        missing.difference_update(group)
        yield from zip(group, [outcome] if isinstance(outcome, Loss) else outcome, strict=True)


def _has_workers(client: Any) -> bool:
    try:
        return bool(client.scheduler_info()["workers"])
    except Exception:  # no answer
        return False


def _read_outcome(future: Any) -> Any:
    """Return the outcomes of a group; a :class:`Loss` if its worker was killed or failed."""
    try:
        return [pickle.loads(answer) for answer in future.result()]
    except Exception as error:  # KilledWorker, CancelledError, or any error of the worker
        return Loss(1, f"the cluster gave it up: {type(error).__name__}")


def run_tasks(plugin: str, job: bytes, tasks: Sequence[bytes]) -> list[bytes]:
    """Run a group of tasks in a process of this Dask worker; return their pickled outcomes."""
    import distributed

    library: Any = distributed
    children = library.get_worker().plugins[plugin]
    child = children.take()
    answers = []
    for task in tasks:
        answer: bytes | None = child.ask(job, task)
        if answer is None:
            answer = pickle.dumps(Loss(child.end()))
            child = children.take()
        answers.append(answer)
    children.give_back(child)
    return answers


def make_plugin() -> Any:
    """Return a plugin of Dask workers that keeps child processes between tasks."""
    import uuid

    import distributed

    library: Any = distributed

    class Children(library.WorkerPlugin):  # type: ignore[misc]
        """Child processes of a Dask worker that wait for a task."""

        name = f"urdftool-{uuid.uuid4().hex}"

        def setup(self, worker: Any) -> None:
            """Begin without processes."""
            self.idle: SimpleQueue[ChildProcess] = SimpleQueue()

        def teardown(self, worker: Any) -> None:
            """End the processes."""
            with suppress(Empty):
                while True:
                    self.idle.get_nowait().end()

        def take(self) -> ChildProcess:
            """Return a process without a task."""
            try:
                return self.idle.get_nowait()
            except Empty:
                return ChildProcess()

        def give_back(self, child: ChildProcess) -> None:
            """Keep a process for the next task."""
            self.idle.put(child)

    return Children()


class ChildProcess:
    """Process of :func:`urdftool.cluster_child.serve`, which runs one task after the other."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-c", _START, *sys.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )

    def ask(self, job: bytes, task: bytes) -> bytes | None:
        """Return the pickled outcome of a task; None if the process ended before."""
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None
        assert stdout is not None
        try:
            pickle.dump((job, task), stdin)
            stdin.flush()
            answer: bytes = pickle.load(stdout)
        except (EOFError, OSError, pickle.UnpicklingError):
            return None
        return answer

    def end(self) -> int:
        """End the process, and return its exit code, negative for a signal."""
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(OSError):  # unread input is discarded
                if pipe is not None:
                    pipe.close()
        try:
            return self._process.wait(_POLL)
        except subprocess.TimeoutExpired:
            self._process.kill()
            return self._process.wait()
