"""World frame of robots whose joints refer to an undeclared link ``world``."""

from __future__ import annotations

from dataclasses import replace

from .elements import Joint, Link, Robot
from .mechanism import Base
from .numbers import parse_numbers
from .part import ZERO, Origin
from .pose import get_origin_at, make_pose
from .settings import get_text, is_set

WORLD = "world"
"""Link name by which simulators identify the world."""


def add_world(robot: Robot) -> tuple[Robot, Joint | None]:
    """Return the robot with a link ``world``, if its joints refer to one that is not declared.

    ``urdfdom`` rejects such a file; Drake and other readers interpret the name as the world.

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


def find_model_origin(robot: Robot) -> Origin | None:
    """Return the pose of the whole robot in the world of Gazebo; None for the identity.

    A base of another format has it; in URDF ``<pose>`` in ``<gazebo>`` counts, the last of
    several, before ``<origin>`` of ``<robot>``.
    """
    if robot.base is not None:
        return robot.base.origin
    for element in reversed(robot.block_elements.get("", [])):
        if element.tag != "pose":
            continue
        six = parse_numbers(get_text(element), 6)
        if six is not None:
            return Origin(element, six[:3], six[3:])  # type: ignore[arg-type]
    element_ = robot.find_child_xml("origin")
    if element_ is None:
        return None
    xyz, rpy = (parse_numbers(element_.get(name), 3) or ZERO for name in ("xyz", "rpy"))
    return Origin(element_, xyz, rpy)  # type: ignore[arg-type]


def add_gazebo_base(robot: Robot) -> Robot:
    """Return a URDF with the base that it has in Gazebo: free, unless it is static or anchored."""
    if robot.base is not None:
        return robot
    origin = find_model_origin(robot)
    if not any(root.name == WORLD for root in robot.tree.roots):
        return replace(
            robot, base=Base(robot.provenance, not is_set(robot.settings, "static"), origin)
        )
    if origin is None:
        return robot
    pose = make_pose(origin)
    joints = [
        replace(joint, origin=get_origin_at(pose @ make_pose(joint.origin), origin.provenance))
        if joint.parent == WORLD
        else joint
        for joint in robot.joints
    ]
    return replace(robot, joints=joints)
