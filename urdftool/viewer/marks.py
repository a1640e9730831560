"""Assignment of findings to links."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from operator import itemgetter

from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot
from ..source.location import Call, Place

Owners = dict[tuple[str, tuple[Call, ...]], list[tuple[int, str]]]


def group_by_link(robot: Robot, findings: Iterable[Finding]) -> dict[str, list[Finding]]:
    """Group findings by the names of the links that they concern, in their order.

    A finding on a joint belongs to its child link. A finding that names no link or joint belongs to
    the link whose XML contains it, or to the child of the joint whose XML does; if neither does, it
    is dropped. Each instance of a finding counts for its own link.
    """
    owners: Owners | None = None
    found: dict[str, list[Finding]] = {}
    for finding in findings:
        links: dict[str, None] = {}
        for name, calls in ((finding.name, finding.location.calls), *finding.others):
            link = _find_link(robot, finding.kind, name)
            if link is None:
                owners = _map_owners(robot) if owners is None else owners
                link = _find_owner(owners, finding.location, calls)
            if link is not None and link in robot.link:
                links[link] = None
        for link in links:
            found.setdefault(link, []).append(finding)
    return found


def find_highest_severity(findings: Iterable[Finding]) -> Severity | None:
    """Return the highest severity among findings; None if there are none."""
    return max((finding.severity for finding in findings), default=None)


def format_counts(findings: Iterable[Finding]) -> str:
    """Format counts such as ``2 errors, 1 warning``; empty if there are none."""
    counts = dict.fromkeys(sorted(Severity, reverse=True), 0)
    for finding in findings:
        counts[finding.severity] += 1
    names = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "info"}
    return ", ".join(
        f"{count} {names[severity]}{'s' if count > 1 and severity > Severity.INFO else ''}"
        for severity, count in counts.items()
        if count
    )


def _find_link(robot: Robot, kind: str, name: str) -> str | None:
    if kind == "link" and name in robot.link:
        return name
    if kind == "joint" and name in robot.joint:
        joint = robot.joint[name]
        return joint.child if joint.child in robot.link else joint.parent
    return None


def _map_owners(robot: Robot) -> Owners:
    """Map file and macro calls to the start of each tag in a link or joint, with the link."""
    starts: Owners = {}
    for part, link in (
        *((link, link.name) for link in robot.links),
        *((joint, joint.child) for joint in robot.joints),
    ):
        for inner in () if part.xml is None else part.xml.walk():
            starts.setdefault((inner.file.path, inner.calls), []).append((inner.start, link))
    for rows in starts.values():
        rows.sort(key=itemgetter(0))
    return starts


def _find_owner(owners: Owners, place: Place, calls: tuple[Call, ...]) -> str | None:
    """Return the link with the innermost tag that contains a place."""
    rows = owners.get((place.file.path, calls), [])
    index = bisect_right(rows, place.start, key=itemgetter(0)) - 1
    if index < 0:
        return None
    start, link = rows[index]
    return link if place.start < place.file.find_tag_end(start) else None
