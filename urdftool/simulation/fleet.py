"""Simulate many robots, each in a separate process, so that a crash does not affect others."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING

from ..cluster import map_anywhere
from ..errors import UrdftoolError
from ..parallel import Loss, count_cores, make_plain_error
from .fault import Fault

if TYPE_CHECKING:
    from .verdict import Verdict

PATIENCE = 120.0
"""Time limit for reading and judging a robot, in addition to its simulation [s]. Chosen, no source.
"""


@dataclass
class Row:
    """Result of one robot.

    Attributes:
        path: Path of the description.
        name: Name of the robot.
        stands: Whether it stands in every trial and engine; None if it could not be simulated.
        passes: Whether it has no error in any trial and engine; None if it was not simulated.
        settled: Time at which it came to rest in the first trial [s]; None if it did not.
        mass: Mass of the robot [kg].
        faults: Faults and remarks of all trials, each once.
        error: Error that prevented the simulation.
        skipped: Reason why the robot was skipped; empty if it was not.
        engine: Titles and versions of the engines.
        seconds: Wall-clock time [s].
        notes: Lines that were to be printed, by the process that simulated it.
    """

    path: str
    name: str = ""
    stands: bool | None = None
    passes: bool | None = None
    settled: float | None = None
    mass: float | None = None
    faults: list[Fault] = field(default_factory=list)
    error: UrdftoolError | None = None
    skipped: str = ""
    engine: str = ""
    seconds: float = 0.0
    notes: list[str] = field(default_factory=list)

    @property
    def fell(self) -> bool:
        """Tell whether the robot does not stand; other errors are in its file."""
        return any(fault.fell for fault in self.faults)


def make_row(path: str, name: str, verdicts: Sequence[Verdict], more: Sequence[Fault] = ()) -> Row:
    """Make the row of a simulated robot."""
    faults: dict[tuple[str, str], Fault] = {}
    for fault in (*(fault for verdict in verdicts for fault in verdict.faults), *more):
        known = faults.get((fault.code, fault.name))
        if known is None or fault.severity > known.severity:
            faults[fault.code, fault.name] = fault
    engines = dict.fromkeys(verdict.run.recording.engine for verdict in verdicts)
    return Row(
        path,
        name,
        not any(fault.fell for fault in faults.values()),
        not any(fault.fails for fault in faults.values()),
        verdicts[0].rest.settled,
        verdicts[0].run.bodies.mass,
        sorted(faults.values(), key=lambda fault: fault.severity, reverse=True),
        engine=", ".join(engines),
        seconds=sum(verdict.run.recording.seconds for verdict in verdicts),
    )


def run_in_parallel(
    paths: Sequence[str],
    work: Callable[[str, list[str]], Row],
    *,
    jobs: int | None = None,
    limit: float = PATIENCE,
    scheduler: str | None = None,
) -> Iterator[Row]:
    """Yield a row for each description, in the order in which they finish.

    ``work`` makes a row and adds lines to print to a list; the limit is in s.
    """

    def lost(path: str, loss: Loss) -> Row:
        message = f"the worker process of this robot crashed ({loss.describe()})"
        if loss.timed_out:
            message = f"was stopped after the time limit of {limit:.0f} s"
        return Row(path, error=UrdftoolError(message, path=path))

    began: dict[str, float] = {}

    def note_begin(_: int, running: Sequence[str]) -> None:
        for path in running:
            began.setdefault(path, perf_counter())

    for index, row in map_anywhere(
        partial(_make_row, work),
        paths,
        workers=jobs or count_cores(),
        scheduler=scheduler,
        preload=("urdftool.simulation.verdict",),
        on_lost=lost,
        on_progress=note_begin,
        time_limit=limit,
        tries=1,
        isolate=True,
    ):
        row.seconds = perf_counter() - began[paths[index]]
        yield row


def _make_row(work: Callable[[str, list[str]], Row], path: str) -> Row:
    """Make the row of a robot, with the lines to print."""
    notes: list[str] = []
    row = _try_row(work, path, notes)
    row.notes = notes
    return row


def _try_row(work: Callable[[str, list[str]], Row], path: str, notes: list[str]) -> Row:
    """Make the row of a robot; an exception becomes its error."""
    try:
        return work(path, notes)
    except UrdftoolError as error:
        return Row(path, error=make_plain_error(error))
    except (OSError, MemoryError) as error:
        what = getattr(error, "strerror", None) or str(error) or "not enough memory"
        return Row(path, error=UrdftoolError(what, path=path))
    except (Exception, RecursionError) as error:
        what = f"this is a bug in urdftool, not in the robot: {type(error).__name__}: {error}"
        return Row(path, error=UrdftoolError(what, path=path))
