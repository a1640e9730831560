"""Group links into rigid bodies as simulators do, and add up their inertia."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...mechanics.spatial_inertia import SpatialInertia, combine_links
from ...model.attached import find_attached_links
from ...model.elements import Link, Robot
from ..gazebo.lumping import is_lumped

LIGHT = 1e-3
"""Part of a robot's mass below which the position of a link's mass does not matter."""

_SMALL_RADIUS = 0.01
"""Radius of gyration [m] of a body below which the inertia of its parts does not matter."""


def find_rigid_bodies(robot: Robot) -> dict[str, list[Link]]:
    """Group the links by rigid body; the key is the name of the body's topmost link.

    Gazebo lumps a link into its parent over a fixed joint, unless the joint's ``<gazebo>`` says to
    keep it; nothing is lumped into ``world``.
    """
    return robot.memo.get(find_rigid_bodies, lambda: _find_rigid_bodies(robot))


def _find_rigid_bodies(robot: Robot) -> dict[str, list[Link]]:
    owner: dict[str, str] = {}
    found: dict[str, list[Link]] = {}
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        lumped = joint is not None and joint.is_fixed and not joint.is_preserved
        if joint is not None and lumped and joint.parent != "world":
            owner[name] = owner.get(joint.parent, name)
        else:
            owner[name] = name
        found.setdefault(owner[name], []).append(robot.link[name])
    return found


def is_only_sliding(robot: Robot, link: Link) -> bool:
    """Tell whether no joint between the world and a link rotates it."""
    name, seen = link.name, set[str]()
    while name != "world" and name not in seen:
        seen.add(name)
        joint = robot.tree.get_parent_joint(name)
        if joint is None:  # the root, which MJCF fixes to the world unless it is free
            return robot.base is not None and not robot.base.is_free
        if joint.type not in ("fixed", "prismatic"):
            return False
        name = joint.parent
    return name == "world"


def find_massless_pairs(robot: Robot) -> Iterator[tuple[Link, Link]]:
    """List links without mass that sdformat 12.3 lumps, each with the link it is lumped into.

    It lumps the children of a link in the order of the names of their joints, each after its own
    children, and divides by the sum of the masses so far. Where that is 0, the center of mass is
    not a number, nor is that of the body, which has to have a mass for it to be kept.
    """
    pairs = []
    lumps: dict[str, tuple[float, bool]] = {}
    for name in reversed(robot.tree.order):
        link = robot.link[name]
        mass, has_inertial = link.mass, link.inertial is not None
        for joint in sorted(robot.tree.get_child_joints(name), key=lambda joint: joint.name):
            added, counts = lumps.get(joint.child, (0.0, False))
            if counts and is_lumped(robot, joint.child):
                has_inertial, mass = True, mass + added
                if mass == 0:
                    pairs.append((link, robot.link[joint.child]))
        lumps[name] = mass, has_inertial
    if pairs:
        kept = {
            one.name
            for links in find_rigid_bodies(robot).values()
            if compute_mass(links) > 0
            for one in links
        }
        yield from (pair for pair in reversed(pairs) if pair[0].name in kept)


def compute_mass(links: list[Link]) -> float:
    """Add up the mass of the links of a rigid body [kg]."""
    return sum(link.mass for link in links)


def compute_body_inertia(robot: Robot, links: Iterable[Link]) -> SpatialInertia:
    """Add up the mass properties of the links of one body, in the frame of its first link."""
    members = list(links)
    names = {link.name for link in members}
    around = find_attached_links(robot, members[0])
    return combine_links([(link, pose) for link, pose in around if link.name in names])


def find_negligible_links(robot: Robot, light: float) -> set[str]:
    """Find the links that hardly influence the center of mass of the robot or of their body."""
    least = light * compute_mass(robot.links)
    found: set[str] = set()
    for links in find_rigid_bodies(robot).values():
        most = max(least, 10 * light * compute_mass(links))
        found.update(link.name for link in links if link.mass < most)
    return found


def find_slight_parts(robot: Robot) -> set[str]:
    """Find the links whose inertia is negligible compared with that of their rigid body."""
    return robot.memo.get(find_slight_parts, lambda: _find_slight_parts(robot))


def _find_slight_parts(robot: Robot) -> set[str]:
    found: set[str] = set()
    for links in find_rigid_bodies(robot).values():
        if len(links) > 1:
            whole = compute_body_inertia(robot, links)
            most = 10 * LIGHT * sum(whole.tensor[i] for i in (0, 3, 5))
            most = max(most, whole.mass * _SMALL_RADIUS**2)
            found.update(
                link.name
                for link in links
                if link.inertial is not None
                and link.inertial.inertia is not None
                and 0 < sum(link.inertial.inertia.moments) < most
            )
    return found
