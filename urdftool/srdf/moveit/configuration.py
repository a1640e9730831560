"""What the files of a MoveIt configuration package are about."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ...model.elements import Joint, Robot
from ...model.semantic import Group, SemanticDescription
from ...model.semantic_groups import list_joints_of_group
from ..body_tree import BodyTree
from .distributions import Distribution


@dataclass(frozen=True)
class DescriptionFile:
    """File of the robot description, as another package refers to it.

    Attributes:
        package: ROS package of the file; empty if it is in none.
        path: Its path in this package, with ``/``; without a package, its absolute path.
        arguments: Values of xacro arguments.
    """

    package: str
    path: str
    arguments: dict[str, str]

    @property
    def location(self) -> str:
        """Return the path for xacro."""
        return f"$(find {self.package})/{self.path}" if self.package else self.path


@dataclass(frozen=True)
class Configuration:
    """Content of a MoveIt configuration package."""

    robot: Robot
    semantic: SemanticDescription
    description: DescriptionFile
    package: str
    stem: str
    distribution: Distribution

    @cached_property
    def tree(self) -> BodyTree:
        """Return the tree of rigid bodies."""
        return BodyTree(self.robot)

    @cached_property
    def active_joints(self) -> list[Joint]:
        """Return the joints with one position that do not mimic another."""
        above = map(self.tree.get_joint_above, self.tree.order)
        return [joint for joint in above if joint is not None and self.tree.is_active(joint)]

    @cached_property
    def groups(self) -> dict[str, Group]:
        """Return the groups by name; the first of duplicates."""
        found: dict[str, Group] = {}
        for group in self.semantic.groups:
            found.setdefault(group.name, group)
        return found

    def list_group_joints(self, group: Group) -> list[Joint]:
        """List the active joints of a group, as MoveIt does: of its links, joints and chains."""
        names = list_joints_of_group(self.semantic, group.name, self.robot)
        passive = {joint.name for joint in self.semantic.passive_joints}
        return [one for one in self.active_joints if one.name in names and one.name not in passive]

    def is_gripper(self, group: Group) -> bool:
        """Tell whether a group is that of an end effector."""
        return any(one.group == group.name for one in self.semantic.end_effectors)
