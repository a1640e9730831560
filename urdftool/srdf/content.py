"""Content of a new SRDF."""

from __future__ import annotations

from collections.abc import Sequence

from ..model.elements import Robot
from ..model.semantic import DisabledPair, SemanticDescription
from .adjacent import find_adjacent_pairs
from .groups import GivenGroup, add_groups, find_groups


def make_semantic(robot: Robot, given: Sequence[GivenGroup] = ()) -> SemanticDescription:
    """Make the semantic description of a robot: groups, states and the pairs of adjacent links.

    Args:
        robot: Robot.
        given: Groups that the user asks for.

    Raises:
        ConfigError: A given group is not a chain of the robot.
    """
    shaped = list_shaped_links(robot)
    content = SemanticDescription(None, robot.name, disabled=_disable_adjacent(robot, shaped))
    add_groups(content, find_groups(robot, given))
    return content


def list_shaped_links(robot: Robot) -> list[str]:
    """List the names of the links with collision geometry, in the order of the file."""
    return [name for name, link in robot.link.items() if link.collisions]


def _disable_adjacent(robot: Robot, shaped: Sequence[str]) -> list[DisabledPair]:
    """List the adjacent pairs in the order of the file: of the first link, then of the second."""
    rank = {name: index for index, name in enumerate(shaped)}
    pairs = [sorted(pair, key=rank.__getitem__) for pair in find_adjacent_pairs(robot, shaped)]
    pairs.sort(key=lambda pair: (rank[pair[0]], rank[pair[1]]))
    return [DisabledPair(None, one, other, "Adjacent") for one, other in pairs]
