"""Check of many descriptions, on several cores if that is faster."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from .outcome import Options, Report
from .run import known_report, lint_file

WORTH_IT = 40  # files; below, starting workers costs more than it saves


def lint_files(paths: Sequence[str], options: Options, jobs: int | None = None) -> Iterator[Report]:
    """Yield a report for each description, in the order given.

    Args:
        paths: The descriptions.
        options: Options of the command line.
        jobs: Number of processes; None chooses by the number of files and cores.
    """
    if options.cache is None:
        yield from _check(paths, options, jobs)
        return
    known = {path: known_report(path, options) for path in paths}
    missing = [path for path in paths if known[path] is None]
    fresh = _check(missing, options, jobs)
    for path in paths:
        yield known[path] or next(fresh)
    if missing:
        options.cache.trim()


def _check(paths: Sequence[str], options: Options, jobs: int | None) -> Iterator[Report]:
    """Yield a report for each description, without the cache of reports."""
    if len(paths) < WORTH_IT and not jobs:  # avoids an import in most calls
        yield from (lint_file(path, options) for path in paths)
        return
    from ..parallel import cores, in_order, map_tasks

    wanted = jobs or cores()
    workers = 1 if "-" in paths else wanted
    if workers > 1 and len(paths) > 1:
        yield lint_file(paths[0], options)  # imports the rules before workers are forked
        paths = paths[1:]
    yield from in_order(map_tasks(partial(lint_file, options=options), paths, workers=workers))
