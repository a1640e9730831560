"""Report of the pairs of an existing SRDF: text and JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from ..srdf.content import format_positions
from ..srdf.existing import (
    BARE,
    CONFIRMED,
    INTENDED_CONTACT,
    MISSING,
    REFUTED,
    REPEATED,
    UNKNOWN,
    UNPROVED,
    Judgement,
)
from ..srdf.update import Update, describe_removal
from ..srdf.verdicts import CAN_TOUCH
from .counted import format_count
from .json_text import format_json

_COUNTED = (
    (CONFIRMED, "proved"),
    (REFUTED, "can touch"),
    (BARE, "adjacent only through a bare link, not proved"),
    (UNPROVED, "open"),
    (INTENDED_CONTACT, "disabled by User, Default or Always"),
    (UNKNOWN, "of unknown links"),
    (REPEATED, "repeated"),
    (MISSING, "missing, proved"),
)


_MOST_NAMED = 3
"""Pairs that a summary names; chosen, no source."""


def is_wrong(found: Sequence[Judgement]) -> bool:
    """Tell whether a pair is disabled as Never or Adjacent that can touch."""
    return any(
        j.code in (REFUTED, BARE) and j.verdict is not None and j.verdict.kind == CAN_TOUCH
        for j in found
    )


def format_summary(found: Sequence[Judgement]) -> str:
    """Format the number of pairs by what is known of them."""
    counts = Counter(judgement.code for judgement in found)
    parts = [f"{counts[code]} {title}" for code, title in _COUNTED if counts[code]]
    disabled = len(found) - counts[MISSING]
    touching = format_intended(found)
    return (
        f"{format_count(disabled, 'disabled pair')}: {', '.join(parts) or 'none'}"
        f"{touching and f'; {touching}'}"
    )


def format_intended(found: Sequence[Judgement]) -> str:
    """Format the pairs that can touch and are disabled on purpose; empty without one."""
    named = [
        f"{_format_names(j)} ({j.pair.reason})"
        for j in found
        if j.code == INTENDED_CONTACT and j.verdict is not None and j.verdict.kind == CAN_TOUCH
    ]
    if not named:
        return ""
    more = f" and {len(named) - _MOST_NAMED} more" if len(named) > _MOST_NAMED else ""
    verb = "counts" if len(named) == 1 else "count"
    return (
        f"{format_count(len(named), 'pair')} disabled on purpose can touch, and {verb} as right: "
        f"{', '.join(named[:_MOST_NAMED])}{more}"
    )


def format_check(found: Sequence[Judgement]) -> str:
    """Format the pairs that are not proved, a line each, with their place."""
    lines = [line for judgement in found if (line := _format(judgement))]
    return "".join(f"{line}\n" for line in lines)


def _format(judgement: Judgement) -> str:
    pair, verdict = judgement.pair, judgement.verdict
    if judgement.code in (CONFIRMED, MISSING, INTENDED_CONTACT):
        return ""
    names = f"'{pair.link1}' and '{pair.link2}'"
    place = pair.element.place
    reason = f" ({pair.reason})" if pair.reason else ""
    if judgement.code == UNKNOWN:
        return f"{place}: a link of {names} does not exist"
    if judgement.code == REPEATED:
        return f"{place}: {names} is disabled twice"
    bare = " through a link without geometry only" if judgement.code == BARE else ""
    if verdict is not None and verdict.kind == CAN_TOUCH:
        where = format_positions(verdict.positions)
        return f"{place}: {names} are disabled{reason}{bare}, but touch at {where}"
    if verdict is not None and verdict.distance is not None:
        near = f"; nearest {verdict.distance * 1000:.2f} mm"
        return f"{place}: {names} are disabled{reason}{bare}, which is not proved{near}"
    return f"{place}: {names} are disabled{reason}{bare}, which is not proved"


def to_json(found: Sequence[Judgement]) -> str:
    """Return the pairs as JSON."""
    counts = Counter(judgement.code for judgement in found)
    data = {
        "version": 1,
        "summary": {code: counts[code] for code, _ in _COUNTED},
        "pairs": [_as_dict(judgement) for judgement in found],
    }
    return format_json(data, 2) + "\n"


def _as_dict(judgement: Judgement) -> dict[str, Any]:
    pair, verdict = judgement.pair, judgement.verdict
    place = None if pair.provenance is None else pair.provenance.place
    positions = {} if verdict is None else verdict.positions
    return {
        "links": [pair.link1, pair.link2],
        "reason": pair.reason,
        "code": judgement.code,
        "verdict": None if verdict is None else verdict.kind,
        "positions": {name: round(value, 6) for name, value in positions.items()},
        "distance": None if verdict is None else _round(verdict.distance),
        "path": None if place is None else str(place.path),
        "line": None if place is None else place.line,
        "column": None if place is None else place.column,
    }


def _round(distance: float | None) -> float | None:
    return None if distance is None else round(distance, 6)


def format_changes_as_json(changes: Update) -> str:
    """Return the changes of an SRDF as JSON."""
    data = {
        "version": 1,
        "added": [_as_dict(judgement) for judgement in changes.added],
        "removed": [_as_dict(judgement) for judgement in changes.removed],
        "kept": [{**_as_dict(judgement), "why": why} for judgement, why in changes.kept],
        "not_added": [{**_as_dict(judgement), "why": why} for judgement, why in changes.refused],
    }
    return format_json(data, 2) + "\n"


def list_changes(changes: Update) -> Iterator[str]:
    """Yield a line for each change of an SRDF, and for what was not changed."""
    for judgement in changes.removed:
        yield f"removed: {_format_names(judgement)}, because {describe_removal(judgement)}"
    for judgement, reason in changes.kept:
        why = describe_removal(judgement)
        yield f"kept: {_format_names(judgement)}, because {reason}; {why}"
    for judgement in changes.added:
        yield f"added: {_format_names(judgement)}"
    for judgement, reason in changes.refused:
        yield f"not added: {_format_names(judgement)}, because {reason}"


def _format_names(judgement: Judgement) -> str:
    return f"'{judgement.pair.link1}' and '{judgement.pair.link2}'"


def format_update(changes: Update, found: Sequence[Judgement]) -> str:
    """Format the number of changes, and the pairs that stay on purpose although they can touch."""
    touching = format_intended(found)
    return (
        f"{format_count(len(changes.added), 'pair')} added, {len(changes.removed)} removed, "
        f"{len(changes.kept)} kept though not proved, {len(changes.refused)} not added"
        f"{touching and f'; {touching}'}"
    )
