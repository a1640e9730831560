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
