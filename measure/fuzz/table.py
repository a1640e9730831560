"""What came of a run: a table by command, and its place in the documentation."""

from __future__ import annotations

import re
import resource
from collections import Counter, defaultdict
from datetime import date

from measure.benchmarks.robots import ROOT

from .commands import COMMANDS

PAGE = ROOT / "docs" / "measurements" / "robustness.md"
MARKED = re.compile(r"(<!-- fuzz begins -->\n).*?(<!-- fuzz ends -->)", re.DOTALL)


def table(outcomes):
    """By command: cases, exit codes, the slowest, problems; as Markdown."""
    by_command = defaultdict(list)
    for outcome in outcomes:
        by_command[outcome.command].append(outcome)
    yield "| command | cases | exit 0 | 1 | 2 | other | median s | slowest s | problems |"
    yield "|---|---:|---:|---:|---:|---:|---:|---:|---:|"
    for name in COMMANDS:
        found = by_command[name]
        if found:
            yield _row(f"`{name}`", found)
    yield _row("all", outcomes)


def _row(name, found):
    codes = Counter(outcome.code for outcome in found)
    times = sorted(outcome.seconds for outcome in found)
    other = len(found) - codes[0] - codes[1] - codes[2]
    problems = sum(bool(outcome.problems) for outcome in found)
    return (
        f"| {name} | {len(found)} | {codes[0]} | {codes[1]} | {codes[2]} | {other} | "
        f"{times[len(times) // 2]:.2f} | {times[-1]:.1f} | {problems} |"
    )


def write(outcomes, seed, robots):
    """Put the table of a run where the documentation has it."""
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
    minutes = sum(outcome.seconds for outcome in outcomes) / 60
    bad = sum(bool(outcome.problems) for outcome in outcomes)
    lines = [
        f"{len(outcomes)} cases of seed {seed}, from {robots} files, on "
        f"{date.today().isoformat()}; the commands took {minutes:.0f} minutes, and the largest "
        f"process {memory} MB. Cases with a problem: {bad}.",
        "",
        *table(outcomes),
    ]
    text = PAGE.read_text("utf-8")
    inner = "\n".join(lines) + "\n"
    PAGE.write_text(MARKED.sub(lambda m: m[1] + inner + m[2], text), "utf-8")
