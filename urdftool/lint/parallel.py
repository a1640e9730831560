"""Check many descriptions, on several cores where that is faster."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from functools import partial

from .outcome import Options, Report
from .run import lint_file

WORTH_IT = 40  # below so many files, starting workers takes longer than they save


def lint_files(paths: Sequence[str], options: Options, jobs: int | None = None) -> Iterator[Report]:
    """A report for each description, in the order given.

    Args:
        paths: The descriptions.
        options: What the command line says.
        jobs: Processes to use; None is one per idle core where it is worth it.
    """
    wanted = jobs or (_idle_cores() if len(paths) >= WORTH_IT else 1)
    workers = min(wanted, len(paths))
    if workers <= 1 or "-" in paths:
        for path in paths:
            yield lint_file(path, options)
        return
    import multiprocessing

    yield lint_file(paths[0], options)  # imports the rules, which forked workers then have
    method = "fork" if "fork" in multiprocessing.get_all_start_methods() else None
    chunk = max(1, min(16, len(paths) // (workers * 4)))
    with multiprocessing.get_context(method).Pool(workers, _ignore_interrupts) as pool:
        yield from pool.imap(partial(lint_file, options=options), paths[1:], chunk)


def _idle_cores() -> int:
    """Cores that are not at work already, and one at least."""
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    busy = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0
    return max(1, cores - int(busy))


def _ignore_interrupts() -> None:
    """Ctrl-C ends the parent, which ends its workers."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
