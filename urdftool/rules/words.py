"""Format lists for messages."""

from __future__ import annotations

from collections.abc import Iterable

from ..model.elements import Robot
from ..suggestions import find_nearest as find_nearest
from ..suggestions import fold as fold
from ..suggestions import suggest_name as suggest_name


def quote(names: Iterable[str], most: int = 4) -> str:
    """Format names as ``'a', 'b' and 'c'``; above ``most``, the first and the number of others."""
    words = [f"'{name}'" for name in names]
    if len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} others"]
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""


def join_some(items: list[str], kind: str, most: int = 12) -> str:
    """Join items with commas; above ``most``, the first ones and the number of others."""
    if len(items) <= most + 1:
        return ", ".join(items)
    return f"{', '.join(items[:most])} and {len(items) - most} more {kind}"


def split_words(text: str) -> frozenset[str]:
    """Split a text into a set of words, for tables."""
    return frozenset(text.split())


def find_nearest_joint(robot: Robot, name: str) -> str:
    """Return the joint with the name nearest to an unknown one; empty if none is near.

    A joint that moves is meant rather than a fixed one, unless the names are equal but for case,
    ``_`` and ``-``.
    """
    near = find_nearest(name, robot.joint)
    if not near or fold(near) == fold(name):
        return near
    return find_nearest(name, [joint.name for joint in robot.moving_joints]) or near


def suggest_joint(robot: Robot, name: str) -> str:
    """Return ``; did you mean 'x'?`` with that joint; empty if none is near."""
    near = find_nearest_joint(robot, name)
    return f"; did you mean '{near}'?" if near else ""
