"""Check many descriptions, on several cores where that is faster."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from .outcome import Options, Report
from .run import known_report, lint_file

WORTH_IT = 40  # below so many files, starting workers takes longer than they save


def lint_files(paths: Sequence[str], options: Options, jobs: int | None = None) -> Iterator[Report]:
    """A report for each description, in the order given.

    Args:
        paths: The descriptions.
        options: What the command line says.
        jobs: Processes to use; None is one per core where it is worth it.
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
    """A report for each description, whatever is known of it."""
    if len(paths) < WORTH_IT and not jobs:  # most calls, which need not wait for an import
        yield from (lint_file(path, options) for path in paths)
        return
    from ..parallel import cores, in_order, map_tasks

    wanted = jobs or cores()
    workers = 1 if "-" in paths else wanted
    if workers > 1 and len(paths) > 1:
        yield lint_file(paths[0], options)  # imports the rules, which forked workers then have
        paths = paths[1:]
    yield from in_order(map_tasks(partial(lint_file, options=options), paths, workers=workers))
