"""The world, where a robot's joints hang on it and no link declares it."""

from __future__ import annotations

from dataclasses import replace

from .elements import Joint, Link, Robot

WORLD = "world"
"""The name by which simulators know what does not move."""


def with_world(robot: Robot) -> tuple[Robot, Joint | None]:
    """A robot with the link ``world`` that its joints name, should no link be called so.

    ``urdfdom`` refuses such a file; Drake and others take the name for the world itself, and so
    does every command of ours that goes on.

    Args:
        robot: Any robot; it stays as it is.

    Returns:
        The robot, and the first joint that names the world; the robot itself and None where the
        link is there or nothing hangs on it.
    """
    if WORLD in robot.link:
        return robot, None
    for joint in robot.joints:
        if joint.parent == WORLD and joint.parent_element is not None and joint.child in robot.link:
            links = [*robot.links, Link(joint.parent_element, WORLD)]
            return replace(robot, links=links), joint
    return robot, None
