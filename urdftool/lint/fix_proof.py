"""Comparison of reports before and after a fix: a fix that makes them worse is reverted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..diagnostic import Severity
from ..finding import Finding
from ..rules.table import FIXES, RULES
from .fingerprint import get_fact, get_word
from .outcome import Report

Key = tuple[Any, ...]


_ABOUT_VALUES = ("tensor", "size", "frame", "sides", "typing_mistakes")
"""Files of the inertia rules that doubt the values of a tensor."""


class Wrong(NamedTuple):
    """Reason to revert fixes.

    Attributes:
        text: Description of the deterioration.
        of_a_file: Whether a file that a fix rewrites cannot be computed.
        subjects: Kind and name of objects with more findings than before, or with findings that
            the fixes did not resolve.
    """

    text: str
    of_a_file: bool = False
    subjects: frozenset[tuple[str, str]] = frozenset()


def get_key(finding: Finding) -> Key:
    """Return the identity of a finding, which does not depend on the preceding bytes."""
    place = finding.location
    start = place.start if finding.kind == "file" else None
    return place.path, start, *get_likeness(finding)


def get_likeness(finding: Finding) -> Key:
    """Return what equal findings in different descriptions have in common."""
    return *get_fact(finding), get_word(finding)


def get_subject(finding: Finding) -> tuple[str, str]:
    """Return kind and name of the object of a finding."""
    return finding.kind, finding.name


def find_regression(
    before: Report, after: Report, chosen: Sequence[Finding], others: Sequence[Finding] = ()
) -> Wrong | None:
    """Return what is worse after fixes; None if nothing is.

    Args:
        before: Report without the fixes.
        after: Report with the fixes.
        chosen: Fixed findings of the report.
        others: Findings of other reports that the same step fixes, in files that they share.
    """
    if after.error is not None and before.error is None:
        return Wrong(f"the file could not be read: {after.error.message}")
    if after.skipped and not before.skipped:
        return Wrong(f"the file would not be checked: {after.skipped}")
    broke = after.failed_rules.keys() - before.failed_rules.keys()
    if broke:
        return Wrong(f"rule {min(broke)} fails with an internal error")
    stops = [_list_blocking(before), _list_blocking(after)]
    if len(stops[1]) > len(stops[0]) or (stops[1] and not stops[0]):
        return Wrong(f"the file could not be read: {stops[1][0].message}")
    left = Counter(map(get_key, after.findings))
    there = Counter(map(get_key, before.findings))
    still = [finding for finding in chosen if left[get_key(finding)] >= there[get_key(finding)]]
    if still:
        return Wrong("the finding remains", subjects=frozenset(map(get_subject, still)))
    if stops[0] or any(FIXES[finding.code].reveals for finding in (*chosen, *others)):
        return None
    for level in (Severity.ERROR, Severity.WARNING):
        now, then = _count_by_subject(after, level), _count_by_subject(before, level)
        more = frozenset(subject for subject, count in now.items() if count > then[subject])
        # a sum over several fixes would hide one that adds as many findings as it resolves
        gone = sum(one.severity >= level for one in chosen) if more and len(chosen) > 1 else 0
        if sum(now.values()) > sum(then.values()) - gone:
            new = [f for f in after.findings if f.severity >= level and not there[get_key(f)]]
            what = f"then {new[0].message} [{new[0].code}]" if new else ""
            return Wrong(what or "it would cause more findings", subjects=more)
    return _find_new_doubt(before, after, chosen)


def _find_new_doubt(before: Report, after: Report, chosen: Sequence[Finding]) -> Wrong | None:
    """Return a finding about an inertia that a fix of another inertia would cause.

    The number that the fix writes is then in doubt itself, even if the new finding is an info. A
    link that had no inertia is different: what is wrong with it could not be seen before, except
    that it is not the inertia of its mirror image.
    """
    family = {name for file in _ABOUT_VALUES for name in RULES["inertia"][file]}
    codes = {finding.code for finding in chosen}
    if "missing-inertial" in codes and not codes & family:
        family = set(RULES["inertia"]["sides"])
    elif not codes & family:
        return None
    there = {(finding.code, get_subject(finding)) for finding in before.findings}
    new = [
        finding
        for finding in after.findings
        if finding.code in family and (finding.code, get_subject(finding)) not in there
    ]
    subjects = frozenset(map(get_subject, new))
    return Wrong(f"then {new[0].message} [{new[0].code}]", subjects=subjects) if new else None


def _list_blocking(report: Report) -> list[Finding]:
    """Return the findings that prevent reading the robot."""
    return [f for f in report.findings if f.kind == "file" and f.severity is Severity.ERROR]


def _count_by_subject(report: Report, level: Severity) -> Counter[tuple[str, str]]:
    """Return the number of findings of each object, from a severity on."""
    return Counter(get_subject(f) for f in report.findings if f.severity >= level)
