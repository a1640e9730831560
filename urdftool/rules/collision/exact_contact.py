"""Find whether the collisions of two links touch, by the surfaces that MoveIt's FCL compares."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...errors import UrdftoolError
from ...model.elements import Link, Robot
from .convex_bodies import get_convex_bodies

if TYPE_CHECKING:
    from ...srdf.surfaces import Surface


def find_contact(robot: Robot, one: Link, other: Link) -> bool | None:
    """Find whether the collisions of two links touch with all joints at rest; kept for the robot.

    Meshes are surfaces and primitives are solid, as in FCL. So a mesh wholly inside another mesh
    does not touch it, and one inside a primitive does.

    Returns:
        None if a mesh cannot be read, or if they have too many triangles.
    """
    known: dict[frozenset[str], bool | None] = robot.memo.get("contacts", dict)
    key = frozenset((one.name, other.name))
    if key not in known:
        known[key] = _compute_contact(robot, one, other)
    return known[key]


def _compute_contact(robot: Robot, one: Link, other: Link) -> bool | None:
    from ...srdf.surfaces import find_contact as find_contact_of_surfaces

    try:
        first, second = (_get_surfaces(robot, link) for link in (one, other))
    except UrdftoolError:
        return None
    answers = [find_contact_of_surfaces(a, b) for a in first for b in second]
    return True if True in answers else None if None in answers else False


def _get_surfaces(robot: Robot, link: Link) -> list[Surface]:
    """Get the collisions of a link in the frame of the root, kept for the robot.

    Raises:
        UrdftoolError: A mesh cannot be read.
    """
    from ...srdf.surfaces import read_surfaces

    known: dict[str, list[Surface]] = robot.memo.get("surfaces", dict)
    if link.name not in known:
        pose = get_convex_bodies(robot).poses[link.name]
        known[link.name] = read_surfaces(robot, link.name, pose)
    return known[link.name]
