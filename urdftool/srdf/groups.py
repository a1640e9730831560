"""Planning groups, end effectors, states, virtual and passive joints of a robot.

All names are guesses. The sources are the kinematic tree, mimic joints, the names of joints and
links, and ros2_control.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ..errors import ConfigError
from ..model.elements import Joint, Robot
from ..model.semantic import (
    Chain,
    EndEffector,
    Group,
    GroupState,
    PassiveJoint,
    SemanticDescription,
    VirtualJoint,
)
from ..suggestions import suggest_name
from .body_tree import BodyTree
from .chains import KinematicChain, find_chains, measure_chain
from .grippers import Gripper, find_grippers
from .name_parts import find_common_prefix, make_identifier, split_name
from .states import make_chain_states, make_gripper_states


class GivenGroup(NamedTuple):
    """Group that the user asks for: its name, and the two links of its chain."""

    name: str
    base: str
    tip: str


@dataclass
class PlanningGroups:
    """Groups of a robot, and what belongs to them."""

    groups: list[Group] = field(default_factory=list)
    states: list[GroupState] = field(default_factory=list)
    end_effectors: list[EndEffector] = field(default_factory=list)
    virtual_joints: list[VirtualJoint] = field(default_factory=list)
    passive_joints: list[PassiveJoint] = field(default_factory=list)
    ungrouped: list[str] = field(default_factory=list)


@dataclass
class _NamedChain:
    name: str
    chain: KinematicChain


def add_groups(content: SemanticDescription, found: PlanningGroups) -> None:
    """Add groups, states, end effectors and joints to the content of an SRDF."""
    content.groups += found.groups
    content.states += found.states
    content.end_effectors += found.end_effectors
    content.virtual_joints += found.virtual_joints
    content.passive_joints += found.passive_joints


def find_groups(robot: Robot, given: Sequence[GivenGroup] = ()) -> PlanningGroups:
    """Find the planning groups of a robot.

    Raises:
        ConfigError: A given group has no chain with actuated joints, or its name is used twice.
    """
    tree = BodyTree(robot)
    grippers = find_grippers(tree)
    given_chains = [_NamedChain(one.name, _check_given(tree, one)) for one in given]
    _check_names(given)
    chains = _name_chains(tree, given_chains, find_chains(tree, grippers))
    result = PlanningGroups()
    for named in chains:
        chain = Chain(None, named.chain.base, named.chain.tip)
        result.groups.append(Group(None, named.name, chains=[chain]))
        result.states += make_chain_states(robot, named.name, named.chain.list_active(tree))
    _add_grippers(tree, result, chains, grippers)
    _add_combinations(result, chains)
    result.virtual_joints = list(_make_virtual_joint(robot))
    result.passive_joints, result.ungrouped = _list_passive(tree, chains, grippers)
    return result


def _check_given(tree: BodyTree, given: GivenGroup) -> KinematicChain:
    for name in (given.base, given.tip):
        if name not in tree.robot.link:
            raise ConfigError(
                f"--group {given.name}: the robot has no link '{name}'"
                f"{suggest_name(name, tree.robot.link)}"
            )
    chain = measure_chain(tree, given.base, given.tip)
    if chain is None:
        back = measure_chain(tree, given.tip, given.base)
        remedy = f"; write {given.name}={given.tip}:{given.base}" if back is not None else ""
        raise ConfigError(
            f"--group {given.name}: link '{given.tip}' is not a descendant of "
            f"'{given.base}', so they are not a chain{remedy}"
        )
    if not chain.list_active(tree):
        raise ConfigError(
            f"--group {given.name}: no actuated joint is between '{given.base}' and '{given.tip}'"
        )
    return chain


def _check_names(given: Sequence[GivenGroup]) -> None:
    names = [one.name for one in given]
    for name in names:
        if not make_identifier(name):
            raise ConfigError(f"--group: '{name}' is not a name; use letters, digits and _")
        if names.count(name) > 1:
            raise ConfigError(f"--group {name} is given twice; use different names")


def _name_chains(
    tree: BodyTree, given_chains: list[_NamedChain], found: list[KinematicChain]
) -> list[_NamedChain]:
    """Name the found chains that share no joint with those that were asked for."""
    used = {joint.name for named in given_chains for joint in named.chain.joints}
    free = [one for one in found if not used & {joint.name for joint in one.joints}]
    unnamed = not any(map(guess_kind, free))
    default = "finger" if len(free) > 2 and unnamed and _is_hand(tree.robot) else "arm"
    taken = {named.name for named in given_chains}
    result = list(given_chains)
    for chain in free:
        name = _take_name(guess_chain_name(chain, guess_kind(chain) or default), taken)
        taken.add(name)
        result.append(_NamedChain(name, chain))
    return result


def _is_hand(robot: Robot) -> bool:
    names = " ".join((robot.name, *robot.link)).lower()
    return "hand" in names or "finger" in names or "palm" in names


def _take_name(stem: str, taken: set[str]) -> str:
    number, name = 2, stem
    while name in taken:
        name, number = f"{stem}_{number}", number + 1
    return name


def _add_grippers(
    tree: BodyTree, result: PlanningGroups, chains: list[_NamedChain], grippers: list[Gripper]
) -> None:
    taken = {group.name for group in result.groups}
    for gripper in grippers:
        carrier = _find_carrier(tree, chains, gripper)
        kind = "hand" if len(gripper.fingers) > 2 and _has_hand(gripper) else "gripper"
        stem = guess_gripper_name(carrier, kind, alone=len(grippers) == 1)
        name = _take_name(stem, taken)
        taken.add(name)
        result.groups.append(Group(None, name, links=gripper.links))
        result.states += make_gripper_states(tree, name, gripper)
        if gripper.parent_link:
            effector = EndEffector(None, name, gripper.parent_link, name, carrier)
            result.end_effectors.append(effector)


def _has_hand(gripper: Gripper) -> bool:
    """Tell whether the fingers are independent, or a name says hand."""
    names = " ".join((gripper.palm, *(joint.name for joint in gripper.joints))).lower()
    return "hand" in names or "thumb" in names


def _find_carrier(tree: BodyTree, chains: list[_NamedChain], gripper: Gripper) -> str:
    """Find the group with the gripper's parent link; empty if there is none."""
    for named in reversed(chains):
        chain = named.chain
        links = {joint.child for joint in chain.joints} | {chain.tip}
        if not chain.is_trunk and (gripper.parent_link in links or gripper.body in links):
            return named.name
    return ""


