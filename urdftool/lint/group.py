"""Grouping of findings for reports: consequences under their cause, equal facts as one finding.

Suppression comments, baselines, fixes and variants apply to single findings. Grouping is the last
step before a report is written, in all formats.
"""

from __future__ import annotations

import math
import os
from bisect import bisect, insort
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..diagnostic import FileRewrite, Fix, Replacement, Severity
from ..finding import Cause, Finding, Group, Site
from ..listing import quote_first
from .fingerprint import get_fact
from .merge import sort_findings
from .outcome import Outcome

FEW = 3
"""Maximum number of warnings or infos of a rule without grouping that are reported each by itself.

More about one robot are one finding. Errors are each reported. Chosen, no source.
"""

_OF_ANY_RULE = Group("robot", "", ())

COPIES = 3
"""Number of files from which findings with one message are one: copies of a robot. Chosen."""

NAMES = 5
"""Maximum number of names in the message of a group; the others are counted. Chosen, no source."""


def group_outcome(outcome: Outcome) -> Outcome:
    """Return a run with grouped findings."""
    robots: dict[Any, int] = {}
    for number, report in enumerate(outcome.reports):
        for finding in report.findings:
            robots.setdefault(_make_identity(finding), number)
    return replace(
        outcome,
        findings=group(outcome.findings, robots),
        known=group(outcome.known, robots),
    )


def group(findings: Iterable[Finding], robots: Mapping[Any, int] | None = None) -> list[Finding]:
    """Nest consequences under their causes, and merge each group to one finding.

    A moot remark is left out: the defects come first for which readers reject the robot. It is
    reported once they are fixed.

    Args:
        findings: Findings, in the order of the source.
        robots: Index of the description of each finding; without it, all belong to one.
    """
    shown = [finding for finding in findings if not finding.is_deferred]
    return sort_findings(_merge_copies(_merge_groups(_nest_consequences(shown), robots or {})))


def _merge_copies(findings: list[Finding]) -> list[Finding]:
    """Merge findings that say the same of at least ``COPIES`` files of one repository."""
    copies: dict[Any, list[Finding]] = {}
    for finding in findings:
        place = finding.location
        key: Any = id(finding)
        if not finding.unchecked and not finding.consequences:
            effects = tuple(finding.effects.items())
            where = _find_repository(os.path.dirname(os.path.abspath(place.path)))
            key = finding.code, finding.severity, finding.message, effects, finding.variants, where
        copies.setdefault(key, []).append(finding)
    merged = []
    for found in copies.values():
        files = len({finding.location.path for finding in found})
        if files < COPIES:
            merged += found
            continue
        members = [member for finding in found for member in finding.members or (finding,)]
        whole = _as_one(found)
        merged.append(
            replace(
                whole,
                members=members,
                group=Group("repository", "", found[0].message),
                message=f"{found[0].message} (and in {files - 1} more files)",
            )
        )
    return merged


def _nest_consequences(findings: list[Finding]) -> list[Finding]:
    """Return the findings without those that another explains, nested as its consequences."""
    if not any(finding.cause for finding in findings):
        return findings
    causes: dict[tuple[str, Site | None], list[int]] = {}
    for number, finding in enumerate(findings):
        causes.setdefault((finding.code, finding.site), []).append(number)
    above: dict[int, int] = {}
    for number, finding in enumerate(findings):
        if finding.cause is None:
            continue
        for candidate in _list_candidates(finding.cause, causes):
            if _explains(findings[candidate], finding) and not _is_above(number, candidate, above):
                above[number] = candidate
                break
    if not above:
        return findings
    made = [replace(f, consequences=list(f.consequences)) for f in findings]
    for number in sorted(above, key=lambda n: -_get_depth(n, above)):
        cause = made[above[number]]
        cause.consequences.append(made[number])
        cause.severity = max(cause.severity, made[number].severity)
    return [finding for number, finding in enumerate(made) if number not in above]


def _list_candidates(
    cause: Cause, causes: Mapping[tuple[str, Site | None], list[int]]
) -> Iterable[int]:
    for rule in cause.rules:
        for site in cause.sites:
            yield from causes.get((rule, site), ())


def _explains(cause: Finding, finding: Finding) -> bool:
    """Tell whether a cause exists in all variants and instances of its consequence."""
    if cause.variants and not set(finding.variants or ("",)) <= set(cause.variants):
        return False
    if finding.site != cause.site:
        return True
    return set(finding.names) <= set(cause.names)


def _is_above(number: int, other: int, above: Mapping[int, int]) -> bool:
    """Tell whether a finding is the other one or one of its causes."""
    while other != number and other in above:
        other = above[other]
    return other == number


