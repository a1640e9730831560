"""Format results for many robots as a table, JSON, or JUnit XML with a case for each robot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ..control_characters import escape_controls
from .json_text import format_json
from .simulate import _build_fault
from .tables import Cell, render_table

if TYPE_CHECKING:
    from ..simulation.fault import Fault
    from ..simulation.fleet import Row


def format_table(rows: Sequence[Row], *, colors: bool = False, skipped: bool = False) -> str:
    """Format a line for each robot: whether it stands, when it settled, and its faults."""
    lines: list[Sequence[Cell]] = []
    for row in rows:
        if skipped or not row.skipped:
            rest = "" if row.settled is None else f"{row.settled:.2f} s"
            lines.append((row.path, _get_verdict_word(row), rest, _format_what(row)))
    return f"{render_table(lines, left=(0, 1, 3), colors=colors)}{summarize(rows)}\n"


def summarize(rows: Sequence[Row]) -> str:
    """Summarize the number of robots with each result."""
    counts = {
        "stand": sum(row.stands is True and row.passes is True for row in rows),
        "stand with model errors": sum(row.stands is True and not row.passes for row in rows),
        "do not stand": sum(row.stands is False for row in rows),
        "could not be simulated": sum(row.error is not None for row in rows),
        "skipped": sum(bool(row.skipped) for row in rows),
    }
    words = ", ".join(f"{count} {what}" for what, count in counts.items() if count)
    unread = sum(any(fault.is_gap for fault in row.faults) for row in rows)
    gaps = f"; {unread} of them with visuals that were not read" if unread else ""
    return f"{len(rows)} robot{'s' * (len(rows) != 1)}: {words or 'none'}{gaps}"


def _get_verdict_word(row: Row) -> tuple[str, str]:
    if row.error is not None:
        return "error", "red"
    if row.skipped:
        return "skipped", "yellow"
    if row.passes:
        return "stands", "green"
    return ("model errors" if row.stands else "does not stand"), "red"


def _format_what(row: Row) -> str:
    if row.error is not None:
        own = row.error.path == row.path and row.error.line is not None
        place = f"{row.error.line}:{row.error.column}: " if own else ""
        return escape_controls(
            place + row.error.message if own or not row.error.path else str(row.error)
        )
    if row.skipped:
        return escape_controls(row.skipped)
    kinds: dict[str, list[str]] = {}
    for fault in row.faults:
        if fault.fails or fault.is_gap or (fault.is_warning and row.passes):
            kinds.setdefault(fault.code, []).append(fault.name)
    return ", ".join(
        f"{kind} ({escape_controls(names[0])}{', …' if len(names) > 1 else ''})"
        if names[0]
        else kind
        for kind, names in kinds.items()
    )


def to_json(rows: Sequence[Row], *, timings: bool = False) -> str:
    """Format the results without time series as JSON; ``timings`` adds the wall-clock times."""
    document = {"version": 1, "stands": all(row.stands for row in rows if not row.skipped),
            "passes": all(row.passes for row in rows if not row.skipped),
            "robots": [_build_row(row, timings) for row in rows]}  # fmt: skip
    return format_json(document, 1) + "\n"


def _build_row(row: Row, timings: bool) -> dict[str, Any]:
    error = row.error
    return {
        "path": row.path,
        "name": row.name,
        "stands": row.stands,
        "passes": row.passes,
        "settled": row.settled,
        "mass": row.mass,
        "engine": row.engine or None,
        "faults": [_build_fault(fault) for fault in row.faults],
        "error": None
        if error is None
        else {
            "message": error.message,
            "path": error.path,
            "line": error.line,
            "column": error.column,
        },
        "skipped": row.skipped or None,
        **({"seconds": round(row.seconds, 3)} if timings else {}),
    }


def to_junit(rows: Sequence[Row]) -> str:
    """Format a suite with a case for each robot; remarks are the output of its case."""
    root = Element("testsuites", name="urdftool simulate")
    suite = SubElement(root, "testsuite", name="urdftool simulate")
    for row in rows:
        case = SubElement(
            suite,
            "testcase",
            classname=escape_controls(row.path),
            name=escape_controls(row.name) or "simulate",
            time=f"{row.seconds:.3f}",
        )
        _add_findings(case, row)
    for count, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(count, str(len(suite.findall(f"testcase/{tag}"))))
    suite.set("tests", str(len(rows)))
    suite.set("time", f"{sum(row.seconds for row in rows):.3f}")
    for count in ("tests", "failures", "errors"):
        root.set(count, suite.get(count, "0"))
    indent(root, " ")
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _add_findings(case: Element, row: Row) -> None:
    if row.error is not None:
        error = SubElement(
            case, "error", type="not simulated", message=escape_controls(row.error.message)
        )
        error.text = "\n".join(escape_controls(line) for line in (str(row.error), *row.error.notes))
        return
    if row.skipped:
        SubElement(case, "skipped", message=escape_controls(row.skipped))
        return
    wrong = [fault for fault in row.faults if fault.fails]
    remarks = [fault for fault in row.faults if not fault.fails]
    if wrong:
        kinds = ", ".join(dict.fromkeys(fault.code for fault in wrong))
        failure = SubElement(case, "failure", type=kinds, message=escape_controls(wrong[0].message))
        failure.text = "\n".join(line for fault in wrong for line in _format_lines(fault))
    if remarks:
        out = SubElement(case, "system-out")
        out.text = "\n".join(line for fault in remarks for line in _format_lines(fault))


def _format_lines(fault: Fault) -> Iterator[str]:
    place = "" if fault.location is None else f"{escape_controls(str(fault.location))}: "
    yield f"{place}{escape_controls(fault.message)} [{fault.code}]"
    if fault.cause:
        yield f"  {escape_controls(fault.cause)}"
    if fault.rule:
        yield f"  urdftool lint --explain {fault.rule}"
