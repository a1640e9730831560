"""Losses and defects of an export as text, one line each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace

from ...diagnostic import Severity
from ...finding import Finding

_MOST_LINES = 100
"""Lines of one rule that are printed; chosen."""

_RANKED = {
    "lossy-nonconvex": "hull_ratio",
    "lossy-inertia": "excess",
    "lossy-inertia-raised": "change",
    "inertia-triangle-inequality": "excess",
}
"""Codes of findings that most links of a robot can have, and the value that ranks them."""

_FEW = 3
"""Findings that differ in a value or a name and are printed one by one; chosen, no source."""


def merge_instances(findings: Iterable[Finding]) -> list[Finding]:
    """Merge findings of one rule at one place, as those of the instances of a macro."""
    found: dict[tuple[str, str, int], Finding] = {}
    for finding in findings:
        key = finding.code, finding.location.path, finding.location.start
        if key in found:
            found[key].expansions += 1
        else:
            found[key] = replace(finding)
    return list(found.values())


def format_lines(findings: Iterable[Finding]) -> Iterator[str]:
    """Yield a line for each finding, with its remedy; those that differ in a name share a line.

    Of more than ``_MOST_LINES`` findings of one rule, the others are counted.
    """
    counts: Counter[tuple[str, str]] = Counter()
    for finding, others in _merge_equal(merge_instances(findings)):
        kind = finding.severity.label, finding.code
        counts[kind] += 1
        if counts[kind] > _MOST_LINES:
            continue
        hint = f" (and {len(others)} more{_format_names(others)})" if others else ""
        hint += f" ({finding.hint})" if finding.hint else ""
        times = f" (in {finding.expansions} expansions)" if finding.expansions > 1 else ""
        label = "note" if finding.severity is Severity.INFO else finding.severity.label
        yield f"{finding.location}: {label}: {finding.message}{hint}{times} [{finding.code}]"
    for (label, code), count in counts.items():
        if count > _MOST_LINES:
            yield f"{count - _MOST_LINES} more of severity {label} [{code}]"


def _format_names(names: list[str]) -> str:
    shown = [f"'{name}'" for name in names[:_FEW] if name]
    return f": {', '.join(shown)}{', …' if len(names) > len(shown) else ''}" if shown else ""


def keep_largest(findings: Iterable[Finding]) -> list[Finding]:
    """Replace many findings that differ in one value by the largest, which counts them."""
    merged = merge_instances(findings)
    ranked: dict[str, list[Finding]] = {}
    for finding in merged:
        if _RANKED.get(finding.code) in finding.data:
            ranked.setdefault(finding.code, []).append(finding)
    largest, others = {}, set()
    for some in ranked.values():
        if len(some) > _FEW:
            others |= set(map(id, some))
            largest[id(max(some, key=_get_rank))] = len(some)
    shown = []
    for finding in merged:
        if count := largest.get(id(finding)):
            text = f"{finding.message} (the largest of {count}; -v shows all)"
            shown.append(replace(finding, message=text))
        elif id(finding) not in others:
            shown.append(finding)
    return shown


def _get_rank(finding: Finding) -> float:
    return float(finding.data[_RANKED[finding.code]])


def count_messages(findings: Iterable[Finding]) -> int:
    """Return the number of findings, in which those that share a line count once."""
    return sum(1 for _ in _merge_equal(merge_instances(findings)))


def _merge_equal(findings: Iterable[Finding]) -> Iterator[tuple[Finding, list[str]]]:
    """Yield the first of the findings that share a line, and the names of the others.

    These are files that are missing for one cause, and messages that differ in a name.
    """
    groups: dict[object, list[Finding]] = {}
    for finding in findings:
        cause = finding.data.get("not_found_because")
        text = finding.message.replace(f"'{finding.name}'", "''", 1)
        key = (finding.code, finding.severity, cause or text, finding.hint)
        groups.setdefault(key, []).append(finding)
    for some in groups.values():
        if "not_found_because" in some[0].data:
            yield some[0], [""] * (len(some) - 1)
        elif len(some) > _FEW:
            yield some[0], list(dict.fromkeys(finding.name for finding in some))[1:]
        else:
            yield from ((finding, []) for finding in some)


def raise_losses_as_errors(findings: Iterable[Finding]) -> list[Finding]:
    """Raise the severity of losses to error.

    Losses of severity info, after which the robot behaves the same, are left out.
    """
    return [replace(f, severity=Severity.ERROR) for f in findings if f.severity > Severity.INFO]
