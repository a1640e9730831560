"""The fallbacks of ``--force``: what is written of a robot that has defects."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ...finding import Finding
from ...model.elements import Joint, Link, Robot
from ...model.world import add_world
from ..defects import get_identity, report_defects
from ..written import Written
from .naming import get_free_name

FATAL = frozenset(("no-links", "no-root", "multiple-parents", "detached-cycle", "immense-number"))
"""Defects that no fallback passes."""

OF_TREES = frozenset(("no-root", "multiple-roots", "multiple-parents", "detached-cycle"))
"""Defects of the whole tree, which other defects may cause or hide."""

FALLBACKS = {
    "multiple-roots": "each tree stands at the model's origin",
    "duplicate-link-name": "only the first is written",
    "duplicate-joint-name": "it gets another name",
    "unknown-parent-link": "the joint is left out, unless its parent is the world",
    "unknown-child-link": "the joint is not exported",
    "missing-parent-or-child": "the joint is not exported",
    "missing-name": "such a link is left out, such a joint gets a name",
}
"""The fallback of each defect that has one which does not depend on the case."""

REPORTED_AS = {"mesh-not-found": "lossy-mesh"}
"""Code of the loss by which a writer reports a defect itself, at its element."""


def drop_invalid_parts(robot: Robot) -> Robot:
    """Drop links and joints that nothing can refer to, and joints that refer to nothing."""
    robot, _ = add_world(robot)
    links: dict[str, Link] = {}
    for link in robot.links:
        if link.name:
            links.setdefault(link.name, link)
    joints: dict[str, Joint] = {}
    names = {joint.name for joint in robot.joints}
    for joint in robot.joints:
        if joint.parent in links and joint.child in links:
            name = joint.name
            if not name or name in joints:
                name = get_free_name(name or f"{joint.child}_joint", names)
                names.add(name)
            joints[name] = joint if name == joint.name else replace(joint, name=name)
    return replace(robot, links=list(links.values()), joints=list(joints.values()))


def report_orphaned_sensors(robot: Robot, written: Written) -> None:
    """Report the sensors of joints that :func:`drop_invalid_parts` dropped from a robot."""
    for sensor in robot.mounted_sensors:
        if sensor.joint and sensor.joint not in robot.joint and sensor.link not in robot.link:
            text = f"sensor '{sensor.name}' is dropped: its joint '{sensor.joint}' is not exported"
            written.report_loss("sensor", text, sensor.place, kind="sensor", name=sensor.name)


def report_tree_defects(robot: Robot, left: Robot, forced: bool) -> Iterator[Finding]:
    """Yield the defects of links and joints, without those that are consequences of others.

    Args:
        robot: The robot.
        left: The robot without invalid parts.
        forced: Whether that is what is written, so that its own trees count.
    """
    own, later = list(report_defects(robot)), list(report_defects(left))
    remain = set(map(get_identity, later))
    yield from (f for f in own if f.code not in OF_TREES or get_identity(f) in remain)
    known = set(map(get_identity, own))
    yield from (f for f in later if forced and f.code in OF_TREES and get_identity(f) not in known)


def report_passed_defects(written: Written, found: Iterable[Finding]) -> None:
    """Report the defects that ``--force`` passed and the writer did not, each with its fallback."""
    for finding in found:
        if _is_reported(written, finding):
            continue
        fallback = FALLBACKS.get(finding.code)
        written.report_loss(
            finding.code,
            finding.message,
            finding.location,
            kind=finding.kind,
            name=finding.name,
            hint=f"accepted by --force; {fallback}" if fallback else "accepted by --force",
        )


def _is_reported(written: Written, finding: Finding) -> bool:
    place, code = finding.location, REPORTED_AS.get(finding.code)
    return code is not None and any(
        loss.code == code
        and loss.location.path == place.path
        and loss.location.start <= place.start < loss.location.end
        for loss in written.losses
    )
