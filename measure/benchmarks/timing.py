"""Time commands in turn, each in a process of its own, with its peak of memory."""

from __future__ import annotations

import json
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

PYTHON = sys.executable
URDFTOOL = [str(Path(PYTHON).parent / "urdftool")]
CLOCK = Path(__file__).with_name("clock.py")
MEGABYTE = 1024 * 1024


@dataclass(frozen=True)
class Taken:
    """What one run of a command took.

    Attributes:
        seconds: From its start to its end, or what it says itself: see ``command``.
        peak: Memory [bytes] of its largest process.
        why: Why it failed; empty where it did not.
        out: The end of what it printed.
    """

    seconds: float
    peak: int
    why: str = ""
    out: str = ""


Call = Callable[[], Taken]


def command(
    words: Sequence[str | Path],
    *,
    env: Mapping[str, str] | None = None,
    cwd: str | Path | None = None,
    codes: Sequence[int] = (0, 1),
    limit: float = 300.0,
    own: bool = False,
) -> Call:
    """A call that runs a command; whatever happens is in what it gives.

    Python's bytecode cache is on, as it is for whoever has installed both sides.

    Args:
        words: The command.
        env: Its environment.
        cwd: Its folder.
        codes: Exit codes that are no failure; 1 is a linter's finding.
        limit: Seconds after which it is stopped.
        own: It prints ``SECONDS n`` itself, for the work without start and imports.
    """
    chosen = dict(os.environ if env is None else env)
    chosen.pop("PYTHONDONTWRITEBYTECODE", None)
    whole = [PYTHON, "-I", "-S", str(CLOCK), str(limit), *map(str, words)]

    def call() -> Taken:
        done = subprocess.run(whole, capture_output=True, env=chosen, cwd=cwd, check=True)
        found = json.loads(done.stdout)
        seconds, why = found["seconds"], ""
        if found["code"] is None:
            why = f"stopped after {limit:.0f} s"
        elif found["code"] not in codes:
            why = reason(found["err"] or found["out"], found["code"])
        elif own:
            match = re.search(r"^SECONDS (\S+)$", found["out"], re.MULTILINE)
            seconds, why = (float(match[1]), "") if match else (seconds, "said no time")
        return Taken(seconds, found["peak"], why, found["out"])

    return call


def each(calls: Sequence[Call]) -> Call:
    """A call of several commands, one after the other: their seconds together."""

    def call() -> Taken:
        runs = [call() for call in calls]
        why = next((run.why for run in runs if run.why), "")
        return Taken(sum(run.seconds for run in runs), max(run.peak for run in runs), why)

    return call


def reason(text: str, code: int) -> str:
    """The line of an output that says why a command failed."""
    if code < 0:
        return f"ended by signal {-code}"
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    telling = [line for line in lines if re.search(r"error|exception", line, re.IGNORECASE)]
    chosen = (telling or lines or [f"exit code {code}"])[-1]
    return re.sub(r"(?<![\w<])/(?:[^\s'\"/]+/)+", "", chosen)[:160]


def in_turn(
    sides: Mapping[str, Call], rounds: int = 9, budget: float = 20.0, label: str = ""
) -> dict[str, Taken]:
    """The medians of each side, all sides once in each round.

    Args:
        sides: The calls.
        rounds: How often, at most.
        budget: Seconds after which no further round begins; one is always run.
        label: What is said of it at the terminal.
    """
    if label:
        print(f"  … {label}", file=sys.stderr, flush=True)
    begin = time.perf_counter()
    first = {name: call() for name, call in sides.items()}  # warms the file system's caches
    if time.perf_counter() - begin > budget:
        return first
    runs: dict[str, list[Taken]] = {name: [] for name in sides}
    for _ in range(rounds):
        round_begin = time.perf_counter()
        for name, call in sides.items():
            runs[name].append(first[name] if first[name].why else call())
        now = time.perf_counter()
        if now - begin + (now - round_begin) > budget:
            break
    return {name: _median(taken) for name, taken in runs.items()}


def _median(runs: Sequence[Taken]) -> Taken:
    failed = next((run for run in runs if run.why), None)
    return failed or Taken(
        statistics.median(run.seconds for run in runs),
        int(statistics.median(run.peak for run in runs)),
        out=runs[-1].out,
    )
