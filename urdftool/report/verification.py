"""Reports of the comparison of several robots as text and JSON."""

from __future__ import annotations

from collections.abc import Sequence

from ..compare.difference import Comparison, name_part
from ..compare.rows import GLOBAL_ROWS, NOT_COMPARED
from ..compare.several import Agreement, Disagreement
from ..compare.uncompared import MESHES, OPEN, SETTINGS, UNREAD
from ..listing import quote_first
from .counted import format_count
from .json_text import format_json
from .tables import render_table

LETTERS = "ABCDEFGH"
"""Letters of the robots."""

_SHOWN = 60
"""Groups of differences that are listed. Chosen, no source."""

_ALIKE = 4
"""Number of equal differences of several parts that are printed as one; chosen, no source."""
_NAMED = 3
"""Number of their names that are printed. Chosen, no source."""


def to_json(paths: Sequence[str], agreement: Agreement) -> str:
    """Format the result as one object."""
    report = {
        "version": 1,
        "files": list(paths),
        "equal": agreement.is_equal,
        "pairs": [
            {
                "files": list(pair),
                "equal": comparison.has_compared and comparison.is_equal,
                "checks": [check.as_dict() for check in comparison.make_checks()],
                "skipped": comparison.list_skipped(),
                "not_comparable": comparison.not_comparable,
                "partial": sorted(comparison.partial),
                "joints": comparison.joints,
                "links": comparison.links,
            }
            for pair, comparison in agreement.pairs.items()
        ],
        "differences": [_build_record(entry) for entry in agreement.list_disagreements()],
        "not_compared": list(NOT_COMPARED),
    }
    return format_json(report, 1) + "\n"


def _build_record(entry: Disagreement) -> dict[str, object]:
    return {
        "row": entry.row,
        "kind": entry.kind,
        "name": entry.name,
        "what": entry.what,
        "unit": entry.unit,
        "values": entry.values,
        "places": [
            None if place is None else {"path": place.path, "line": place.line}
            for place in entry.places
        ],
        "note": entry.note,
        "convention": entry.is_convention,
        "pairs": [list(pair) for pair in entry.pairs],
        "alone": entry.alone,
    }


def format_text(paths: Sequence[str], agreement: Agreement) -> str:
    """Format the result as a table, followed by the differences."""
    lines = [f"{letter}  {path}" for letter, path in zip(LETTERS, paths, strict=False)]
    text = "\n".join(lines) + "\n\n" + _format_table(agreement)
    entries = agreement.list_disagreements()
    for convention in (False, True):
        chosen = [entry for entry in entries if entry.is_convention is convention]
        if chosen:
            title = "Conventions that differ, with the same motion and mass:" if convention else ""
            text += f"\n{title}\n" if title else "\n"
            groups = sorted(_group(chosen), key=lambda group: len(group) > 1)  # single ones first
            text += "".join(_format_group(group) for group in groups[:_SHOWN])
            if len(groups) > _SHOWN:
                count = sum(map(len, groups[_SHOWN:]))
                text += f"… and {count} more; --format json lists all\n"
    return text + _format_rest(agreement)


def _format_table(agreement: Agreement) -> str:
    labels = [
        "verdict" if len(agreement.pairs) == 1 else f"{LETTERS[i]}-{LETTERS[j]}"
        for i, j in agreement.pairs
    ]
    rows = [("row", "compared", "tolerance", *labels)]
    for row in agreement.rows:
        bound = "exact" if row.tolerance == 0 else f"{row.tolerance:.0e}"
        cells = [_format_cell(comparison, row.name) for comparison in agreement.pairs.values()]
        rows.append((row.name, row.what, bound, *cells))
    return render_table(rows, left=range(3 + len(labels)), rule=True)


def _format_cell(comparison: Comparison, row: str) -> str:
    if row in comparison.skipped:
        return "not compared"
    check = next(check for check in comparison.make_checks() if check.name == row)
    if check.verdict == "announced":
        return "equal, by convention"
    count = f" ({len(check.differing)})" if check.differing else ""
    return f"{check.shown}{count}"


