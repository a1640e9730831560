"""What is worse after a fix than before, so that it is taken back."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..finding import Finding, Severity
from .outcome import Report

REVEALING = frozenset(
    (
        "not-well-formed",
        "content-before-declaration",
        "missing-xmlns",
        "unknown-macro",
        "undeclared-arg",
        "include-not-found",
        "non-boolean-conditional",
        "unprefixed-xacro-tag",
        "bad-substitution-command",
        "unknown-element",
        "unknown-attribute",
        "wrong-case-keyword",
        "unexpanded-expression",
        "not-a-number",
        "wrong-arity",
        "unknown-extension",
        "dangling-reference",
        "misplaced-extension",
        "padded-reference",
        "unknown-joint-type",
        "classic-plugin-in-gz",
        "ros2-control-nested",
        "several-shapes-in-geometry",
        "unknown-parent-link",
        "unknown-child-link",
        "missing-limit",
        "empty-geometry",
        "repeated-element",
        "missing-collision",
        "odd-link-without-collision",
    )
)
"""Rules whose fix lets readers see what they passed over, with what is wrong in it."""

Key = tuple[Any, ...]


class Wrong(NamedTuple):
    """Why fixes are not kept.

    Attributes:
        text: What is worse.
        of_a_file: Whether that is a file that they are made of.
        subjects: What has more findings than before, or those that were to be gone: kind and name.
    """

    text: str
    of_a_file: bool = False
    subjects: frozenset[tuple[str, str]] = frozenset()


def key_of(finding: Finding) -> Key:
    """What stands for a finding, also when bytes above it have changed."""
    place = finding.place
    key: Key = (finding.rule, place.path, finding.kind, finding.name, finding.message)
    return (*key, place.start) if finding.kind == "file" else key


def likeness(finding: Finding) -> Key:
    """What a finding has in common with its like in another description."""
    return finding.rule, finding.kind, finding.name, finding.message


def subject_of(finding: Finding) -> tuple[str, str]:
    """The kind and the name of what a finding is about."""
    return finding.kind, finding.name


def worse(before: Report, after: Report, chosen: Sequence[Finding]) -> Wrong | None:
    """What is worse after some fixes; None where nothing is."""
    if after.error is not None and before.error is None:
        return Wrong(f"the file could not be read: {after.error.message}")
    if after.skipped and not before.skipped:
        return Wrong(f"the file would not be checked: {after.skipped}")
    broke = after.failed_rules.keys() - before.failed_rules.keys()
    if broke:
        return Wrong(f"the rule {min(broke)} breaks")
    stops = [_stops(before), _stops(after)]
    if len(stops[1]) > len(stops[0]) or (stops[1] and not stops[0]):
        return Wrong(f"the file could not be read: {stops[1][0].message}")
    left = Counter(map(key_of, after.findings))
    there = Counter(map(key_of, before.findings))
    still = [finding for finding in chosen if left[key_of(finding)] >= there[key_of(finding)]]
    if still:
        return Wrong("the finding is still there", subjects=frozenset(map(subject_of, still)))
    if stops[0] or any(finding.rule in REVEALING for finding in chosen):
        return None
    for level in (Severity.ERROR, Severity.WARNING):
        now, then = _counted(after, level), _counted(before, level)
        more = frozenset(subject for subject, count in now.items() if count > then[subject])
        # among many, one that brings as much as it takes away is not seen in the sum
        gone = sum(one.severity >= level for one in chosen) if more and len(chosen) > 1 else 0
        if sum(now.values()) > sum(then.values()) - gone:
            new = [f for f in after.findings if f.severity >= level and not there[key_of(f)]]
            what = f"then {new[0].message} [{new[0].rule}]" if new else ""
            return Wrong(what or "there would be more findings", subjects=more)
    return None


def _stops(report: Report) -> list[Finding]:
    """What keeps the robot from being known."""
    return [f for f in report.findings if f.kind == "file" and f.severity is Severity.ERROR]


def _counted(report: Report, level: Severity) -> Counter[tuple[str, str]]:
    """How many findings there are of each subject, from a severity on."""
    return Counter(subject_of(f) for f in report.findings if f.severity >= level)
