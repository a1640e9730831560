"""Work on many things in several processes: none is lost with a worker, Ctrl-C ends them all."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")

UnderWay = Callable[[int, Sequence[T]], None]
"""Called with how many are done, and which are worked on."""

_TRIES = 2


def run_all(
    function: Callable[[T], R],
    tasks: Sequence[T],
    *,
    workers: int,
    lost: Callable[[T], R],
    under_way: UnderWay[T] | None = None,
) -> Iterator[tuple[int, R]]:
    """The number of each task and what the function says of it, as they become ready.

    Args:
        function: What is done; it and the tasks can be sent to another process.
        tasks: What it is done to.
        workers: Processes at most; with one, or one task, it is done here.
        lost: The outcome of a task whose process was killed twice.
        under_way: Told whenever that changes.
    """
    left = list(range(len(tasks)))

    def tell(some: int) -> None:
        if under_way is not None:
            under_way(len(tasks) - len(left), [tasks[index] for index in left[:some]])

    if min(workers, len(tasks)) <= 1:
        for index, task in enumerate(tasks):
            tell(1)
            outcome = function(task)
            left.remove(index)
            yield index, outcome
        tell(0)
        return
    for turn in range(_TRIES):
        # a worker that is killed takes the pool with it; what was not done is begun again
        some = 1 if turn else workers
        tell(some)
        for index, outcome in _pooled(function, tasks, list(left), some):
            left.remove(index)
            tell(some)
            yield index, outcome
        if not left:
            return
    for index in left:
        yield index, lost(tasks[index])


def _pooled(
    function: Callable[[T], R], tasks: Sequence[T], todo: Sequence[int], workers: int
) -> Iterator[tuple[int, R]]:
    import multiprocessing

    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("fork" if "fork" in methods else None)
    if workers == 1:  # a pool each, so that only the one that dies is lost
        for index in todo:
            with ProcessPoolExecutor(1, context, _in_worker) as pool:
                try:
                    yield index, pool.submit(function, tasks[index]).result()
                except BrokenProcessPool:
                    continue
        return
    pool = ProcessPoolExecutor(min(workers, len(todo)), context, _in_worker)
    try:
        futures: dict[Future[R], int] = {
            pool.submit(function, tasks[index]): index for index in todo
        }
        waiting = set(futures)
        while waiting:
            ready, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for future in ready:
                try:
                    outcome = future.result()
                except BrokenProcessPool:
                    continue
                yield futures[future], outcome
    except BaseException:
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            process.terminate()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


def _in_worker() -> None:
    """Ctrl-C ends the parent, which ends its workers."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
