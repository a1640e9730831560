"""The tree that a URDF describes, of a model with several: a robot, and bodies next to it."""

from __future__ import annotations

from dataclasses import replace

from ...diagnostic import Severity
from ...errors import ModelError
from ...listing import quote_first
from ...model.elements import Joint, Robot
from ...model.mechanism import Base
from ...model.selection import list_below, measure_tree, select_links
from ...model.world import WORLD
from ..written import Written


def take_tree(robot: Robot, root: str, written: Written) -> Robot:
    """Return the robot of a model, without bodies that move freely next to it.

    A URDF describes one robot, whose free base has no joint. Of several trees at the world, the one
    with most joints that move is the robot. A source in URDF stays as it is.

    Raises:
        ModelError: The model has no such tree.
    """
    tops = _list_trees(robot)
    if root and root not in tops:
        trees = f"its trees begin at {quote_first(list(tops), 4)}" if tops else "it is one tree"
        raise ModelError(f"the model has no tree with the root link '{root}'; {trees}")
    if not tops:
        return robot
    largest = max(tops, key=lambda top: measure_tree(robot.tree, top))
    chosen = root or largest
    _report_others(robot, [top for top in tops if top != chosen], written)
    names = set(list_below(robot.tree, chosen))
    joint = tops[chosen]
    if joint.type != "floating":
        names.add(WORLD)
        return select_links(robot, [link for link in robot.links if link.name in names])
    _report_world(robot, written)
    part = select_links(robot, [link for link in robot.links if link.name in names])
    return replace(part, base=Base(joint.provenance, True, joint.origin))


def _list_trees(robot: Robot) -> dict[str, Joint]:
    """Return the joint of each tree at the world, by its root link, if one of them is free."""
    world = robot.tree.root
    if robot.xml is not None or world is None or world.name != WORLD:
        return {}
    joints = robot.tree.get_child_joints(WORLD)
    if not any(joint.type == "floating" for joint in joints):
        return {}
    return {joint.child: joint for joint in joints}


def _report_others(robot: Robot, others: list[str], written: Written) -> None:
    """Report the trees that are left out."""
    if not others:
        return
    written.report_loss(
        "tree",
        f"bodies next to the robot are left out, since a URDF describes one: {len(others)} trees "
        f"that begin at {quote_first(others, 4)}; --root {others[0]} exports that one",
        robot.link[others[0]].place,
        kind="link",
        name=others[0],
    )


def _report_world(robot: Robot, written: Written) -> None:
    """Report the shapes of the world, which do not belong to a robot with a free base."""
    world = robot.link[WORLD]
    count = len(world.collisions) + len(world.visuals)
    if count:
        written.report_loss(
            "world-shape",
            f"{count} shapes of the world, such as its floor, are left out: the robot has a free "
            "base",
            world.place,
            kind="link",
            name=WORLD,
            severity=Severity.INFO,
        )
