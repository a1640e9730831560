"""Many findings of one cause as one, in the order of the source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ..finding import Finding


def merge(findings: Iterable[Finding]) -> list[Finding]:
    """Findings with the instances of one macro as one, in the order they came."""
    merged: dict[tuple[Any, ...], Finding] = {}
    for finding in findings:
        place = finding.place
        key: tuple[Any, ...] = (finding.rule, place.file.path, place.start, place.end)
        if not place.calls:
            key += (finding.message,)
        first = merged.get(key)
        if first is None:
            merged[key] = replace(finding, others=list(finding.others))
        elif place.calls and place.calls != first.place.calls:
            first.expansions += finding.expansions
            first.severity = max(first.severity, finding.severity)
            first.others += [(finding.name, place.calls), *finding.others]
    return list(merged.values())


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """Findings by file, place and rule."""
    return sorted(findings, key=lambda f: (f.place.file.path, f.place.start, f.rule))
