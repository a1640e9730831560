"""Distinguish joints that move something from those that only have to exist."""

from __future__ import annotations

import re

from ...model.elements import Joint, Robot

_DUMMY = re.compile(r"dummy|fake|virtual|placeholder", re.IGNORECASE)
"""Words in the names of joints and links that only have to exist."""

SLIGHT = 1e-3
"""Mass [kg] up to which links without geometry count as nothing. Chosen, no source."""


def moves_nothing(robot: Robot, joint: Joint, most: float = SLIGHT) -> bool:
    """Tell whether the links below a joint have no geometry and at most a mass [kg]."""
    names = (joint.child, *robot.tree.list_descendants(joint.child))
    links = [robot.link[name] for name in names if name in robot.link]
    bare = all(not link.visuals and not link.collisions for link in links)
    return bare and sum(link.mass for link in links) <= most


def is_coordinate(robot: Robot, joint: Joint) -> bool:
    """Tell whether a joint moves nothing, and others mimic it: such as the opening of a hand."""
    followed = any(
        other.mimic is not None and other.mimic.joint == joint.name for other in robot.joints
    )
    return followed and moves_nothing(robot, joint)


def is_dummy(robot: Robot, joint: Joint) -> bool:
    """Tell whether a joint is named as a dummy, and moves nothing.

    IsaacGym requires at least one joint of a robot, for example.
    """
    named = _DUMMY.search(joint.name) or _DUMMY.search(joint.child)
    return bool(named) and moves_nothing(robot, joint)


def is_round_number(joint: Joint, value: float) -> bool:
    """Tell whether a limit is -100 to 100, with velocity or effort as round: no limit is meant."""
    limit = joint.limit
    if limit is None or value not in (100.0, -100.0) or limit.lower != -(limit.upper or 0.0):
        return False
    rounded = (100.0, 1000.0, 10000.0)
    return limit.velocity in rounded or limit.effort in rounded
