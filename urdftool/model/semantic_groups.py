"""Joints of the groups of an SRDF, as MoveIt finds them."""

from __future__ import annotations

from collections.abc import Iterator

from .elements import Robot
from .semantic import Chain, Group, SemanticDescription


def list_joints_of_group(content: SemanticDescription, name: str, robot: Robot) -> set[str]:
    """Return the names of all joints of a group, also fixed and mimic joints.

    They are its joints, the joint above each of its links, those of its chains and of its
    subgroups: ``addJointModelGroup`` of moveit_core, ``robot_model.cpp``. Empty if the group is
    unknown.
    """
    groups: dict[str, Group] = {}
    for group in content.groups:
        groups.setdefault(group.name, group)
    return set(_list_names(groups, name, robot, set()))


def _list_names(groups: dict[str, Group], name: str, robot: Robot, seen: set[str]) -> Iterator[str]:
    if name not in groups or name in seen:
        return
    seen.add(name)
    group = groups[name]
    yield from group.joints
    for link in group.links:
        yield from _list_joints_above(link, robot)[:1]
    for chain in group.chains:
        yield from _list_joints_of_chain(chain, robot)
    for other in group.groups:
        yield from _list_names(groups, other, robot, seen)


def _list_joints_above(link: str, robot: Robot) -> list[str]:
    """List the joints from a link up to the root."""
    found: list[str] = []
    joint = robot.tree.get_parent_joint(link)
    while joint is not None and joint.name not in found:
        found.append(joint.name)
        joint = robot.tree.get_parent_joint(joint.parent)
    return found


def _list_joints_of_chain(chain: Chain, robot: Robot) -> list[str]:
    """List the joints of a chain.

    If the base is not above the tip, they are those of both branches, and the first joint above
    both ends.
    """
    if not {chain.base, chain.tip} <= robot.link.keys():
        return []
    of_tip, of_base = (_list_joints_above(end, robot) for end in (chain.tip, chain.base))
    shared = [name for name in of_base if name in of_tip]
    above = len(of_tip) - len(of_base)
    if above >= 0 and of_tip[above:] == of_base and _is_above(chain, robot):
        return of_tip[:above]
    if not shared:
        return [*of_tip, *of_base]
    first = shared[0]
    return [*of_tip[: of_tip.index(first) + 1], *of_base[: of_base.index(first)]]


def _is_above(chain: Chain, robot: Robot) -> bool:
    return chain.base == chain.tip or chain.base in set(robot.tree.list_ancestors(chain.tip))