def _get_depth(number: int, above: Mapping[int, int]) -> int:
    depth = 0
    while number in above:
        number, depth = above[number], depth + 1
    return depth


def _merge_groups(findings: Iterable[Finding], robots: Mapping[Any, int]) -> list[Finding]:
    groups: dict[Any, list[Finding]] = {}
    for finding in findings:
        groups.setdefault(_get_key(finding, robots), []).append(finding)
    return [
        one
        for found in groups.values()
        for one in ([_as_one(found)] if len(found) >= _get_least(found[0]) else found)
    ]


def _get_least(finding: Finding) -> int:
    """Return how many findings are at least one group."""
    return FEW + 1 if finding.group is None else 2


def _get_key(finding: Finding, robots: Mapping[Any, int]) -> Any:
    """Return what the findings of one group have in common."""
    group = finding.group or _OF_ANY_RULE
    if finding.group is None and finding.severity is Severity.ERROR:
        return id(finding)
    where: Any = robots.get(_make_identity(finding), 0)
    if group.by == "repository":
        where = _find_repository(os.path.dirname(os.path.abspath(finding.location.path)))
    effects = tuple(finding.effects.items())
    return finding.code, finding.severity, group.alike, effects, finding.variants, where


def _make_identity(finding: Finding) -> Any:
    place = finding.location
    return place.path, place.start, place.end, get_fact(finding)


def _find_repository(folder: str) -> str:
    """Return the nearest folder with a ``.git``, from a folder upward; empty if there is none."""
    for above in (Path(folder), *Path(folder).parents):
        if (above / ".git").exists():
            return str(above)
    return ""


def _as_one(found: Sequence[Finding]) -> Finding:
    """Return one finding for a group, at the place of the first."""
    first = found[0]
    rest = [
        (name, calls) for f in found[1:] for name, calls in ((f.name, f.location.calls), *f.others)
    ]
    hints = {finding.hint for finding in found}
    consequences = [c for finding in found for c in finding.consequences]
    whole = replace(
        first,
        members=list(found),
        others=[*first.others, *rest],
        hint=first.hint if len(hints) == 1 else "",
        fixes=_combine_fixes(found),
        consequences=_merge_groups(consequences, {}),
    )
    whole.group = first.group or _OF_ANY_RULE
    whole.message = _format_sentence(whole.group, whole)
    return whole


def _format_sentence(group: Group, whole: Finding) -> str:
    if group.sentence:
        sentence = group.sentence.replace("{count}", str(whole.count))
        return sentence.replace("{names}", quote_first(whole.names, NAMES))
    names = f": {quote_first(whole.names[1:], NAMES)}" if whole.names[1:] else ""
    return f"{whole.message} (and {whole.count - 1} more{names})"


def _combine_fixes(found: Sequence[Finding]) -> tuple[Fix, ...]:
    """Return the combined fix of a group; its message has the number of findings if not all."""
    fixes = [finding.fix for finding in found if finding.fix is not None]
    safe = [fix for fix in fixes if fix.safe]
    chosen = safe or fixes
    if not chosen:
        return ()
    edits = _Edits()
    rewrites: dict[FileRewrite, None] = {}
    covered = 0
    for fix in chosen:
        if edits.add(fix.replacements):
            covered += 1
            rewrites.update(dict.fromkeys(fix.rewrites))
    message = chosen[0].message
    if any(fix.message != message for fix in chosen):
        message = f"{message}, and so on"
    if covered < len(found):
        message += f" (covers {covered} of {len(found)} places)"
    replacements = sorted(
        edits.replacements, key=lambda r: (r.place.path, r.place.start, r.place.end)
    )
    return (Fix(bool(safe), message, tuple(replacements), tuple(rewrites)),)


class _Edits:
    """Replacements of which no two overlap."""

    def __init__(self) -> None:
        self.replacements: dict[Replacement, None] = {}
        self._spans: dict[str, list[tuple[int, int]]] = {}  # sorted, by path

    def add(self, replacements: Sequence[Replacement]) -> bool:
        """Add replacements; return False and add none if one overlaps another one's span."""
        new = [r for r in replacements if r not in self.replacements]
        if any(map(self._overlaps, new)):
            return False
        for one in new:
            self.replacements[one] = None
            insort(self._spans.setdefault(one.place.path, []), (one.place.start, one.place.end))
        return True

    def _overlaps(self, one: Replacement) -> bool:
        """Tell whether a span overlaps the one before or the one after it; others are farther."""
        start, end = one.place.start, one.place.end
        spans = self._spans.get(one.place.path, [])
        after = bisect(spans, (start, math.inf))
        return any(a < end and start < b for a, b in spans[max(after - 1, 0) : after + 1])
