"""Check of many descriptions, on several cores if that is faster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from ..errors import UrdftoolError
from .options import Options
from .outcome import Report
from .questions import find_cached_report

if TYPE_CHECKING:
    from ..parallel import Loss

WORTH_IT = 40
"""Files; below, starting workers costs more than it saves. Chosen, no source."""


def check_files(
    paths: Sequence[str],
    options: Options,
    jobs: int | None = None,
    *,
    scheduler: str | None = None,
    on_progress: Callable[[int, int, str], None] | None = None,
) -> Iterator[Report]:
    """Yield a report for each description, in the order given."""
    known: dict[str, Report | None] = {}
    if options.cache is not None:
        known = {path: find_cached_report(path, options) for path in paths}
    missing = [path for path in paths if known.get(path) is None]
    fresh = _check(missing, options, jobs, scheduler)
    for done, path in enumerate(paths, 1):
        yield known.get(path) or next(fresh)
        if on_progress is not None:
            on_progress(done, len(paths), path)
    if missing and options.cache is not None:
        options.cache.trim()


def _check(
    paths: Sequence[str], options: Options, jobs: int | None, scheduler: str | None
) -> Iterator[Report]:
    """Yield a report for each description, without the cache of reports."""
    if not paths:
        return
    if len(paths) < WORTH_IT and not jobs and scheduler is None:  # avoids an import in most calls
        yield from (_check_file(path, options) for path in paths)
        return
    from ..cluster import map_anywhere
    from ..parallel import count_cores, yield_in_order

    processes = jobs or count_cores()
    workers = 1 if "-" in paths else processes
    if workers > 1 and len(paths) > 1 and scheduler is None:
        yield _check_file(paths[0], options)  # imports the rules before workers are forked
        paths = paths[1:]
    yield from yield_in_order(
        map_anywhere(
            partial(_check_file, options=options),
            paths,
            workers=workers,
            scheduler=scheduler,
            on_lost=_report_lost,
        )
    )


def _check_file(path: str, options: Options) -> Report:
    """Check a description; what rules require is imported where it is checked."""
    from .run import check_file

    return check_file(path, options)


def _report_lost(path: str, loss: Loss) -> Report:
    """Return the report of a description whose check did not end."""
    why = f"the process that checked it ended before it answered ({loss.describe()})"
    return Report(path, error=UrdftoolError(why, path=path))
