"""What an export says of its losses: lines for people, records for programs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ..finding import Finding, Severity


def merged(findings: Iterable[Finding]) -> list[Finding]:
    """Findings of one place and one kind as one: the instances of a macro say the same."""
    found: dict[tuple[str, str, int], Finding] = {}
    for finding in findings:
        key = finding.rule, finding.place.path, finding.place.start
        if key in found:
            found[key].expansions += 1
        else:
            found[key] = replace(finding)
    return list(found.values())


def lines(findings: Iterable[Finding]) -> Iterator[str]:
    """One line for each finding, with what would help; what one thing would mend is one line."""
    for finding, more in _together(merged(findings)):
        hint = f" (and {more} more)" if more else ""
        hint += f" ({finding.hint})" if finding.hint else ""
        times = f" (in {finding.expansions} expansions)" if finding.expansions > 1 else ""
        label = "note" if finding.severity is Severity.INFO else finding.severity.label
        yield f"{finding.place}: {label}: {finding.message}{hint}{times} [{finding.rule}]"


def _together(findings: Iterable[Finding]) -> Iterator[tuple[Finding, int]]:
    """Files that are missing for one reason: the first, and how many more there are."""
    kept: dict[tuple[str, str] | int, list[Finding]] = {}
    for index, finding in enumerate(findings):
        same = finding.rule == "mesh-not-found" and bool(finding.hint)
        kept.setdefault((finding.rule, finding.hint) if same else index, []).append(finding)
    yield from ((some[0], len(some) - 1) for some in kept.values())


def strict(findings: Iterable[Finding]) -> list[Finding]:
    """Losses as errors; notes, where the robot behaves the same, are none."""
    return [replace(f, severity=Severity.ERROR) for f in findings if f.severity > Severity.INFO]
