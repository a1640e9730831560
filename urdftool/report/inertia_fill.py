"""Inertials that were written to a robot's source, and those that were not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..control_characters import escape_controls
from ..inertia.fill import Filling, Refusal
from ..mechanics.tensor import get_components
from ..model.elements import Robot
from .counted import format_count
from .inertia_robot import format_geometry_remarks, place_dict
from .json_text import format_json
from .tables import render_table


def format_text(filling: Filling) -> str:
    """Format a row for each written link."""
    rows: list[tuple[str, ...]] = [("link", "mass [kg]", "ixx", "iyy", "izz", "from")]
    for entry in filling.written:
        six = get_components(entry.result.tensor)
        body = entry.item.body
        rows.append(
            (
                escape_controls(entry.link.name),
                f"{entry.result.mass:.6g}",
                *(f"{six[name]:.6g}" for name in ("ixx", "iyy", "izz")),
                "" if body is None else body.source + ("" if body.reliable else " (unsure)"),
            )
        )
    if len(rows) == 1:
        return ""
    return render_table(rows, left=(0, 5))


def format_remarks(filling: Filling) -> Iterator[str]:
    """Yield what must be known of written numbers, and the links left, with reasons and advice."""
    for entry in filling.written:
        yield from format_geometry_remarks(entry.item)
    for refusal in filling.left:
        yield (
            f"{refusal.place}: link '{escape_controls(refusal.link)}' is left as it is: "
            f"{refusal.reason}"
        )
    for refusal in filling.refused:
        yield (
            f"{refusal.place}: link '{escape_controls(refusal.link)}' is not edited: "
            f"{refusal.reason}"
        )
        for place, advice in refusal.advice:
            yield f"  {place}: {advice}"


def summarize(filling: Filling, files: Sequence[str]) -> str:
    """Summarize the counts and the changed files."""
    count = len(filling.written)
    parts = [f"{format_count(count, 'link')} written"]
    left = {refusal.link for refusal in filling.left}
    if unchanged := sum(name not in left for name in filling.unchanged):
        parts.append(f"{unchanged} as {'it was' if unchanged == 1 else 'they were'}")
    if filling.left:
        parts.append(f"{len(filling.left)} left")
    if filling.refused:
        parts.append(f"{len(filling.refused)} to be edited by hand")
    where = f" ({', '.join(files)})" if files else ""
    return ", ".join(parts) + where


def as_json(filling: Filling, robot: Robot) -> str:
    """Format written, unchanged, skipped and refused links as one object."""
    assert robot.source is not None
    record = {
        "version": 1,
        "robot": robot.name,
        "path": robot.source.path,
        "written": [
            {
                "name": entry.link.name,
                **place_dict(entry.link.place),
                **entry.result.as_dict(),
                "source": None if entry.item.body is None else entry.item.body.source,
                "reliable": entry.item.body is not None and entry.item.body.reliable,
            }
            for entry in filling.written
        ],
        "unchanged": filling.unchanged,
        "left": [_build_refusal(refusal) for refusal in filling.left],
        "refused": [_build_refusal(refusal) for refusal in filling.refused],
    }
    return format_json(record, 1) + "\n"


def _build_refusal(refusal: Refusal) -> dict[str, Any]:
    return {
        "name": refusal.link,
        **place_dict(refusal.place),
        "reason": refusal.reason,
        "changes": [{**place_dict(place), "do": advice} for place, advice in refusal.advice],
    }
