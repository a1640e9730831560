"""The robot of a file that also describes its surroundings, as files of MuJoCo often do."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace

from ..model.elements import Link, Plane, Robot
from ..model.tree import KinematicTree
from ..model.world import WORLD


def take_robot(robot: Robot) -> tuple[Robot, list[str]]:
    """Return the part of a scene that is simulated, and what is left out.

    Planes of the world are left out, since the simulation has its own ground. If several parts
    move freely, or one in addition to parts at the world, the one with most joints is the robot.
    So is the largest part of a URDF that floating joints divide.

    Args:
        robot: Any robot; it is not modified.
    """
    tree = robot.tree
    if robot.xml is not None:
        return _take_largest_part(robot)
    if tree.root is None or tree.root.name != WORLD:
        return robot, []
    world = tree.root
    left_out = [f"plane '{c.name}'" for c in world.collisions if isinstance(c.geometry, Plane)]
    solid = [c for c in world.collisions if not isinstance(c.geometry, Plane)]
    tops = {joint.child: joint for joint in tree.get_child_joints(WORLD)}
    names = {link.name for link in robot.links}
    if len(tops) > 1 and any(joint.type == "floating" for joint in tops.values()):
        sizes = {top: _measure(tree, top) for top in tops}
        chosen = max(sizes, key=lambda top: sizes[top])
        names = {WORLD, *_list_below(tree, chosen)}
        left_out += [f"link '{top}'" for top in tops if top != chosen]
        left_out += [f"collision '{c.name}' of link 'world'" for c in solid]
        solid = []
    if not left_out:
        return robot, []
    links = [link for link in robot.links if link.name in names]
    links[links.index(world)] = replace(world, collisions=solid)
    return _select(robot, links), left_out


def _take_largest_part(robot: Robot) -> tuple[Robot, list[str]]:
    """Return the part with most joints of a robot that floating joints divide, and the others."""
    root = robot.tree.root
    tops = [joint.child for joint in robot.joints if joint.type == "floating"]
    if root is None or not tops:
        return robot, []
    is_frame = not root.mass and not root.collisions
    rest = {name for name in _list_below(robot.tree, root.name, tops) if name != root.name}
    if is_frame and len(tops) == 1 and not rest:
        return robot, []  # a frame above a free base
    parts = {top: list(_list_below(robot.tree, top, tops)) for top in (root.name, *tops)}
    if is_frame and not rest:
        del parts[root.name]
    sizes = {top: _count(robot.tree, names) for top, names in parts.items()}
    chosen = max(sizes, key=lambda top: sizes[top])
    names = set(parts.pop(chosen))
    links = [link for link in robot.links if link.name in names]
    return _select(robot, links), [f"link '{top}'" for top in parts]


def _list_below(tree: KinematicTree, link: str, ends: Collection[str] = ()) -> Iterator[str]:
    """Yield a link and all links below it, without ``ends`` and what is below them."""
    todo = [link]
    while todo:
        name = todo.pop()
        yield name
        below = [joint.child for joint in tree.get_child_joints(name)]
        todo += [child for child in below if child not in ends]


def _measure(tree: KinematicTree, top: str) -> tuple[int, int]:
    """Return the number of joints that move below a link, and of links."""
    return _count(tree, list(_list_below(tree, top)))


def _count(tree: KinematicTree, names: Collection[str]) -> tuple[int, int]:
    """Return the number of joints that move among links, and of links."""
    joints = [j for name in names for j in tree.get_child_joints(name) if j.child in names]
    return sum(not joint.is_fixed for joint in joints), len(names)


def _select(robot: Robot, links: list[Link]) -> Robot:
    """Return the robot with some of its links, and what belongs to them."""
    names = {link.name for link in links}
    joints = [joint for joint in robot.joints if {joint.parent, joint.child} <= names]
    kept = {joint.name for joint in joints}
    return replace(
        robot,
        links=links,
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
