"""Detection of renamed links and joints."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ..model.elements import Joint, Link, Robot

SameLink = Callable[[Link, Link], bool]
SameJoint = Callable[[Joint, Joint], bool]


def find_renames(
    a: Robot, b: Robot, same_link: SameLink, same_joint: SameJoint
) -> tuple[dict[str, str], dict[str, str]]:
    """Return the new names of renamed links and of renamed joints, by old names.

    A link is renamed if a new link has the same parent and is equal, and so is its parent joint. A
    joint is renamed if an equal new joint connects the same links.

    Args:
        a: The first robot.
        b: The second robot.
        same_link: Tells whether two links are equal except for their names.
        same_joint: Tells whether two joints are equal except for their names and links.
    """
    links: dict[str, str] = {}
    joints: dict[str, str] = {}
    taken: set[str] = set()
    for name in a.tree.order:
        if name in b.link:
            continue
        joint = a.tree.get_parent_joint(name)
        for other, link in _list_replacements(a, b, name, joint, links):
            if link.name in a.link or link.name in taken or not same_link(a.link[name], link):
                continue
            if joint is None or other is None:
                if joint is not other:
                    continue
            elif not same_joint(joint, other):
                continue
            links[name] = link.name
            taken.add(link.name)
            break
    for joint in a.joints:
        ends = links.get(joint.parent, joint.parent), links.get(joint.child, joint.child)
        if joint.name in b.joint:
            continue
        for other in b.tree.joints_of_child.get(ends[1], []):
            new = other.name not in a.joint and other.name not in joints.values()
            if new and other.parent == ends[0] and same_joint(joint, other):
                joints[joint.name] = other.name
                break
    return links, joints


def _list_replacements(
    a: Robot, b: Robot, name: str, joint: Joint | None, links: dict[str, str]
) -> Iterator[tuple[Joint | None, Link]]:
    """Yield joints and links of the second robot with the same parent as a link of the first."""
    if joint is None:
        yield from ((None, link) for link in b.tree.roots)
        return
    parent = links.get(joint.parent, joint.parent)
    below = b.tree.get_child_joints(parent)
    for other in sorted(below, key=lambda other: other.name != joint.name):
        if other.child in b.link:
            yield other, b.link[other.child]
