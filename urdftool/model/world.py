"""World frame of robots whose joints refer to an undeclared link ``world``."""

from __future__ import annotations

from dataclasses import replace

from .elements import Joint, Link, Robot

WORLD = "world"
"""Link name by which simulators identify the world."""


def add_world(robot: Robot) -> tuple[Robot, Joint | None]:
    """Return the robot with a link ``world``, if its joints refer to one that is not declared.

    ``urdfdom`` rejects such a file; Drake and other readers interpret the name as the world.

    Args:
        robot: Any robot; it is not modified.

    Returns:
        The robot with the link, and the first joint whose parent is ``world``; the robot itself and
        None if the link exists or no such joint does.
    """
    if WORLD in robot.link:
        return robot, None
    for joint in robot.joints:
        if joint.parent == WORLD and joint.parent_element is not None and joint.child in robot.link:
            links = [*robot.links, Link(joint.parent_element, WORLD)]
            return replace(robot, links=links), joint
    return robot, None


def weld_base(robot: Robot) -> Robot:
    """Return the robot with a link ``world`` and a fixed joint, if its source fixes its base.

    URDF, and the writers of other formats, express a fixed base by such a link.

    Args:
        robot: Any robot; it is not modified.
    """
    base = robot.base
    if base is None or base.is_free or WORLD in robot.link or len(robot.tree.roots) != 1:
        return robot
    root = robot.tree.roots[0].name
    name = f"{root}_fixed"
    while name in robot.joint:
        name += "_"
    joint = Joint(base.provenance, name, "fixed", WORLD, root, origin=base.origin)
    return replace(
        robot,
        links=[Link(base.provenance, WORLD), *robot.links],
        joints=[joint, *robot.joints],
        base=None,
    )
