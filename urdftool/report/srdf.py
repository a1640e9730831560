"""Report of verdicts on pairs of links: text and JSON."""

from __future__ import annotations

from typing import Any

from ..srdf.content import format_positions
from ..srdf.verdicts import ADJACENT, ALWAYS, CAN_TOUCH, DEFAULT, NEVER, OPEN, Verdict, Verdicts
from .counted import format_count
from .json_text import format_json

_ORDER = (ADJACENT, NEVER, ALWAYS, DEFAULT, CAN_TOUCH, OPEN)

_TITLES = {
    ADJACENT: "adjacent, disabled",
    NEVER: "never touch, proved, disabled",
    ALWAYS: "always touch, disabled",
    DEFAULT: "touch at the default pose, disabled as requested",
    CAN_TOUCH: "can touch, enabled",
    OPEN: "open, enabled",
}


def format_summary(verdicts: Verdicts) -> str:
    """Format the number of pairs of each kind in one line."""
    counts = verdicts.count()
    parts = [f"{counts[kind]} {_TITLES[kind]}" for kind in _ORDER if counts[kind]]
    return f"{format_count(len(verdicts.pairs), 'pair')}: {'; '.join(parts) or 'none'}"


def list_open(verdicts: Verdicts) -> list[str]:
    """List the pairs that are not decided, with the reason or the nearest distance."""
    return [
        f"open: '{v.link1}' and '{v.link2}'{_explain(v)}; the pair stays enabled"
        for v in verdicts.pairs
        if v.kind == OPEN
    ]


def list_problems(verdicts: Verdicts) -> list[str]:
    """List the links whose shape is not known."""
    return [
        f"link '{name}' is not compared: {problem}; its pairs stay enabled"
        for name, problem in verdicts.problems.items()
    ]


def format_table(verdicts: Verdicts) -> str:
    """Format all pairs, one in a line."""
    lines = []
    for verdict in verdicts.pairs:
        more = _explain(verdict)
        lines.append(f"{verdict.kind:<10} {verdict.link1}  {verdict.link2}{more}")
    return "\n".join([*lines, ""])


def _explain(verdict: Verdict) -> str:
    """Explain a verdict: witness pose, nearest distance or reason."""
    if verdict.kind == CAN_TOUCH:
        return f", at {format_positions(verdict.positions)}"
    if verdict.kind != OPEN:
        return ""
    if verdict.reason:
        return f", because {verdict.reason}"
    if verdict.distance is None:
        return f", after {verdict.boxes} boxes"
    where = format_positions(verdict.positions)
    return f", nearest {verdict.distance * 1000:.2f} mm at {where}"


def as_dict(verdicts: Verdicts) -> dict[str, Any]:
    """Return the verdicts as data of JSON."""
    return {
        "version": 1,
        "summary": {kind: verdicts.count()[kind] for kind in _ORDER},
        "ranges": {name: list(bounds) for name, bounds in verdicts.ranges.items()},
        "problems": dict(verdicts.problems),
        "pairs": [_as_dict(verdict) for verdict in verdicts.pairs],
    }


def _as_dict(verdict: Verdict) -> dict[str, Any]:
    return {
        "links": [verdict.link1, verdict.link2],
        "verdict": verdict.kind,
        "positions": {name: round(value, 6) for name, value in verdict.positions.items()},
        "distance": None if verdict.distance is None else round(verdict.distance, 6),
        "boxes": verdict.boxes,
        "reason": verdict.reason,
    }


def to_json(verdicts: Verdicts) -> str:
    """Return the verdicts as JSON."""
    return format_json(as_dict(verdicts), 2) + "\n"
