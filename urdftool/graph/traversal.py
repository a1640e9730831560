"""Traversal of links and joints in drawing order, also if they are not a tree."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from ..model.elements import Joint, Link, Robot


class Walk(NamedTuple):
    """Every link and every joint once, parents before their children."""

    links: list[Link]
    joints: list[Joint]


def walk(robot: Robot, order: Callable[[Sequence[Joint]], Sequence[Joint]] = list) -> Walk:
    """Traverse each tree from its root, then detached links; visit a loop once."""
    tree = robot.tree
    seen: set[str] = set()
    found = Walk([], [])
    for start in (*tree.roots, *tree.detached):
        todo: list[tuple[Joint | None, str]] = [(None, start.name)]
        while todo:
            joint, name = todo.pop()
            if joint is not None:
                found.joints.append(joint)
            if name in seen or name not in robot.link:
                continue
            seen.add(name)
            found.links.append(robot.link[name])
            below = order(tree.get_child_joints(name))
            todo.extend((joint, joint.child) for joint in reversed(below))
    found.joints.extend(joint for joint in robot.joints if joint.parent not in robot.link)
    return found


def sort_by_name(joints: Sequence[Joint]) -> Sequence[Joint]:
    """Sort joints by the bytes of their names."""
    return sorted(joints, key=lambda joint: joint.name.encode("utf-8", "surrogatepass"))
