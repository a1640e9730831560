"""Check of many descriptions, on several cores if that is faster."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from .options import Options
from .outcome import Report
from .questions import find_cached_report

WORTH_IT = 40
"""Files; below, starting workers costs more than it saves. Chosen, no source."""


def check_files(
    paths: Sequence[str], options: Options, jobs: int | None = None
) -> Iterator[Report]:
    """Yield a report for each description, in the order given.

    Args:
        paths: The descriptions.
        options: Options of the command line.
        jobs: Number of processes; None chooses by the number of files and cores.
    """
    if options.cache is None:
        yield from _check(paths, options, jobs)
        return
    known = {path: find_cached_report(path, options) for path in paths}
    missing = [path for path in paths if known[path] is None]
    fresh = _check(missing, options, jobs)
    for path in paths:
        yield known[path] or next(fresh)
    if missing:
        options.cache.trim()


def _check(paths: Sequence[str], options: Options, jobs: int | None) -> Iterator[Report]:
    """Yield a report for each description, without the cache of reports."""
    if not paths:
        return
    from .run import check_file  # imports what rules require

    if len(paths) < WORTH_IT and not jobs:  # avoids an import in most calls
        yield from (check_file(path, options) for path in paths)
        return
    from ..parallel import count_cores, map_tasks, yield_in_order

    processes = jobs or count_cores()
    workers = 1 if "-" in paths else processes
    if workers > 1 and len(paths) > 1:
        yield check_file(paths[0], options)  # imports the rules before workers are forked
        paths = paths[1:]
    yield from yield_in_order(
        map_tasks(partial(check_file, options=options), paths, workers=workers)
    )