def _add_combinations(result: PlanningGroups, chains: list[_NamedChain]) -> None:
    """Add a group of all arms, and a chain of the torso and a single arm."""
    arms = [one for one in chains if guess_kind(one.chain) in ("arm", "")]
    trunks = [one for one in chains if one.chain.is_trunk]
    names = {group.name for group in result.groups}
    if len(arms) > 1:
        name = _take_name("hand" if arms[0].name.startswith("finger") else "arms", names)
        group = Group(None, name, groups=[one.name for one in arms])
        result.groups.append(group)
    if len(arms) == 1 and len(trunks) == 1:
        name = _take_name(f"{arms[0].name}_with_torso", names)
        chain = Chain(None, trunks[0].chain.base, arms[0].chain.tip)
        result.groups.append(Group(None, name, chains=[chain]))


def _make_virtual_joint(robot: Robot) -> Iterator[VirtualJoint]:
    root = robot.tree.root
    if root is not None and root.name != "world":
        name = _take_name("virtual_joint", set(robot.joint))
        yield VirtualJoint(None, name, "fixed", "world", root.name)


def _list_passive(
    tree: BodyTree, chains: list[_NamedChain], grippers: list[Gripper]
) -> tuple[list[PassiveJoint], list[str]]:
    """List the joints that are not actuated, and the actuated ones without a group.

    Not actuated are mimic joints, and joints without a group that neither ros2_control nor a
    transmission has.
    """
    robot = tree.robot
    driven = {joint.name for block in robot.ros2_controls for joint in block.joints}
    driven |= {joint.name for one in robot.transmissions for joint in one.joints}
    grouped = {joint.name for named in chains for joint in named.chain.joints}
    grouped |= {joint.name for gripper in grippers for joint in gripper.joints}
    passive, ungrouped = [], []
    for joint in _list_movable(tree):
        if not tree.is_active(joint) or (joint.name not in grouped and joint.name not in driven):
            passive.append(PassiveJoint(None, joint.name))
        if tree.is_active(joint) and joint.name not in grouped:
            ungrouped.append(joint.name)
    return passive, ungrouped


def _list_movable(tree: BodyTree) -> Iterator[Joint]:
    for body in tree.order:
        joint = tree.get_joint_above(body)
        if joint is not None:
            yield joint


_KINDS = (
    ("arm", frozenset(["arm", "shoulder", "elbow", "wrist", "forearm", "hand"])),
    (
        "leg",
        frozenset(["leg", "hip", "knee", "ankle", "calf", "thigh", "haa", "hfe", "kfe", "foot"]),
    ),
    ("head", frozenset(["head", "neck"])),
    ("torso", frozenset(["torso", "waist", "lift", "spine"])),
)


def guess_kind(chain: KinematicChain) -> str:
    """Guess what a chain is: ``arm``, ``leg``, ``head`` or ``torso``; empty if it is unknown."""
    if chain.is_trunk:
        return "torso"
    names = [set(split_name(f"{joint.name} {joint.child}")) for joint in chain.joints]
    votes = Counter(kind for kind, known in _KINDS for words in names if words & known)
    return votes.most_common(1)[0][0] if votes else ""


def guess_chain_name(chain: KinematicChain, kind: str) -> str:
    """Guess the name of a chain's group: its kind, after what the names of its joints share."""
    prefix = find_common_prefix([joint.name for joint in chain.joints])
    if kind in ("torso", "head") or not prefix:
        return _add_side(kind, chain.joints)
    return prefix if kind in prefix.lower() else f"{prefix}_{kind}"


def _add_side(kind: str, joints: Sequence[Joint]) -> str:
    """Add the side that the names of all joints have, as in ``shoulder_pan_left``."""
    for side, words in (("left", {"left", "l"}), ("right", {"right", "r"})):
        if joints and all(words & set(split_name(joint.name)) for joint in joints):
            return f"{side}_{kind}"
    return kind


def guess_gripper_name(carrier: str, kind: str, *, alone: bool) -> str:
    """Guess the name of a gripper's group: that of its arm, with another kind."""
    if not carrier or alone:
        return kind
    return carrier.replace("arm", kind) if "arm" in carrier else f"{carrier}_{kind}"
