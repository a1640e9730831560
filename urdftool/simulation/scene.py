"""The robot of a file that also describes its surroundings, as files of MuJoCo often do."""

from __future__ import annotations

from dataclasses import replace

from ..model.elements import Plane, Robot
from ..model.selection import count_parts, list_below, measure_tree, select_links
from ..model.world import WORLD


def take_robot(robot: Robot) -> tuple[Robot, list[str]]:
    """Return the part of a scene that is simulated, and what is left out.

    Planes of the world are left out, since the simulation has its own ground. If several parts
    move freely, or one in addition to parts at the world, the one with most joints is the robot.
    So is the largest part of a URDF that floating joints divide.
    """
    tree = robot.tree
    if robot.xml is not None:
        return _take_largest_part(robot)
    if tree.root is None or tree.root.name != WORLD:
        return robot, []
    world = tree.root
    left_out = [
        f"plane '{c.name}'" if c.name else "a plane"
        for c in world.collisions
        if isinstance(c.geometry, Plane)
    ]
    solid = [c for c in world.collisions if not isinstance(c.geometry, Plane)]
    tops = {joint.child: joint for joint in tree.get_child_joints(WORLD)}
    names = {link.name for link in robot.links}
    if len(tops) > 1 and any(joint.type == "floating" for joint in tops.values()):
        sizes = {top: measure_tree(tree, top) for top in tops}
        chosen = max(sizes, key=lambda top: sizes[top])
        names = {WORLD, *list_below(tree, chosen)}
        left_out += [f"link '{top}'" for top in tops if top != chosen]
        left_out += [f"collision '{c.name}' of link 'world'" for c in solid]
        solid = []
    if not left_out:
        return robot, []
    links = [link for link in robot.links if link.name in names]
    links[links.index(world)] = replace(world, collisions=solid)
    return select_links(robot, links), left_out


def _take_largest_part(robot: Robot) -> tuple[Robot, list[str]]:
    """Return the part with most joints of a robot that floating joints divide, and the others."""
    root = robot.tree.root
    tops = [joint.child for joint in robot.joints if joint.type == "floating"]
    if root is None or not tops:
        return robot, []
    is_frame = not root.mass and not root.collisions
    rest = {name for name in list_below(robot.tree, root.name, tops) if name != root.name}
    if is_frame and len(tops) == 1 and not rest:
        return robot, []  # a frame above a free base
    parts = {top: list(list_below(robot.tree, top, tops)) for top in (root.name, *tops)}
    if is_frame and not rest:
        del parts[root.name]
    sizes = {top: count_parts(robot.tree, names) for top, names in parts.items()}
    chosen = max(sizes, key=lambda top: sizes[top])
    names = set(parts.pop(chosen))
    links = [link for link in robot.links if link.name in names]
    return select_links(robot, links), [f"link '{top}'" for top in parts]
