"""Many robots, each in a process of its own, so that a crash of one does not affect others."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING

from ..errors import UrdftoolError
from ..parallel import Loss, count_cores, make_plain_error, map_tasks
from .fault import Fault

if TYPE_CHECKING:
    from .verdict import Verdict

PATIENCE = 120.0
"""What reading and judging a robot may take beside its simulation [s]."""


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
        """Tell whether it does not stand in the plain sense; an error in its file is not that."""
        return any(fault.fell for fault in self.faults)


def make_row(path: str, name: str, verdicts: Sequence[Verdict], more: Sequence[Fault] = ()) -> Row:
    """Make the row of a robot that was judged.

    Args:
        path: Of its description.
        name: Its own.
        verdicts: Of each trial, in each engine; at least one.
        more: Further faults.
    """
    faults: dict[tuple[str, str], Fault] = {}
    for fault in (*(fault for verdict in verdicts for fault in verdict.faults), *more):
        known = faults.get((fault.code, fault.name))
        if known is None or (fault.fails and not known.fails):
            faults[fault.code, fault.name] = fault
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


def run_in_parallel(
    paths: Sequence[str],
    work: Callable[[str], Row],
    *,
    jobs: int | None = None,
    limit: float = PATIENCE,
) -> Iterator[Row]:
    """Yield a row for each description, as they are done.

    Args:
        paths: The descriptions.
        work: Makes a row; it must pickle where processes are not forked.
        jobs: How many at once; None is one for each core.
        limit: The longest that one may take [s].
    """

    def lost(path: str, loss: Loss) -> Row:
        message = f"the process that worked on it died (exit code {loss.exit_code})"
        if loss.timed_out:
            message = f"was not done after {limit:.0f} s and was ended"
        return Row(path, error=UrdftoolError(message, path=path))

    began: dict[str, float] = {}

    def note_begin(_: int, running: Sequence[str]) -> None:
        for path in running:
            began.setdefault(path, perf_counter())

    for index, row in map_tasks(
        partial(_make_row, work),
        paths,
        workers=jobs or count_cores(),
        on_lost=lost,
        on_progress=note_begin,
        time_limit=limit,
        tries=1,
        isolate=True,
    ):
        row.seconds = perf_counter() - began[paths[index]]
        yield row


def _make_row(work: Callable[[str], Row], path: str) -> Row:
    """Make the row of a robot, also if that fails."""
    try:
        return work(path)
    except UrdftoolError as error:
        return Row(path, error=make_plain_error(error))
    except (OSError, MemoryError) as error:
        what = getattr(error, "strerror", None) or str(error) or "there is not enough memory"
        return Row(path, error=UrdftoolError(what, path=path))
    except (Exception, RecursionError) as error:
        what = f"this is a bug in urdftool, not in the robot: {type(error).__name__}: {error}"
        return Row(path, error=UrdftoolError(what, path=path))
