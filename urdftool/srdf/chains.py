"""Kinematic chains of a robot that are worth planning: arms, legs, heads and torsos."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..model.elements import Joint
from .body_tree import BodyTree
from .grippers import Gripper
from .name_parts import is_wheel_name, split_name

_TIPS = tuple(
    re.compile(rf"(?:^|[_\W])(?:{words})$", re.IGNORECASE)
    for words in ("tool0", "tcp|tool", "ee|eef|ee_link|end_effector|link_eef", "flange|ee_frame")
)
"""Names of the frame at the end of an arm, the best first: REP 199, then those of vendors."""

_SENSORS = frozenset(["imu", "camera", "optical", "sensor", "laser", "lidar"])
_WORLDS = frozenset(("world", "map", "odom", "base_footprint"))
_SHORT = 2
"""Least number of joints of a chain, unless it carries other chains; chosen, no source."""


@dataclass(frozen=True)
class KinematicChain:
    """Chain from a base link to a tip link.

    Attributes:
        base: Name of the base link.
        tip: Name of the tip link.
        joints: Joints with one position between them, from the base to the tip.
        is_trunk: Whether it carries further chains.
    """

    base: str
    tip: str
    joints: list[Joint]
    is_trunk: bool = False

    def list_active(self, tree: BodyTree) -> list[Joint]:
        """List the joints that do not mimic another."""
        return [joint for joint in self.joints if tree.is_active(joint)]


def find_chains(tree: BodyTree, grippers: Sequence[Gripper]) -> list[KinematicChain]:
    """Find the chains of a robot, in the order of their bodies; trunks before what they carry."""
    fingers = {joint.child for gripper in grippers for joint in gripper.joints}
    kept = _keep_bodies(tree, fingers)
    ends = [body for body in tree.order if body in kept and _is_end(tree, kept, body)]
    palms = {gripper.body: gripper for gripper in grippers}
    runs = [_list_run(tree, kept, body) for body in ends]
    return [
        _make_chain(tree, kept, run, palms.get(body))
        for body, run in zip(ends, runs, strict=True)
        if any(map(tree.is_active, run))
    ]


def measure_chain(tree: BodyTree, base: str, tip: str) -> KinematicChain | None:
    """Return the chain between two links; None if the tip does not descend from the base."""
    if base != tip and base not in set(tree.robot.tree.list_ancestors(tip)):
        return None
    joints: list[Joint] = []
    link = tip
    while link != base:
        joint = tree.robot.tree.get_parent_joint(link)
        assert joint is not None
        if not joint.is_fixed:
            joints.append(joint)
        link = joint.parent
    return KinematicChain(base, tip, joints[::-1])


def _keep_bodies(tree: BodyTree, fingers: set[str]) -> set[str]:
    """Return the bodies without fingers, wheels and other single joints at the side of a chain."""
    kept = {body for body in tree.order if body not in fingers}
    while True:
        dropped = {
            joint.child
            for body in tree.order
            if body in kept and body not in _list_carriers(tree, kept)
            for joint in _list_weak_run(tree, kept, body)
        }
        if not dropped:
            return kept
        kept -= dropped


def _list_carriers(tree: BodyTree, kept: set[str]) -> set[str]:
    """Return the kept bodies that have a kept child."""
    above = (tree.get_joint_above(body) for body in kept)
    return {tree.get_body(joint.parent) for joint in above if joint is not None}


def _list_weak_run(tree: BodyTree, kept: set[str], body: str) -> list[Joint]:
    """List the joints of the run that ends at a body, if it is not worth planning."""
    run = _list_run(tree, kept, body)
    active = [joint for joint in run if tree.is_active(joint)]
    if len(active) < _SHORT:
        return [] if len(tree.active) == 1 and active and active[0].type != "continuous" else run
    start = tree.get_body(run[0].parent)
    beside = len(_list_kept_below(tree, kept, start)) > 1
    return run if beside and len(active) == _SHORT and _is_caster(active) else []


def _is_caster(active: Sequence[Joint]) -> bool:
    """Tell whether two joints in a row are a steered wheel."""
    return active[-1].type == "continuous" and any(map(is_wheel_name, active))


def _list_run(tree: BodyTree, kept: set[str], body: str) -> list[Joint]:
    """List the joints from the nearest body with several kept children to a body."""
    run: list[Joint] = []
    while (joint := tree.get_joint_above(body)) is not None:
        run.append(joint)
        body = tree.get_body(joint.parent)
        if len(_list_kept_below(tree, kept, body)) > 1:
            break
    return run[::-1]


def _list_kept_below(tree: BodyTree, kept: set[str], body: str) -> list[Joint]:
    return [joint for joint in tree.get_joints_below(body) if joint.child in kept]


def _is_end(tree: BodyTree, kept: set[str], body: str) -> bool:
    """Tell whether a chain ends at a body: it has no or several kept children."""
    return len(_list_kept_below(tree, kept, body)) != 1


def _make_chain(
    tree: BodyTree, kept: set[str], run: list[Joint], gripper: Gripper | None
) -> KinematicChain:
    last = run[-1].child
    below = _list_kept_below(tree, kept, last)
    if below:
        tip = last
    elif gripper is not None and gripper.parent_link:
        tip = gripper.parent_link
    else:
        tip = choose_tip(tree, last)
    return KinematicChain(_choose_base(tree, kept, run[0]), tip, run, bool(below))


def choose_tip(tree: BodyTree, body: str) -> str:
    """Choose the tip link of the last body of a chain.

    It is a frame with a known name, else the end of a single row of links, else the topmost link.
    """
    links = tree.get_links(body)
    for pattern in _TIPS:
        for name in links:
            if pattern.search(name):
                return name
    members = set(links)
    name = body
    while True:
        below = [j.child for j in tree.robot.tree.get_child_joints(name) if j.child in members]
        if len(below) > 1:
            return body
        if not below or _SENSORS.intersection(split_name(below[0])):
            return name
        name = below[0]


def _choose_base(tree: BodyTree, kept: set[str], first: Joint) -> str:
    """Choose the base link of a chain: the last bare frame before its first geometry.

    Links on the way to other chains do not count, unless there are no others.
    """
    body = tree.get_body(first.parent)
    others = [j.parent for j in _list_kept_below(tree, kept, body) if j is not first]
    path = _list_path(tree, body, first.parent)
    shared = set(_list_shared(tree, body, others))
    own = [name for name in path if name not in shared and name.lower() not in _WORLDS]
    if not own:
        return first.parent
    bare = []
    for name in own:
        if not tree.robot.link[name].is_frame:
            break
        bare.append(name)
    return bare[-1] if bare else own[0]


def _list_shared(tree: BodyTree, body: str, links: Iterable[str]) -> list[str]:
    return [name for link in links for name in _list_path(tree, body, link)]


def _list_path(tree: BodyTree, body: str, link: str) -> list[str]:
    """List the links from the topmost one of a body to another one."""
    path = [link, *tree.robot.tree.list_ancestors(link)]
    return path[: path.index(body) + 1][::-1]
