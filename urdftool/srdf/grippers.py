"""Grippers and hands of a robot, from its mimic joints, pairs of fingers and names."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ..model.elements import Joint
from .body_tree import BodyTree
from .name_parts import is_wheel_name, split_name

FINGER_REACH = 0.3
"""Largest length of a finger that has another name [m]; chosen, no source."""

_FINGER = re.compile(r"finger|thumb|knuckle|gripper|jaw|claw|pinch", re.IGNORECASE)
_DIGITS = frozenset(("index", "middle", "ring", "pinky", "little", "mrl"))
_WRIST = frozenset(("wrist", "roll", "pitch", "yaw", "pan", "tilt", "rotate", "rotation", "base"))


@dataclass(frozen=True)
class Gripper:
    """Fingers that move relative to one body.

    Attributes:
        body: Body that carries the fingers.
        palm: Link of this body that carries all fingers.
        fingers: Joints between the body and the fingers.
        links: Names of the links of the gripper, parents first, without the parent link.
        parent_link: Link that the gripper is attached to; empty if the robot is a gripper.
        joints: All joints of the gripper.
    """

    body: str
    palm: str
    fingers: list[Joint]
    links: list[str]
    parent_link: str
    joints: list[Joint]


def find_grippers(tree: BodyTree) -> list[Gripper]:
    """Find the grippers of a robot, parents first."""
    found: list[Gripper] = []
    inside: set[str] = set()
    for body in tree.order:
        if body in inside:
            continue
        fingers = _find_fingers(tree, body)
        if not fingers:
            continue
        found.append(_make_gripper(tree, body, fingers))
        for joint in fingers:
            inside |= {tree.get_body(one.child) for one in tree.list_joints_within(joint)}
    return found


def _find_fingers(tree: BodyTree, body: str) -> list[Joint]:
    """Find the joints that move fingers relative to a body; none if no finger is actuated."""
    branches = tree.get_joints_below(body)
    for choose in (_choose_named, _choose_mimicking, _choose_pair, _choose_unnamed):
        fingers = choose(tree, body, branches)
        if any(tree.is_active(one) for j in fingers for one in tree.list_joints_within(j)):
            followers = [joint for joint in branches if _follows(tree, joint, fingers)]
            return [joint for joint in branches if joint in fingers or joint in followers]
    return []


def _choose_named(tree: BodyTree, body: str, branches: Sequence[Joint]) -> list[Joint]:
    """Choose branches whose joints have names of fingers, but not one long row of joints."""
    digits = {word for j in branches for word in _DIGITS.intersection(split_name(j.name))}
    chosen = [
        j
        for j in branches
        if all(is_finger_name(one, digits) for one in tree.list_joints_within(j))
    ]
    if len(chosen) > 1:
        return chosen
    above = tree.get_joint_above(body)
    row = above is not None and is_finger_name(above, digits)
    active = [one for j in chosen for one in tree.list_joints_within(j) if tree.is_active(one)]
    return [] if row or len(active) > 2 else chosen


def is_finger_name(joint: Joint, digits: Collection[str]) -> bool:
    """Tell whether the name of a joint or of its child link is that of a finger.

    Args:
        joint: The joint.
        digits: Words such as ``index`` in the names next to it; a single one may mean a position.
    """
    words = set(split_name(joint.name))
    if re.search("finger|thumb", joint.name, re.IGNORECASE):
        return True
    if words & _WRIST:
        return False
    if _FINGER.search(joint.name) or "grip" in words or (len(digits) > 1 and words & _DIGITS):
        return True
    return re.search("finger|thumb|jaw|claw", joint.child, re.IGNORECASE) is not None


def _choose_mimicking(tree: BodyTree, body: str, branches: Sequence[Joint]) -> list[Joint]:
    """Choose branches of which one has the leaders, and another the followers."""
    within = {
        j.name: joints
        for j in branches
        if not any(map(is_wheel_name, joints := list(tree.list_joints_within(j))))
    }
    leaders = {
        one.mimic.joint: name
        for name, joints in within.items()
        for one in joints
        if one.mimic is not None and not tree.is_active(one)
    }
    chosen = [
        j
        for j in branches
        if j.name in within
        and all(not tree.is_active(one) or one.name in leaders for one in within[j.name])
    ]
    names = {j.name for j in chosen}
    owner = {one.name: name for name, joints in within.items() for one in joints}
    across = any(
        follower in names and owner.get(leader) in names and owner[leader] != follower
        for leader, follower in leaders.items()
    )
    return chosen if across else []


def _choose_pair(tree: BodyTree, body: str, branches: Sequence[Joint]) -> list[Joint]:
    """Choose two or more prismatic joints side by side, at the end of an arm."""
    pair = [j for j in branches if j.type == "prismatic" and not tree.get_joints_below(j.child)]
    return pair if len(pair) > 1 and _count_above(tree, body) else []


def _choose_unnamed(tree: BodyTree, body: str, branches: Sequence[Joint]) -> list[Joint]:
    """Choose short branches at the end of an arm: single joints, or three and more fingers."""
    above = _count_above(tree, body)
    if above < 2 or len(branches) < 2:
        return []
    if any(j.type == "continuous" or tree.measure_reach(j) > FINGER_REACH for j in branches):
        return []
    single = all(not tree.get_joints_below(j.child) for j in branches)
    return list(branches) if single or (len(branches) > 2 and above > 2) else []


def _count_above(tree: BodyTree, body: str) -> int:
    return sum(map(tree.is_active, tree.list_joints_above(body)))


def _follows(tree: BodyTree, joint: Joint, fingers: Sequence[Joint]) -> bool:
    """Tell whether all joints of a branch mimic joints of some fingers."""
    leaders = {one.name for finger in fingers for one in tree.list_joints_within(finger)}
    return all(
        one.mimic is not None and not tree.is_active(one) and one.mimic.joint in leaders
        for one in tree.list_joints_within(joint)
    )


def _make_gripper(tree: BodyTree, body: str, fingers: list[Joint]) -> Gripper:
    joints = [one for joint in fingers for one in tree.list_joints_within(joint)]
    palm = _find_palm(tree, [joint.parent for joint in fingers])
    parent = _find_parent_link(tree, body, palm)
    robot_tree = tree.robot.tree
    own = {one for joint in joints for one in tree.get_links(joint.child)}
    if palm != parent:
        fixed = set(tree.get_links(body))
        first = _get_child_towards(tree, parent, palm) if parent else palm
        own |= {first} | (fixed & set(robot_tree.list_descendants(first)))
    links = [name for name in robot_tree.order if name in own]
    return Gripper(body, palm, fingers, links, parent, joints)


def _find_palm(tree: BodyTree, parents: Sequence[str]) -> str:
    """Find the nearest link above all parents of the fingers."""
    paths = [[name, *tree.robot.tree.list_ancestors(name)] for name in parents]
    return next(name for name in paths[0] if all(name in path for path in paths))


def _find_parent_link(tree: BodyTree, body: str, palm: str) -> str:
    """Find the link that carries a gripper: the nearest bare frame above its palm.

    Without a bare frame it is the parent of the palm; a palm that a joint moves carries the fingers
    itself. Empty if the gripper is the whole robot.
    """
    above = [palm, *tree.robot.tree.list_ancestors(palm)]
    fixed = above[1 : above.index(body) + 1]
    for name in fixed:
        if tree.robot.link[name].is_frame:
            return name
    alone = palm if tree.get_joint_above(body) is not None else ""
    return fixed[0] if fixed else alone


def _get_child_towards(tree: BodyTree, ancestor: str, link: str) -> str:
    """Return the child of an ancestor from which a link descends."""
    path = [link, *tree.robot.tree.list_ancestors(link)]
    return path[path.index(ancestor) - 1]
