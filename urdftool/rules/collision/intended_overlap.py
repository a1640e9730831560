"""Find overlaps of links that the robot's author intends: telescopes, envelopes, SRDF pairs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...model.elements import Joint, Link, Robot
from ...model.kinematics import MOVABLE
from ...model.pose import compute_dot, compute_norm, rotate
from ...source.description import Description
from .convex_bodies import ConvexBodies, compute_depth, get_convex_bodies

PARALLEL = 0.9998
"""Cosine of the angle between axes up to which they count as parallel, of 1°. Chosen, no source."""

ENVELOPED = 3
"""Number of smaller links inside a link that makes it an envelope, as a safety box of a hand is.
Chosen, no source."""


def list_joints_between(robot: Robot, one: str, other: str) -> list[Joint]:
    """List the movable joints on the path between two links."""
    first, second = (_list_joints_above(robot, name) for name in (one, other))
    shared = first.keys() & second.keys()
    return [
        joint
        for joint in (*first.values(), *second.values())
        if joint.name not in shared and joint.type in MOVABLE
    ]


def _list_joints_above(robot: Robot, name: str) -> dict[str, Joint]:
    """List the joints from a link to the root, by name."""
    found: dict[str, Joint] = {}
    joint = robot.tree.get_parent_joint(name)
    while joint is not None and joint.name not in found:
        found[joint.name] = joint
        joint = robot.tree.get_parent_joint(joint.parent)
    return found


def is_telescope(robot: Robot, one: str, other: str) -> bool:
    """Tell whether only parallel prismatic joints lead from one link to the other: nested stages.

    Two fingers on one palm are no stages: neither is below the other.
    """
    joints = list_joints_between(robot, one, other)
    above = (_list_joints_above(robot, name).keys() for name in (one, other))
    if not any({joint.name for joint in joints} <= names for names in above):
        return False
    if len(joints) < 2 or any(joint.type != "prismatic" for joint in joints):
        return False
    poses = get_convex_bodies(robot).poses
    axes = [
        rotate(poses[joint.child].rotation, joint.axis.xyz if joint.axis else (1.0, 0.0, 0.0))
        for joint in joints
        if joint.child in poses
    ]
    return all(
        abs(compute_dot(axes[0], axis)) > PARALLEL * compute_norm(axes[0]) * compute_norm(axis)
        for axis in axes[1:]
    )


def find_envelopes(robot: Robot, pairs: Iterable[tuple[Link, Link, float]]) -> set[str]:
    """Find links around several smaller ones, among pairs of links that overlap.

    Args:
        robot: Robot.
        pairs: Two links, and the depth [m].
    """
    known = get_convex_bodies(robot)
    inside: dict[str, int] = {}
    for one, other, _ in pairs:
        for outer, inner in ((one, other), (other, one)):
            inside[outer.name] = inside.get(outer.name, 0) + _is_enclosing(known, outer, inner)
    return {name for name, count in inside.items() if count >= ENVELOPED}


def _is_enclosing(known: ConvexBodies, outer: Link, inner: Link) -> bool:
    """Tell whether the center of each collision of a link is in a link of twice its size."""
    walls, parts = (known.get_pieces_of(link) for link in (outer, inner))
    return bool(parts) and all(
        any(
            2 * part.radius < wall.radius and compute_depth(wall, part.pose.translation) > 0
            for wall in walls
        )
        for part in parts
    )


def remove_intended(
    robot: Robot, description: Description, pairs: Sequence[tuple[Link, Link, float]]
) -> list[tuple[Link, Link, float]]:
    """Remove the pairs that are meant: disabled in the SRDF, of a telescope, or in an envelope."""
    if not pairs:
        return []
    disabled = find_disabled_pairs(robot, description)
    envelopes = find_envelopes(robot, pairs)
    return [
        pair
        for pair in pairs
        if frozenset((pair[0].name, pair[1].name)) not in disabled
        if pair[0].name not in envelopes and pair[1].name not in envelopes
        if not is_telescope(robot, pair[0].name, pair[1].name)
    ]


def find_centered_joints(robot: Robot, pairs: Iterable[tuple[Link, Link, float]]) -> list[str]:
    """Find the joints between links of pairs that rest in the middle of a range without zero."""
    centered = get_convex_bodies(robot).centered
    if not centered:
        return []
    return sorted(
        {
            joint.name
            for one, other, _ in pairs
            for joint in list_joints_between(robot, one.name, other.name)
            if joint.name in centered
        }
    )


def find_disabled_pairs(robot: Robot, description: Description) -> set[frozenset[str]]:
    """Find the pairs of links that an SRDF next to the description disables, kept for the robot.

    Without one, those in a folder ``srdf`` next to that of the description count.
    """
    from ...model.semantic import read_semantic
    from ..moveit.semantic import get_documents_of_folder, get_srdf_documents

    def read() -> set[frozenset[str]]:
        documents = get_srdf_documents(robot, description)
        documents = documents or get_documents_of_folder(robot, description)
        contents = [read_semantic(one.root) for one in documents]
        return {pair.links for content in contents for pair in content.list_disabled(robot.link)}

    return robot.memo.get("disabled pairs of the SRDF", read)
