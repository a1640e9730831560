"""Merging of findings with one cause, in the order of the source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ..finding import Finding
from .fingerprint import get_fact
from .outcome import Outcome, Report

_UNREACHED = "unreached-typo"
"""Rule whose finding another finding on the line replaces: a robot does expand it."""


def merge(findings: Iterable[Finding]) -> list[Finding]:
    """Merge the findings of instances of one macro, keeping the order."""
    findings = _drop_reached(list(findings))
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


def _drop_reached(findings: list[Finding]) -> list[Finding]:
    """Drop typos of unexpanded parts on lines on which an expanded robot has a finding."""
    if all(finding.code != _UNREACHED for finding in findings):
        return findings
    lines = {_get_line(one) for one in findings if one.code != _UNREACHED}
    return [one for one in findings if one.code != _UNREACHED or _get_line(one) not in lines]


def _get_line(finding: Finding) -> tuple[str, int]:
    return finding.location.file.path, finding.location.line


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
