"""The page of the measurements."""

from __future__ import annotations

import statistics
from pathlib import Path

from .changes import Changes
from .definitions import Definitions, Tally

PAGE = Path(__file__).parents[2] / "docs" / "measurements" / "server.md"
KINDS = ("macro", "property", "parameter", "argument")


def write_page(parts: dict[str, list[str]]) -> None:
    """Write tables between their marks."""
    for name, lines in parts.items():
        begin, end = (f"<!-- {name} {word} -->" for word in ("begin", "end"))
        before, _, rest = PAGE.read_text("utf-8").partition(begin)
        after = rest.partition(end)[2]
        PAGE.write_text(f"{before}{begin}\n{chr(10).join(lines)}\n{end}{after}", "utf-8")


def format_definitions(found: Definitions) -> list[str]:
    """Return the lines of the table of definitions."""
    lines = [
        f"{found.robots} robots with their arguments were expanded, {found.failed} were not. "
        f"{sum(found.without_text.values())} uses are not counted: their name is not written in "
        "the element that asks.",
        "",
        "| uses | " + " | ".join(KINDS) + " | all | wrong | without an answer |",
        "|---|" + "---|" * (len(KINDS) + 3),
    ]
    rows = {
        "recorded, server": found.recorded,
        "hidden, server": found.hidden,
        "recorded, server without its record": found.text,
        "recorded, rde-urdf's way": found.peer,
    }
    return [*lines, *(_format_row(name, tallies) for name, tallies in rows.items())]


def _format_row(name: str, tallies: dict[str, Tally]) -> str:
    cells = [_format_share(tallies.get(kind, Tally())) for kind in KINDS]
    whole = Tally()
    for one in tallies.values():
        whole.right += one.right
        whole.wrong += one.wrong
        whole.nothing += one.nothing
    cells += [_format_share(whole), str(whole.wrong), str(whole.nothing)]
    return f"| {name} | {' | '.join(cells)} |"


def _format_share(tally: Tally) -> str:
    if not tally.total:
        return "none"
    return f"{tally.right} of {tally.total} ({100 * tally.right / tally.total:.1f} %)"


def format_changes(found: list[Changes]) -> list[str]:
    """Return the lines of the table of times."""
    lines = [
        "| robot | first part, p95 [ms] | findings, p95 [ms] | median [ms] | least [ms] | "
        "before the edit, median [ms] | memory after 100 edits [MiB] | after 1,000 |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for one in found:
        memory = [
            f"{one.memory[count]:.1f}" if count in one.memory else "" for count in (100, 1000)
        ]
        times = [one.first_p95, one.p95, one.median, one.least, statistics.median(one.between)]
        cells = [one.robot, *(f"{1000 * time:.0f}" for time in times), *memory]
        lines.append("| " + " | ".join(cells) + " |")
    return lines
