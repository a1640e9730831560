"""Check many descriptions, on several cores where that is faster."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ..workers import cores, ignore_interrupts
from .outcome import Options, Report
from .run import known_report, lint_file

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

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
    wanted = jobs or (cores() if len(paths) >= WORTH_IT else 1)
    workers = min(wanted, len(paths))
    if workers <= 1 or "-" in paths:
        for path in paths:
            yield lint_file(path, options)
        return
    yield lint_file(paths[0], options)  # imports the rules, which forked workers then have
    yield from _together(paths[1:], options, workers)


def _together(paths: Sequence[str], options: Options, workers: int) -> Iterator[Report]:
    """Each worker takes every so-many-th description; their reports come in the order of paths.

    A pool of multiprocessing takes a tenth of a second to end, which is a third of the work.
    """
    import multiprocessing

    method = "fork" if "fork" in multiprocessing.get_all_start_methods() else "spawn"
    context = multiprocessing.get_context(method)
    receivers, processes = [], []
    try:
        for number in range(workers):
            receiver, sender = context.Pipe(duplex=False)
            process = context.Process(  # type: ignore[attr-defined]
                target=_work, args=(paths[number::workers], options, sender), daemon=True
            )
            process.start()
            sender.close()
            receivers.append(receiver)
            processes.append(process)
        for number in range(len(paths)):
            result = receivers[number % workers].recv()
            if isinstance(result, Exception):
                raise result
            yield result
    finally:
        for process in processes:
            process.terminate()


def _work(paths: Sequence[str], options: Options, sender: Connection) -> None:
    """Send a report for each description, or what kept it from being made."""
    ignore_interrupts()
    for path in paths:
        try:
            sender.send(lint_file(path, options))
        except Exception as error:
            sender.send(error)
