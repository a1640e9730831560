"""Robots and moved bodies without any mass."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.elements import MOVING_TYPES, Joint, Link, Robot
from ..gazebo.lumped_model import find_kept_links, find_massless_holders
from ..rule import ERROR, GAZEBO, INFO, ROS, Problem
from ..words import quote
from ..xml.vocabulary_table import find_misspelled_children
from .bodies import find_rigid_bodies
from .device_frames import is_massless_scene

INERTIAL_HINT = "'urdftool inertia robot --write --mass LINK=KG' computes one from its geometry"

MASS_READERS = (*GAZEBO, "mujoco", "pybullet")
"""Targets that need masses."""

_CHAIN = 3
"""Number of joints from which links without geometry are a robot. Chosen, no source."""


def is_only_kinematic(robot: Robot) -> bool:
    """Tell whether no link of a robot has an inertial, though several have geometry.

    Without geometry, it has several joints that move. A single link with geometry lost its inertial
    rather.
    """
    if any(
        link.inertial is not None or "inertial" in find_misspelled_children(link.xml).values()
        for link in robot.links
    ):
        return False
    shown = sum(not link.is_frame and link.name != "world" for link in robot.links)
    return shown > 1 if shown else len(robot.moving_joints) >= _CHAIN


def report_massless(robot: Robot, targets: frozenset[str]) -> Problem:
    """Report a robot of which no link has an inertial.

    It is off by default where nothing is for ROS: such robots of Python projects serve kinematics,
    as readers of 12 of them found.
    """
    solid = any(link.collisions for link in robot.links)
    return Problem(
        robot,
        f"no link of the robot has an <inertial>{'' if solid else ' or a <collision>'}, so the "
        "robot serves kinematics and display, not dynamics",
        severity=INFO,
        hint=INERTIAL_HINT if solid else "",
        effects=(
            *("gz, gazebo-classic (root)", "pybullet", "pinocchio, KDL, drake"),
            *_select_mujoco_effect(robot),
        ),
        alike="robot",
        pedantic=is_massless_scene(robot)
        or (len(robot.links) == 1 and not solid)
        or targets.isdisjoint(ROS),
    )


def _select_mujoco_effect(robot: Robot) -> list[str]:
    """Select the effect on a robot without inertials: MuJoCo needs a mass of what joints move."""
    moved = [links for joint, _, links in find_moved_bodies(robot) if joint.type in MOVING_TYPES]
    if not moved:
        return []
    bare = any(not any(link.collisions for link in links) for links in moved)
    return ["mujoco (no mass)" if bare else "mujoco (collisions)"]


def find_moved_bodies(robot: Robot) -> Iterator[tuple[Joint, str, list[Link]]]:
    """List the rigid bodies on moving joints, each as joint, name of the topmost link and links."""
    for name, links in find_rigid_bodies(robot).items():
        joint = robot.tree.get_parent_joint(name)
        if joint is not None and not joint.is_fixed and not links[0].is_virtual:
            yield joint, name, links


def has_bare_moved_body(robot: Robot) -> bool:
    """Tell whether a joint moves a body without mass and geometry, which MuJoCo rejects."""
    moved = (links for joint, _, links in find_moved_bodies(robot) if joint.type in MOVING_TYPES)
    return any(map(is_bare, moved))


def is_bare(links: list[Link]) -> bool:
    """Tell whether no link of a body has an inertial, nor geometry that requires one."""
    for link in links:
        misspelled = find_misspelled_children(link.xml)
        if not link.is_frame or "inertial" in misspelled.values():
            return False
    return True


_IN_GAZEBO = {"gz, gazebo-classic", "gz, gazebo-classic (root)", "gz, gazebo-classic (part)"}

LUMPED = {"gz, gazebo-classic (part)", "pinocchio, KDL, drake"}
"""Effects on a link that is fixed to one with a mass: the body keeps its mass."""


def select_effects(robot: Robot, link: Link, in_gazebo: str) -> set[str]:
    """Select the effects on a link without mass; MuJoCo welds the root to the world.

    Args:
        robot: The robot.
        link: Its link without an ``<inertial>``.
        in_gazebo: Case of the effect in Gazebo; empty for the effect without a case.
    """
    body = [one for one, _ in find_attached_links(robot, link)]
    tops = [robot.tree.get_parent_joint(one.name) for one in body]
    keys = {"gz, gazebo-classic" + (f" ({in_gazebo})" if in_gazebo else "")} & _IN_GAZEBO
    if is_fixed_to_world(robot, link):
        return keys
    keys |= {"pybullet", "pinocchio, KDL, drake"}
    if None in tops:
        return keys
    if link.collisions:
        keys.add("mujoco (collisions)")
    elif not any(one.mass > 0 or (one.inertial is None and one.collisions) for one in body):
        keys.add("mujoco (no mass)")
    return keys


def report_holders(robot: Robot, targets: frozenset[str], *, is_written: bool) -> Iterator[Problem]:
    """Report links without mass for which Gazebo omits those that their joints move.

    Args:
        robot: The robot.
        targets: Its targets.
        is_written: Whether to report links with an ``<inertial>``, of mass 0, or those without one.
    """
    kept = None if targets.isdisjoint(GAZEBO) else find_kept_links(robot)
    for name, omitted in (find_massless_holders(robot, kept) if kept else {}).items():
        if (robot.link[name].inertial is not None) is is_written:
            yield Problem(
                robot.link[name],
                f"link '{name}' has at most 1e-6 kg and is fixed to another, so Gazebo omits "
                f"{quote(omitted)}, which a joint on it moves, and everything attached to it; give "
                "it a mass above 1e-6 kg, or put the joint on the link that it is fixed to",
                severity=ERROR,
                group="{count} links have at most 1e-6 kg and are fixed to others, so Gazebo omits "
                "what their joints move; give each a mass above 1e-6 kg, or put the joints on the "
                "links that they are fixed to: {names}",
                effects=("gz, gazebo-classic (holds)",),
                alike="holds",
            )
