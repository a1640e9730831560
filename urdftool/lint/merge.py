"""Merging of findings with one cause, in the order of the source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ..finding import Finding
from .fingerprint import get_fact
from .outcome import Outcome, Report


def merge(findings: Iterable[Finding]) -> list[Finding]:
    """Merge the findings of instances of one macro, keeping the order."""
    merged: dict[tuple[Any, ...], Finding] = {}
    copied: set[tuple[Any, ...]] = set()
    for finding in findings:
        place = finding.location
        key: tuple[Any, ...] = (finding.code, place.file.path, place.start, place.end)
        if not place.calls:
            key += get_fact(finding)
        first = merged.get(key)
        if first is None:
            merged[key] = finding
        elif place.calls and place.calls != first.location.calls:
            if key not in copied:  # do not modify the given findings
                copied.add(key)
                first = merged[key] = replace(first, others=list(first.others))
            first.expansions += finding.expansions
            first.severity = max(first.severity, finding.severity)
            first.others += [(finding.name, place.calls), *finding.others]
    return list(merged.values())


def sort_findings(findings: Iterable[Finding]) -> list[Finding]:
    """Sort findings by file, place and rule."""
    return sorted(findings, key=lambda f: (f.location.file.path, f.location.start, f.code))


def gather(reports: Iterable[Report]) -> Outcome:
    """Merge all reports; a finding in a file that several descriptions include appears once."""
    reports = list(reports)
    findings = sort_findings(merge(f for report in reports for f in report.findings))
    ignored: dict[str, list[Finding]] = {}
    for report in reports:
        for finding, reason in report.ignored:
            ignored.setdefault(reason, []).append(finding)
    excused = [
        (f, reason) for reason, found in ignored.items() for f in sort_findings(merge(found))
    ]
    return Outcome(reports, findings, excused)
