"""Parts of a robot: the links below a link, and the robot with some of its links."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from .elements import Link, Robot
from .tree import KinematicTree


def list_below(tree: KinematicTree, link: str, ends: Collection[str] = ()) -> Iterator[str]:
    """Yield a link and all links below it, without ``ends`` and what is below them."""
    todo = [link]
    while todo:
        name = todo.pop()
        yield name
        below = [joint.child for joint in tree.get_child_joints(name)]
        todo += [child for child in below if child not in ends]


def measure_tree(tree: KinematicTree, top: str) -> tuple[int, int]:
    """Return the number of joints that move below a link, and of links."""
    return count_parts(tree, list(list_below(tree, top)))


def count_parts(tree: KinematicTree, names: Collection[str]) -> tuple[int, int]:
    """Return the number of joints that move among links, and of links."""
    joints = [j for name in names for j in tree.get_child_joints(name) if j.child in names]
    return sum(not joint.is_fixed for joint in joints), len(names)


def select_links(robot: Robot, links: Sequence[Link]) -> Robot:
    """Return the robot with some of its links, and what belongs to them."""
    names = {link.name for link in links}
    joints = [joint for joint in robot.joints if {joint.parent, joint.child} <= names]
    kept = {joint.name for joint in joints}
    return replace(
        robot,
        links=list(links),
        joints=[
            joint
            if joint.mimic is None or joint.mimic.joint in kept
            else replace(joint, mimic=None)
            for joint in joints
        ],
        closures=[c for c in robot.closures if {c.parent, c.child} <= names],
        frames=[frame for frame in robot.frames if frame.link in names],
        joint_actuators=[a for a in robot.joint_actuators if a.joint in kept],
        exclusions=[e for e in robot.exclusions if {e.link, e.other} <= names],
        cameras=[camera for camera in robot.cameras if camera.link in names],
        mounted_plugins=[p for p in robot.mounted_plugins if p.owner in {"", *names, *kept}],
        mounted_sensors=[s for s in robot.mounted_sensors if s.joint in kept or s.link in names],
    )
