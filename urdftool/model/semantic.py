"""Content of an SRDF, the semantic description of a robot that MoveIt reads.

The parts are those of http://wiki.ros.org/srdf; elements of other tags are not read.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from ..source.document import Element
from .numbers import number
from .part import Part


@dataclass(slots=True)
class Chain(Part):
    """Links from a base link to a tip link."""

    base: str = ""
    tip: str = ""


@dataclass(slots=True)
class Group(Part):
    """Planning group: names of its links, joints and subgroups, and its chains."""

    name: str = ""
    links: list[str] = field(default_factory=list)
    joints: list[str] = field(default_factory=list)
    chains: list[Chain] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)


@dataclass(slots=True)
class StateJoint(Part):
    """Position [rad, m] of a joint in a group state; None if it is not one number."""

    name: str = ""
    value: float | None = None


@dataclass(slots=True)
class GroupState(Part):
    """Named joint positions of a group."""

    name: str = ""
    group: str = ""
    joints: list[StateJoint] = field(default_factory=list)


@dataclass(slots=True)
class EndEffector(Part):
    """End effector: its group, the link it is attached to, and that link's group if given."""

    name: str = ""
    parent_link: str = ""
    group: str = ""
    parent_group: str = ""


@dataclass(slots=True)
class VirtualJoint(Part):
    """Joint between a frame of the world and a link: ``fixed``, ``planar`` or ``floating``."""

    name: str = ""
    type: str = ""
    parent_frame: str = ""
    child_link: str = ""


@dataclass(slots=True)
class PassiveJoint(Part):
    """Joint that is not actuated."""

    name: str = ""


@dataclass(slots=True)
class DisabledPair(Part):
    """Pair of links without collision checks.

    Attributes:
        reason: ``Adjacent``, ``Never``, ``Default``, ``Always``, ``User`` or another text.
        comment: Text of the XML comment that a writer adds on the line; empty for none.
    """

    link1: str = ""
    link2: str = ""
    reason: str = ""
    comment: str = ""

    @property
    def links(self) -> frozenset[str]:
        """Return the two names, without an order."""
        return frozenset((self.link1, self.link2))


@dataclass(slots=True)
class UncheckedLink(Part):
    """Link whose collisions are not checked, but with links that ``<enable_collisions>`` names."""

    name: str = ""


@dataclass(slots=True)
class SemanticDescription(Part):
    """Content of an SRDF, in the order of the file.

    Attributes:
        disabled: Pairs of ``<disable_collisions>``; ``list_disabled`` has those of links, too.
        unchecked: Links of ``<disable_default_collisions>``.
        enabled: Pairs of these links that are checked.
    """

    name: str = ""
    groups: list[Group] = field(default_factory=list)
    states: list[GroupState] = field(default_factory=list)
    end_effectors: list[EndEffector] = field(default_factory=list)
    virtual_joints: list[VirtualJoint] = field(default_factory=list)
    passive_joints: list[PassiveJoint] = field(default_factory=list)
    disabled: list[DisabledPair] = field(default_factory=list)
    unchecked: list[UncheckedLink] = field(default_factory=list)
    enabled: list[DisabledPair] = field(default_factory=list)

    def list_disabled(self, links: Iterable[str]) -> list[DisabledPair]:
        """Return all pairs without collision checks: those that are written, then those of links.

        MoveIt allows contacts of the links without checks, checks the enabled pairs again, and
        allows the disabled pairs last.
        """
        known = {pair.links for pair in (*self.disabled, *self.enabled)}
        pairs = list(self.disabled)
        for one in self.unchecked:
            for other in links:
                ends = frozenset((one.name, other))
                if len(ends) == 2 and ends not in known:
                    known.add(ends)
                    pairs.append(DisabledPair(one.provenance, one.name, other))
        return pairs


def read_semantic(root: Element) -> SemanticDescription:
    """Read the ``<robot>`` element of an SRDF; a missing attribute is empty."""
    return SemanticDescription(
        root,
        _get(root, "name"),
        [_read_group(child) for child in root.list_children("group")],
        [_read_state(child) for child in root.list_children("group_state")],
        [_read_end_effector(child) for child in root.list_children("end_effector")],
        [_read_virtual_joint(child) for child in root.list_children("virtual_joint")],
        [PassiveJoint(child, _get(child, "name")) for child in root.list_children("passive_joint")],
        [_read_pair(child) for child in root.list_children("disable_collisions")],
        [
            UncheckedLink(child, _get(child, "link"))
            for child in root.list_children("disable_default_collisions")
        ],
        [_read_pair(child) for child in root.list_children("enable_collisions")],
    )


def _get(element: Element, name: str) -> str:
    return element.get(name) or ""


def _list_names(element: Element, tag: str) -> list[str]:
    return [_get(child, "name") for child in element.list_children(tag)]


def _read_group(element: Element) -> Group:
    chains = [
        Chain(child, _get(child, "base_link"), _get(child, "tip_link"))
        for child in element.list_children("chain")
    ]
    names = (_list_names(element, tag) for tag in ("link", "joint", "group"))
    links, joints, groups = names
    return Group(element, _get(element, "name"), links, joints, chains, groups)


def _read_state(element: Element) -> GroupState:
    joints = [
        StateJoint(child, _get(child, "name"), number(child.get("value")))
        for child in element.list_children("joint")
    ]
    return GroupState(element, _get(element, "name"), _get(element, "group"), joints)


def _read_end_effector(element: Element) -> EndEffector:
    names = ("name", "parent_link", "group", "parent_group")
    return EndEffector(element, *(_get(element, name) for name in names))


def _read_virtual_joint(element: Element) -> VirtualJoint:
    names = ("name", "type", "parent_frame", "child_link")
    return VirtualJoint(element, *(_get(element, name) for name in names))


def _read_pair(element: Element) -> DisabledPair:
    return DisabledPair(element, *(_get(element, name) for name in ("link1", "link2", "reason")))
