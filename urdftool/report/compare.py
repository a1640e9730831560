"""Differences between two robots, as text, Markdown and JSON (``docs/schemas/diff.json``)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import Any

from ..compare.difference import EXISTENCE, THERE, Difference
from ..compare.uncompared import Uncompared
from ..control_characters import escape_controls
from .counted import format_count
from .findings import Painter
from .json_text import format_json

_COLORS = {"added": "green", "removed": "red"}


def format_text(changes: Iterable[Difference], *, colors: bool = False) -> str:
    """Format each changed part with its changes."""
    paint = Painter(colors)
    lines = []
    for title, group in _list_by_part(changes):
        lines.append(paint(title, bold=True))
        for change in group:
            before, after = _format_values(change)
            what = describe_what(change)
            color = _COLORS.get(what.rpartition(" ")[2], "yellow")
            what = paint(escape_controls(what), color)
            lines.append(f"  {what}{_format_change(change, before, after)}")
    return "".join(f"{line}\n" for line in lines)


def _format_change(change: Difference, before: str, after: str) -> str:
    remark = f" ({change.note})" if change.note else ""
    unit = f" {change.unit}" if change.unit else ""
    if before and after:
        return f": {before} → {after}{unit}{remark}"
    if _is_presence(change):
        return f": {before or after}{unit}" if before or after else ""
    sides = (f"{side}{unit}" if side else "none" for side in (before, after))
    return f": {' → '.join(sides)}{remark}"


def _is_presence(change: Difference) -> bool:
    return describe_what(change).rpartition(" ")[2] in _COLORS


def describe_what(change: Difference) -> str:
    """Return the property; ``added`` or ``removed`` for a part that only one robot has."""
    if change.what != EXISTENCE:
        return change.what
    return "added" if change.values[0] is None else "removed"


def format_markdown(
    names: tuple[str, str], changes: Sequence[Difference], unread: Sequence[Uncompared] = ()
) -> str:
    """Format the changes as a Markdown table for a pull request."""
    lines = [f"**{_escape_cell(summarize(names, changes, unread))}**"]
    if changes:
        lines += ["", "| part | what | before | after | |", "|---|---|---|---|---|"]
    for title, group in _list_by_part(changes):
        for change in group:
            before, after = _format_values(change)
            unit = f" {change.unit}" if change.unit else ""
            cells = (
                title,
                describe_what(change),
                *(v and v + unit for v in (before, after)),
                change.note,
            )
            lines.append(f"| {' | '.join(map(_escape_cell, cells))} |")
    return "".join(f"{line}\n" for line in lines)


def _escape_cell(text: str) -> str:
    """Escape a text for a Markdown table."""
    marked = "".join(f"\\{c}" if c in "\\`*_{}[]<>#|~!@" else c for c in escape_controls(text))
    return marked.replace("&", "&amp;")


def to_json(
    names: tuple[str, str],
    changes: Sequence[Difference],
    tolerance: float,
    unread: Sequence[Uncompared] = (),
) -> str:
    """Format the changes as one object; lengths [m], angles [rad], masses [kg]."""
    content = {
        "version": 1,
        "before": names[0],
        "after": names[1],
        "tolerance": tolerance,
        "equal": not changes and not unread,
        "changes": [_record(change) for change in changes],
        "not_compared": [{"name": part.name, "reason": part.reason} for part in unread],
    }
    return format_json(content, 1) + "\n"


def _record(change: Difference) -> dict[str, Any]:
    record: dict[str, Any] = {"element": {"kind": change.kind, "name": change.new_name}}
    before, after = _get_values(change)
    record |= {"what": describe_what(change), "before": before, "after": after}
    record |= {"remark": change.note or None, "path": None, "line": None, "column": None}
    if change.place is not None:
        line, column = change.place.file.position(change.place.start)
        record |= {"path": change.place.path, "line": line, "column": column}
    return record


def summarize(
    names: tuple[str, str], changes: Sequence[Difference], unread: Sequence[Uncompared] = ()
) -> str:
    """Summarize the number of changes, and of parts that were not read, in one line."""
    pair = f"{escape_controls(names[0])} → {escape_controls(names[1])}"
    count = len({part.name for part in unread})
    rest = f"{format_count(count, 'part')} not compared" if count else ""
    if not changes:
        text = f"no differences in what was read; {rest}" if rest else "no differences"
        return f"{pair}: {text} (meshes by their names, not by content)"
    parts = {(change.kind, change.new_name) for change in changes}
    text = f"{format_count(len(changes), 'change')} in {format_count(len(parts), 'part')}"
    return f"{pair}: {text}" + (f"; {rest}" if rest else "")


def list_notes(unread: Iterable[Uncompared]) -> list[str]:
    """Return a line for each kind of parts that were not read, with their names."""
    found: dict[str, dict[str, None]] = {}
    for part in unread:
        found.setdefault(part.reason, {})[part.name] = None
    return [f"not compared: {', '.join(some)}: {reason}" for reason, some in found.items()]


def _list_by_part(changes: Iterable[Difference]) -> Iterator[tuple[str, Iterator[Difference]]]:
    ordered: dict[tuple[str, str], list[Difference]] = {}
    for change in changes:
        ordered.setdefault((change.kind, change.new_name), []).append(change)
    flat = (change for group in ordered.values() for change in group)
    for (kind, name), group in groupby(flat, key=lambda change: (change.kind, change.new_name)):
        yield f"{kind} '{escape_controls(name)}'" if name else kind, group


def _format_values(change: Difference) -> tuple[str, str]:
    """Format both values with six digits, or with as many as show what differs."""
    before, after = _get_values(change)
    for digits in (6, 10, 17):
        texts = _format_value(before, digits), _format_value(after, digits)
        if texts[0] != texts[1]:
            break
    return texts


def _get_values(change: Difference) -> tuple[Any, Any]:
    """Return both values; None for a part that is not described."""
    if not _is_presence(change):
        return change.values
    before, after = (None if value == THERE else value for value in change.values)
    return before, after


def _format_value(value: Any, digits: int) -> str:
    """Format a value with significant digits; empty for None."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    if isinstance(value, tuple | list):
        return " ".join(_format_value(part, digits) for part in value)
    if isinstance(value, dict):
        return _format_facts(value, digits)
    return escape_controls(str(value))


def _format_facts(facts: dict[str, Any], digits: int) -> str:
    """Format a pose, a shape, or the properties of a part."""
    if "rpy" in facts:
        turned = any(abs(angle) > 1e-12 for angle in facts["rpy"])
        rpy = " ".join(f"{math.degrees(angle):.{digits - 2}g}°" for angle in facts["rpy"])
        return f"xyz {_format_value(facts['xyz'], digits)}" + (f" rpy {rpy}" if turned else "")
    if "shape" in facts:
        rest = " ".join(f"{k} {_format_value(v, digits)}" for k, v in facts.items() if k != "shape")
        return f"{facts['shape'] or 'nothing'} {rest}".strip()
    return ", ".join(
        f"{key} {_format_value(v, digits)}" for key, v in facts.items() if v not in (None, "")
    )
