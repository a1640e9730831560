"""Tables of the measurements in docs/commands/verify.md."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

from .planted import PAIRS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "commands" / "verify.md"


def replace_block(name: str, lines: list[str]) -> None:
    """Replace the lines between two comments of the page."""
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    text = PAGE.read_text("utf-8")
    head, tail = text.partition(begin)[0], text.partition(end)[2]
    PAGE.write_text(f"{head}{begin}\n" + "\n".join(lines) + f"\n{end}{tail}", "utf-8")


def _make_table(head: tuple[str, ...], rows: list[tuple[object, ...]]) -> list[str]:
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    return [*lines, *(f"| {' | '.join(map(str, row))} |" for row in rows)]


def format_planted(paths: list[Path]) -> list[str]:
    """Return the tables of planted differences, by pair of formats and by kind."""
    records = [json.loads(line) for path in paths for line in path.read_text("utf-8").splitlines()]
    planted = [r for r in records if "kind" in r and not r["error"]]
    equal = [r for r in records if "formats" in r]
    rows: list[tuple[object, ...]] = []
    for pair in PAIRS:
        of_pair = [r for r in planted if {r["changed"], r["other"]} == set(pair)]
        unchanged = [r for r in equal if tuple(r["formats"]) == pair]
        rows.append(("–".join(map(str.upper, pair)), *_count(of_pair), *_count_equal(unchanged)))
    rows.append(("all", *_count(planted), *_count_equal(equal)))
    head = ("formats", "changes", "found", "at their part only", "unchanged", "equal",
            "reported by the export", "unexpected")  # fmt: skip
    lines = [*_make_table(head, rows), ""]
    kinds = Counter(r["kind"] for r in planted)
    head = ("change", "changes", "found", "at their part only")
    rows = [(kind, *_count([r for r in planted if r["kind"] == kind])) for kind in sorted(kinds)]
    return [*lines, *_make_table(head, rows)]


def _count(records: list[dict[str, Any]]) -> tuple[int, int, int]:
    found = [r for r in records if r["at_its_part"]]
    return len(records), len(found), sum(not r["elsewhere"] for r in found)


def _count_equal(records: list[dict[str, Any]]) -> tuple[int, int, int, int]:
    invented = [r for r in records if r["invented"]]
    announced = [r for r in records if r["announced"] and not r["invented"]]
    same = len(records) - len(invented) - len(announced)
    return len(records), same, len(announced), len(invented)


def format_trips(trips: list[Any]) -> list[str]:
    """Return the table of round trips, by row."""
    from urdftool.compare.rows import ROWS

    lines: list[str] = []
    for through in sorted({trip.through for trip in trips}, reverse=True):
        chosen = [trip for trip in trips if trip.through == through]
        rows: list[tuple[object, ...]] = []
        for row in ROWS:
            codes = Counter(code for t in chosen for code in t.announced.get(row.name, ()))
            announced = sum(row.name in t.announced and row.name not in t.differing for t in chosen)
            different = [t.name for t in chosen if row.name in t.differing]
            equal = len(chosen) - announced - len(different)
            why = ", ".join(f"`{code}` {count}" for code, count in codes.most_common())
            rows.append((row.name, equal, announced, why, ", ".join(different) or "0"))
        title = f"URDF → {through.upper()} → URDF"
        head = (title, "equal", "reported", "reasons (robots)", "different")
        lines += [*_make_table(head, rows), ""]
    return lines[:-1]
