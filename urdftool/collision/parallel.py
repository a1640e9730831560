"""Many meshes: each once, those known from the cache, the others several at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

from ..errors import MeshError, UrdftoolError
from ..workers import cores
from .cache import Cache, key_of
from .compute import Result, Task, attempt, result_of

Progress = Callable[[int, int, Sequence[str]], None]
"""Called with how many meshes are done, of how many, and which are worked on."""

Outcome = bytes | UrdftoolError
_TRIES = 2


def compute_all(
    tasks: Sequence[Task],
    cache: Cache,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> dict[Task, Result | UrdftoolError]:
    """The result of each task, or why there is none.

    Args:
        tasks: What is wanted; equal tasks, and equal files under other names, are computed once.
        cache: What is known already; new results are added as they come.
        jobs: Processes to use; None is one per core.
        scheduler: Address of a Dask scheduler that does the work instead.
        progress: Told of every mesh.
    """
    found: dict[Task, Result | UrdftoolError] = {}
    groups: dict[str, list[Task]] = {}
    for task in dict.fromkeys(tasks):
        groups.setdefault(key_of(task) or str(task), []).append(task)
    todo: dict[str, Task] = {}
    for key, same in groups.items():
        known = cache.read(key)
        if known is None:
            todo[key] = same[0]
        else:
            found.update(dict.fromkeys(same, known))
    count = len(groups)
    # the largest first, so that none is left alone at the end
    ordered = sorted(todo, key=lambda key: (-_size(todo[key].path), key))
    work = [todo[key] for key in ordered]
    if scheduler is not None and work:
        from .cluster import on_cluster

        outcomes = on_cluster(work, scheduler)
    else:
        outcomes = _outcomes(work, jobs or cores(), count, progress)
    done = count - len(work)
    for index, outcome in outcomes:
        done += 1
        key = ordered[index]
        result: Result | UrdftoolError
        if isinstance(outcome, bytes):
            cache.write(key, outcome)
            result = result_of(outcome)
        else:
            result = outcome
        found.update(dict.fromkeys(groups[key], result))
        if progress is not None:
            progress(done, count, [todo[key].path.name])
    return {task: found[task] for task in tasks}


def _outcomes(
    tasks: Sequence[Task], workers: int, count: int, progress: Progress | None
) -> Iterator[tuple[int, Outcome]]:
    if min(workers, len(tasks)) <= 1:
        for index, task in enumerate(tasks):
            if progress is not None:
                progress(count - len(tasks) + index, count, [task.path.name])
            yield index, attempt(task)
        return
    left = list(range(len(tasks)))
    for turn in range(_TRIES):
        # a worker that is killed takes the pool with it; what was not done is begun again
        alone = turn > 0
        for index, outcome in _pooled(tasks, left, 1 if alone else workers):
            left.remove(index)
            yield index, outcome
        if not left:
            return
    for index in left:
        yield (
            index,
            MeshError(
                "the process that simplified the mesh was killed twice, perhaps for want of "
                "memory; try --method hull for its link",
                path=tasks[index].path,
            ),
        )


def _pooled(
    tasks: Sequence[Task], todo: Sequence[int], workers: int
) -> Iterator[tuple[int, Outcome]]:
    import multiprocessing

    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("fork" if "fork" in methods else None)
    if workers == 1:  # a pool each, so that only the one that dies is lost
        for index in list(todo):
            with ProcessPoolExecutor(1, context, _in_worker) as pool:
                try:
                    yield index, pool.submit(attempt, tasks[index]).result()
                except BrokenProcessPool:
                    continue
        return
    pool = ProcessPoolExecutor(min(workers, len(todo)), context, _in_worker)
    try:
        futures: dict[Future[Outcome], int] = {
            pool.submit(attempt, tasks[index]): index for index in todo
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


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _in_worker() -> None:
    """Ctrl-C ends the parent, which ends its workers."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
