"""Processor time of the checking process from a change to its findings, and its memory."""

from __future__ import annotations

import gc
import json
import os
import re
import resource
import statistics
import subprocess
import sys
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

from urdftool.server.session import Session

from .robots import CORPUS, LARGEST, find_packages

EDITS = 1000
"""Edits of each robot; source: the goal is that of 1,000."""
WARM = 10
"""Edits that are not counted: imports, meshes and packages."""
_PAUSE = 0.05
"""Time [s] between a check and the next edit; source: the server waits as long for a next key."""
_NUMBER = re.compile(r"(?<=[\"\s])(\d+\.\d*[1-9])(?=[\"\s])")


@dataclass
class Changes:
    """Times of one robot.

    Attributes:
        robot: Name of its file.
        first: Processor time [s] of each edit until the first part.
        whole: Processor time [s] of each edit until its findings.
        memory: Memory [MiB] that is resident after a number of edits.
        between: Processor time [s] for the next expansion before each edit.
    """

    robot: str
    first: list[float] = field(default_factory=list)
    whole: list[float] = field(default_factory=list)
    memory: dict[int, float] = field(default_factory=dict)
    between: list[float] = field(default_factory=list)

    @property
    def p95(self) -> float:
        """Return the time [s] that 95 % of edits keep."""
        return statistics.quantiles(self.whole, n=20)[-1]

    @property
    def first_p95(self) -> float:
        """Return the time [s] until the first part that 95 % of edits keep."""
        return statistics.quantiles(self.first, n=20)[-1]

    @property
    def median(self) -> float:
        """Return the median time [s]."""
        return statistics.median(self.whole)

    @property
    def least(self) -> float:
        """Return the least time [s], which is near an idle machine."""
        return min(self.whole)


def measure_changes(edits: int = EDITS) -> list[Changes]:
    """Change a number of each robot again and again, in a process for each."""
    found = []
    for place in LARGEST:
        command = [sys.executable, "-m", __name__, place, str(edits)]
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE)
        values = json.loads(done.stdout)
        values["memory"] = {int(count): size for count, size in values["memory"].items()}
        found.append(Changes(**values))
    return found


def measure_robot(path: Path, edits: int) -> Changes:
    """Change one number of a file, and check its robot after each change."""
    gc.disable()  # as the checking process does
    session = Session()
    folder = CORPUS / path.relative_to(CORPUS).parts[0]
    session.knowledge.configure(
        "utf-16", [str(folder)], find_packages(), [str(CORPUS)], (), None, ()
    )
    result, server = Changes(path.name), session.knowledge.expansion_server
    text = path.read_text("utf-8")
    place = find_number(text)
    for count in range(1, edits + 1):
        changed = f"{text[:place]}{count % 10}{text[place + 1 :]}"
        before = server.prepared
        first, whole = _check(session, str(path), changed)
        between = server.prepared - before
        session.prepare()
        gc.collect()
        time.sleep(_PAUSE)
        if count > WARM:
            result.first.append(first)
            result.whole.append(whole)
            result.between.append(between)
        if count in (100, 1000):
            result.memory[count] = measure_memory()
    server.close()
    return result


def find_number(text: str) -> int:
    """Return the place of the last digit of a number in the middle of a file."""
    found = [match.end() - 1 for match in _NUMBER.finditer(text)]
    found = found or [match.start() for match in re.finditer(r"\d(?=[\s\"])", text)]
    return min(found, key=lambda place: abs(place - len(text) // 2))


def _check(session: Session, path: str, text: str) -> tuple[float, float]:
    """Return the processor time [s] until the first rule, and until the findings."""
    reached: list[float] = []

    def measure() -> float:
        return _get_time() + session.knowledge.expansion_server.used

    def poll() -> None:
        if not reached:
            reached.append(measure())

    start = measure()
    session.set_document(path, text)
    session.compute_answer("check", {"paths": [path]}, lambda part: None, poll)
    end = measure()
    return (reached[0] if reached else end) - start, end - start


def _get_time() -> float:
    """Return the processor time [s] of this process and of those that it ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def measure_memory() -> float:
    """Return the resident memory of this process [MiB], without that of its children."""
    pages = int(Path("/proc/self/statm").read_text("ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


if __name__ == "__main__":
    print(json.dumps(asdict(measure_robot(CORPUS / sys.argv[1], int(sys.argv[2])))))
