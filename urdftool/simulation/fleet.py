"""Many robots, each in a process of its own: what breaks one leaves the others alone."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import connection, get_all_start_methods, get_context, parent_process
from threading import Thread
from time import perf_counter
from typing import TYPE_CHECKING, Any

from ..errors import UrdftoolError
from ..workers import (
    cores,
    ignore_interrupts,
    leaving_when_told,
    signals_later,
    take_signals,
)
from .fault import Fault

if TYPE_CHECKING:
    from .verdict import Verdict

PATIENCE = 120.0
"""What reading and judging a robot may take beside its simulation [s]."""

_LEAVING = 3.0  # s: what a process may take to remove what is temporary


@dataclass
class Row:
    """What became of one robot.

    Attributes:
        path: Of its description.
        name: Its own.
        stands: Whether it does, in every trial and engine; None where it could not be tried.
        settled: When it came to rest in the first trial [s]; None where it did not.
        mass: [kg].
        faults: What went wrong and what is to be known, of all trials, each once.
        error: What kept it from being tried.
        skipped: Why it was passed over.
        engine: What it was simulated with.
        seconds: What all of it took [s].
    """

    path: str
    name: str = ""
    stands: bool | None = None
    settled: float | None = None
    mass: float | None = None
    faults: list[Fault] = field(default_factory=list)
    error: UrdftoolError | None = None
    skipped: str = ""
    engine: str = ""
    seconds: float = 0.0

    @property
    def fell(self) -> bool:
        """Whether it does not stand in the plain sense; an error in its file alone is not that."""
        return any(fault.fell for fault in self.faults)


def row_of(path: str, name: str, verdicts: Sequence[Verdict], more: Sequence[Fault] = ()) -> Row:
    """The row of a robot that was judged.

    Args:
        path: Of its description.
        name: Its own.
        verdicts: Of each trial, in each engine; at least one.
        more: Further faults.
    """
    faults: dict[tuple[str, str], Fault] = {}
    for fault in (*(fault for verdict in verdicts for fault in verdict.faults), *more):
        known = faults.get((fault.kind, fault.name))
        if known is None or (fault.fails and not known.fails):
            faults[fault.kind, fault.name] = fault
    engines = dict.fromkeys(verdict.run.recording.engine for verdict in verdicts)
    return Row(
        path,
        name,
        not any(fault.fails for fault in faults.values()),
        verdicts[0].rest.settled,
        verdicts[0].run.bodies.mass,
        sorted(faults.values(), key=lambda fault: not fault.fails),
        engine=", ".join(engines),
        seconds=sum(verdict.run.recording.seconds for verdict in verdicts),
    )


def in_parallel(
    paths: Sequence[str],
    work: Callable[[str], Row],
    *,
    jobs: int | None = None,
    limit: float = PATIENCE,
) -> Iterator[Row]:
    """A row for each description, as they are done.

    Args:
        paths: The descriptions.
        work: Makes a row; it must pickle where processes are not forked.
        jobs: How many at once; None is one for each core.
        limit: The longest that one may take [s].
    """
    methods = get_all_start_methods()
    context = get_context("fork" if "fork" in methods and sys.platform == "linux" else "spawn")
    waiting = list(reversed(paths))
    running: dict[Any, tuple[str, Any, float]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < (jobs or cores()):
                path = waiting.pop()
                receiver, sender = context.Pipe(duplex=False)
                process = context.Process(  # type: ignore[attr-defined]
                    target=_work, args=(work, path, sender), daemon=False
                )
                with signals_later():
                    process.start()
                sender.close()
                running[receiver] = (path, process, perf_counter())
            for ready in connection.wait(list(running), 0.5):
                path, process, began = running.pop(ready)
                row = _received(ready, process, path)
                row.seconds = perf_counter() - began
                yield row
            for receiver, (path, process, began) in list(running.items()):
                if perf_counter() - began > limit:
                    running.pop(receiver)
                    _end([process])
                    receiver.close()
                    message = f"was not done after {limit:.0f} s and was ended"
                    yield Row(path, error=UrdftoolError(message, path=path), seconds=limit)
    finally:
        _end([process for _, process, _ in running.values()])


def _end(processes: Sequence[Any]) -> None:
    """End processes: they are asked to, and killed where they do not hear it."""
    for process in processes:
        process.terminate()
    until = perf_counter() + _LEAVING
    for process in processes:
        process.join(max(0.0, until - perf_counter()))
        if process.is_alive():
            process.kill()
            process.join()


def _received(receiver: Any, process: Any, path: str) -> Row:
    try:
        row: Row = receiver.recv()
    except (EOFError, OSError):
        process.join()
        message = f"the process that worked on it died (exit code {process.exitcode})"
        row = Row(path, error=UrdftoolError(message, path=path))
    finally:
        receiver.close()
    process.join()
    return row


def _plain(error: UrdftoolError) -> UrdftoolError:
    """The same in a form that can be sent: its kind may not be made from its message."""
    return UrdftoolError(
        error.message,
        path=error.path,
        line=error.line,
        column=error.column,
        calls=error.calls,
        notes=error.notes,
        rule=error.rule,
    )


def _leave_with_parent() -> None:
    """Wait until the parent has ended, however it did, and ask this process to leave."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)


def _work(work: Callable[[str], Row], path: str, sender: Any) -> None:
    """Make one row and send it."""
    ignore_interrupts()
    with suppress(RuntimeError):  # there may be no more threads
        Thread(target=_leave_with_parent, daemon=True).start()
    with leaving_when_told():
        take_signals()
        row = _row(work, path)
        with suppress(BrokenPipeError):  # nobody waits for it any more
            sender.send(row)
        sender.close()


def _row(work: Callable[[str], Row], path: str) -> Row:
    """What became of one robot, whatever that is."""
    try:
        return work(path)
    except UrdftoolError as error:
        return Row(path, error=_plain(error))
    except (OSError, MemoryError) as error:
        what = getattr(error, "strerror", None) or str(error) or "there is not enough memory"
        return Row(path, error=UrdftoolError(what, path=path))
    except (Exception, RecursionError) as error:
        what = f"this is a bug in urdftool, not in the robot: {type(error).__name__}: {error}"
        return Row(path, error=UrdftoolError(what, path=path))
