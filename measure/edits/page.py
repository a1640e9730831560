"""The page of the measurements."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from .run import Results

PAGE = Path(__file__).parents[2] / "docs" / "measurements" / "edits.md"


def write_page(results: Results, *, is_written: bool) -> str:
    """Return the tables, and write them between the marks of the page if asked."""
    parts = {"operations": list_lines(results) if results.read else [], "peer": results.peer}
    for name, lines in parts.items():
        if is_written and lines:
            begin, end = (f"<!-- {name} {word} -->" for word in ("begin", "end"))
            before, _, rest = PAGE.read_text("utf-8").partition(begin)
            after = rest.partition(end)[2]
            PAGE.write_text(f"{before}{begin}\n{chr(10).join(lines)}\n{end}{after}", "utf-8")
    return "\n".join(line for lines in parts.values() for line in lines)


def list_lines(results: Results) -> list[str]:
    """Return the lines of the tables."""
    lines = [
        f"{results.read} robots; {results.unread} other files are not read by urdftool or "
        f"Pinocchio. {_list_versions()}",
        "",
        "| operation | made | refused | different | poses | mass and inertia | mass matrix |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, row in results.rows.items():
        is_part, is_root = name in ("attach", "cut"), name.startswith("root")
        inertia = "" if is_part else f"{row.worst[1]:.1e}"
        matrix = "" if is_part or is_root else f"{row.worst[2]:.1e}"
        counts = f"{row.made} | {len(row.refused)} | {len(row.different)}"
        lines.append(f"| {name} | {counts} | {row.worst[0]:.1e} | {inertia} | {matrix} |")
    lines += _list_back(results)
    if results.planted:
        total = sum(results.planted.values())
        lines += [
            "",
            f"Of {total} mistakes planted in results, `verify --map` found "
            f"{total - len(results.missed)}.",
        ]
    return [*lines, *_list_others(results)]


def _list_back(results: Results) -> list[str]:
    rows = {
        name: row
        for name, row in results.rows.items()
        if row.bytes_back or row.numbers_back or row.other_back
    }
    return [
        "",
        "| there and back | every byte | numbers within 1e-12 | other |",
        "|---|---|---|---|",
        *(
            f"| {name} | {row.bytes_back} | {row.numbers_back} | {len(row.other_back)} |"
            for name, row in rows.items()
        ),
    ]


def _list_others(results: Results) -> list[str]:
    """Return what was refused, differs, or is beyond the bounds."""
    found: list[str] = []
    for name, row in results.rows.items():
        for what, texts in (
            ("refused", row.refused),
            ("different, not written", row.different),
            ("beyond the bounds", row.beyond),
            ("other on the way back", row.other_back),
        ):
            found += [f"- {name}, {what}: {text}" for text in texts]
    found += [f"- not found: {text}" for text in results.missed]
    return ["", *found] if found else []


def _list_versions() -> str:
    names = {"pin": "Pinocchio", "example-robot-data": "example-robot-data", "pybullet": "PyBullet"}
    found = []
    for package, name in names.items():
        try:
            found.append(f"{name} {version(package)}")
        except PackageNotFoundError:
            continue
    return f"Versions: {', '.join(found)}."
