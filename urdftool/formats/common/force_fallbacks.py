"""What is left of a robot past errors in its links and joints; the rest of it can be written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ...finding import Finding
from ...model.elements import Joint, Link, Robot
from ...model.world import with_world
from ..defects import defects
from .naming import free_name

FATAL = frozenset(("no-links", "no-root", "multiple-parents", "detached-cycle", "immense-number"))
"""Errors past which there is no robot that one could mean."""

OF_TREES = frozenset(("no-root", "multiple-roots", "multiple-parents", "detached-cycle"))
"""Errors of the whole, which other errors may cause or hide."""

INSTEAD = {
    "multiple-roots": "each tree stands at the model's origin",
    "duplicate-link-name": "only the first is written",
    "duplicate-joint-name": "it gets another name",
    "unknown-parent-link": "the joint is left out, unless its parent is the world",
    "unknown-child-link": "the joint is left out",
    "missing-parent-or-child": "the joint is left out",
    "missing-name": "such a link is left out, such a joint gets a name",
}
"""What stands in the place of each error that can be passed, where a table can say it."""


def drop_invalid_parts(robot: Robot) -> Robot:
    """The robot without links and joints that nothing can refer to or that refer to nothing.

    Args:
        robot: A robot, which stays as it is.
    """
    robot, _ = with_world(robot)
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
                name = free_name(name or f"{joint.child}_joint", names)
                names.add(name)
            joints[name] = joint if name == joint.name else replace(joint, name=name)
    return replace(robot, links=list(links.values()), joints=list(joints.values()))


def tree_defects(robot: Robot, left: Robot, forced: bool) -> Iterator[Finding]:
    """The defects of links and joints, without those that are but the consequence of others.

    Args:
        robot: The robot.
        left: What is left of it.
        forced: Whether that is what is written, so that its own trees count.
    """
    own, later = list(defects(robot)), list(defects(left))
    remain = set(map(str, later))
    yield from (f for f in own if f.rule not in OF_TREES or str(f) in remain)
    said = set(map(str, own))
    yield from (f for f in later if forced and f.rule in OF_TREES and str(f) not in said)
