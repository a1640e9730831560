"""Kinematic tree of a robot, also of an invalid one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from .joint import Joint
from .link import Link


class KinematicTree:
    """Connections of links by joints, for any set of links and joints.

    Invalid structures raise no error: several roots, no root, two parents and loops are readable
    from the attributes.

    Attributes:
        joints_of_child: Joints by the name of their child link.
        joints_of_parent: Joints by the name of their parent link, in the order of the file.
        roots: Links that are not the child of a joint, in the order of the file.
    """

    def __init__(self, links: Mapping[str, Link], joints: Iterable[Joint]) -> None:
        """Index the joints of a robot; of links of one name, the first counts."""
        self._links = links
        self.joints_of_child: dict[str, list[Joint]] = {}
        self.joints_of_parent: dict[str, list[Joint]] = {}
        for joint in joints:
            self.joints_of_child.setdefault(joint.child, []).append(joint)
            self.joints_of_parent.setdefault(joint.parent, []).append(joint)
        self.roots: list[Link] = [
            link for name, link in links.items() if name not in self.joints_of_child
        ]

    @property
    def root(self) -> Link | None:
        """Return the root if there is exactly one, else None."""
        return self.roots[0] if len(self.roots) == 1 else None

    def get_parent_joint(self, link: str) -> Joint | None:
        """Return the first joint whose child is the link; None for a root."""
        joints = self.joints_of_child.get(link)
        return joints[0] if joints else None

    def get_child_joints(self, link: str) -> list[Joint]:
        """Return the joints whose parent is the link."""
        return self.joints_of_parent.get(link, [])

    @cached_property
    def order(self) -> list[str]:
        """Return the names of the links that a root reaches, each once, parents first."""
        seen: dict[str, None] = {}
        todo = [link.name for link in reversed(self.roots)]
        while todo:
            name = todo.pop()
            if name not in seen and name in self._links:
                seen[name] = None
                todo.extend(joint.child for joint in reversed(self.get_child_joints(name)))
        return list(seen)

    @cached_property
    def detached(self) -> list[Link]:
        """Return the links that no root reaches, because of a loop of joints."""
        reached = set(self.order)
        return [link for name, link in self._links.items() if name not in reached]

    def list_ancestors(self, link: str) -> Iterator[str]:
        """Yield the names of the ancestors of a link, nearest first; a loop is traversed once."""
        seen = {link}
        joint = self.get_parent_joint(link)
        while joint is not None and joint.parent not in seen:
            seen.add(joint.parent)
            yield joint.parent
            joint = self.get_parent_joint(joint.parent)

    def list_descendants(self, link: str) -> Iterator[str]:
        """Yield the names of the descendants of a link."""
        seen = {link}
        todo = [joint.child for joint in self.get_child_joints(link)]
        while todo:
            name = todo.pop()
            if name not in seen:
                seen.add(name)
                yield name
                todo.extend(joint.child for joint in self.get_child_joints(name))

    @cached_property
    def bodies(self) -> dict[str, str]:
        """Return for each link the name of the topmost link of its rigid body.

        Links connected by fixed joints form one rigid body.
        """
        owner: dict[str, str] = {}
        for name in self.order:
            joint = self.get_parent_joint(name)
            fixed = joint is not None and joint.is_fixed and joint.parent in owner
            owner[name] = owner[joint.parent] if joint is not None and fixed else name
        for link in self.detached:
            owner.setdefault(link.name, link.name)
        return owner

    @cached_property
    def body_links(self) -> dict[str, list[str]]:
        """Return the names of the links of each rigid body, by the name of its topmost link."""
        members: dict[str, list[str]] = {}
        for name, owner in self.bodies.items():
            members.setdefault(owner, []).append(name)
        return members
