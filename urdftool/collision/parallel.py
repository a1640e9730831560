"""Simplification of many meshes in parallel: each once, known results from the cache."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from ..errors import MeshError, UrdftoolError
from ..parallel import Loss, count_cores, map_tasks
from ..storage import DiskCache
from .cache import compute_key, read_cached_result
from .compute import Result, Task, parse_result, try_compute

Progress = Callable[[int, int, Sequence[str]], None]
"""Called with the number of meshes done, their total, and the names of those in progress."""

Outcome = bytes | UrdftoolError


def compute_all(
    tasks: Sequence[Task],
    cache: DiskCache,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> dict[Task, Result | UrdftoolError]:
    """Compute the result of each task, or the error.

    Equal tasks, and equal files under different names, are computed once.
    """
    found: dict[Task, Result | UrdftoolError] = {}
    groups: dict[str, list[Task]] = {}
    for task in dict.fromkeys(tasks):
        groups.setdefault(compute_key(task) or str(task), []).append(task)
    todo: dict[str, Task] = {}
    for key, same in groups.items():
        known = read_cached_result(cache, key)
        if known is None:
            todo[key] = same[0]
        else:
            found.update(dict.fromkeys(same, known))
    count = len(groups)
    # largest first, so that all processes finish at about the same time
    ordered = sorted(todo, key=lambda key: (-_get_size(todo[key].path), key))
    work = [todo[key] for key in ordered]
    known_before = count - len(work)

    def under_way(done: int, now: Sequence[Task]) -> None:
        if progress is not None:
            progress(known_before + done, count, [task.path.name for task in now])

    workers = jobs or count_cores()
    outcomes: Iterator[tuple[int, Outcome]]
    if scheduler is not None and work:
        from ..cluster import map_anywhere
        from .cluster import read_task, simplify_sent

        outcomes = map_anywhere(
            simplify_sent,
            [read_task(task) for task in work],
            workers=workers,
            scheduler=scheduler,
            on_lost=lambda sent, loss: _make_failure(sent[0], loss),
            on_progress=lambda done, now: under_way(done, [task for task, _ in now]),
        )
    else:
        # surplus cores are shared among the meshes
        each = partial(try_compute, cores=max(1, workers // max(1, len(work))))
        outcomes = map_tasks(
            each, work, workers=workers, on_lost=_make_failure, on_progress=under_way
        )
    for index, outcome in outcomes:
        key = ordered[index]
        result: Result | UrdftoolError
        if isinstance(outcome, bytes):
            result = parse_result(outcome)
            if result.lasting:
                cache.put(key, outcome)
        else:
            result = outcome
        found.update(dict.fromkeys(groups[key], result))
    if work and not cache.trouble:
        cache.trim()
    return {task: found[task] for task in tasks}


def _make_failure(task: Task, loss: Loss) -> Outcome:
    if loss.reason:
        return MeshError(f"the mesh was not simplified: {loss.reason}", path=task.path)
    return MeshError(
        "the process that simplified the mesh was killed twice, probably because memory ran "
        "out; try --method hull for its link",
        path=task.path,
    )


def _get_size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0