def _group(entries: Sequence[Disagreement]) -> list[list[Disagreement]]:
    """Group the entries of one property with the same values in at least ``_ALIKE`` parts."""
    groups: dict[object, list[Disagreement]] = {}
    for number, entry in enumerate(entries):
        shown = tuple(map(_format_value, entry.values))
        of = entry.row, entry.kind, entry.what, entry.unit, entry.note
        key = *of, shown, frozenset(entry.compared)
        groups.setdefault(key if entry.name else number, []).append(entry)
    found = []
    for group in groups.values():
        found += [group] if len(group) >= _ALIKE else [[entry] for entry in group]
    return found


def _format_group(group: Sequence[Disagreement]) -> str:
    """Format an entry; of several, the names and the values and places of the first."""
    first = group[0]
    if len(group) == 1:
        return _format_entry(first, f"{name_part(first.kind, first.name)}: ")
    names = quote_first([entry.name for entry in group], _NAMED)
    return _format_entry(first, f"{len(group)} {first.kind}s {names}: ")


def _format_value(value: object) -> str:
    if value is None:
        return "none"
    return f"{value:.8g}" if isinstance(value, float) else str(value)


def _format_entry(entry: Disagreement, owner: str) -> str:
    unit = f" [{entry.unit}]" if entry.unit else ""
    note = f": {entry.note}" if entry.note else ""
    text = f"{owner}{entry.what}{unit}{note}\n"
    for number, (value, place) in enumerate(zip(entry.values, entry.places, strict=True)):
        if entry.row in GLOBAL_ROWS:
            continue
        shown = _format_value(value) if number in entry.compared else "not compared"
        where = f"  {place}" if place is not None else ""
        alone = "  (alone)" if entry.alone == number else ""
        text += f"  {LETTERS[number]}  {shown}{where}{alone}\n"
    return text


def _format_rest(agreement: Agreement) -> str:
    """List what was not compared, and why."""
    missing: dict[str, dict[str, None]] = {}
    for comparison in agreement.pairs.values():
        for text in comparison.not_comparable:
            what, _, why = text.partition(": ")
            missing.setdefault(why, {})[what] = None
        for row, why in comparison.list_skipped().items():
            missing.setdefault(why, {})[row] = None
    texts = [
        ", ".join(sorted(rows)) + (f" ({why})" if why else "") for why, rows in missing.items()
    ]
    lines = [f"not comparable: {'; '.join(texts)}\n"] if texts else []
    return "\n" + "".join(lines) + f"not compared: {', '.join(NOT_COMPARED)}\n"


_UNKNOWN = {
    MESHES: "meshes were not read",
    UNREAD: "parts that are compared were not read",
    SETTINGS: "worlds are not the same",
    OPEN: "closed loops were not compared",
}
"""What leaves it unknown whether two robots are equal."""


def _explain_unknown(agreement: Agreement) -> str:
    """Return why it is unknown whether robots without a difference are equal."""
    kinds = {part.kind for one in agreement.pairs.values() for part in one.uncompared}
    return " and ".join(words for kind, words in _UNKNOWN.items() if kind in kinds)


def _describe_verdict(agreement: Agreement) -> str:
    """Describe the result of robots without a difference that was found."""
    if not agreement.has_compared:
        return "nothing was compared"
    if not agreement.is_equal:
        return f"no difference was found, but {_explain_unknown(agreement)}"
    return "equal in every compared property"


def summarize(paths: Sequence[str], agreement: Agreement, totals: Sequence[int]) -> str:
    """Return one sentence with the verdict."""
    entries = [entry for entry in agreement.list_disagreements() if not entry.is_convention]
    robots = f"{len(paths)} robots"
    if not entries:
        missing = {
            text.partition(": ")[0]
            for comparison in agreement.pairs.values()
            for text in (*comparison.not_comparable, *comparison.list_skipped())
        }
        rest = f"; {len(missing)} could not be compared" if missing else ""
        return f"{robots}: {_describe_verdict(agreement)}{rest}"
    text = f"{robots}: {format_count(len(entries), 'difference')}"
    for number, path in enumerate(paths):
        count = sum(entry.alone == number for entry in entries)
        if count:
            text += f"; {LETTERS[number]} is alone in {count}, which to correct in {path}"
    for (i, j), comparison in agreement.pairs.items():
        most = max(totals[i], totals[j])
        if 2 * len(comparison.joints) < most:
            text += (
                f"; only {len(comparison.joints)} joints of {LETTERS[i]} ({totals[i]}) and "
                f"{LETTERS[j]} ({totals[j]}) match, so these may be different robots "
                "(--map FILE names joints)"
            )
    return text
