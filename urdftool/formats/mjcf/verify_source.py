"""Expected values from a description, in addition to its tree and masses, for the comparison.

The module shares no code with the exporter. It reads ``<gazebo>`` values from the elements, and
derives rigid bodies from the joints.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...mechanics.reference import Array, turn
from ...model.elements import Joint, Robot
from ...model.read import parse_numbers
from ...source.description import read_description
from ...source.document import Element
from ..common.actuator_config import JointSettings, read_actuator_config
from .options import Options

MOVING = ("revolute", "continuous", "prismatic", "planar", "floating", "spherical", "ball")
DIRECTED = ("revolute", "continuous", "prismatic", "planar")
DRIVE = re.compile(
    "diff_?drive|skid_?steer|ackermann|tricycle|planar_?move|mecanum|hoverboard", re.IGNORECASE
)
"""Names of plugins that drive a robot over the ground."""


@dataclass(frozen=True)
class Source:
    """The values that a description and the options of its export require.

    Attributes:
        robot: The robot, with one root.
        options: Options of the export.
        stands: Whether the export reported a free root because of what supports the robot.
    """

    robot: Robot
    options: Options
    stands: bool = False

    @property
    def root(self) -> str:
        """Return the name of the root link."""
        return self.robot.tree.roots[0].name

    def get_value(self, name: str, *tags: str) -> str | None:
        """Return the last ``<gazebo>`` value for a link or joint under one of some tags."""
        found = None
        for block in self.robot.gazebo:
            if block.element.get("reference") == name:
                for element in block.element.children:
                    if element.tag in tags:
                        found = (element.get("value") or element.text).strip()
        return found

    def list_whole(self, tag: str) -> Iterator[Element]:
        """Yield the elements of a tag in ``<gazebo>`` blocks without reference."""
        for block in self.robot.gazebo:
            if not block.element.get("reference"):
                yield from block.element.list_children(tag)

    def moves(self, joint: Joint) -> bool:
        """Tell whether a joint can move in MuJoCo's model."""
        axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
        if joint.type in DIRECTED and math.hypot(*axis) < 1e-6:
            return False
        if is_locked(joint) and not self.options.keep_locked_joints:
            return False
        return joint.type in MOVING

    @cached_property
    def rigid(self) -> dict[str, str]:
        """Return the topmost link of each link's rigid body."""
        found: dict[str, str] = {self.root: self.root}
        for name in self.robot.tree.order:
            joint = self.robot.tree.get_parent_joint(name)
            if joint is not None:
                found[name] = name if self.moves(joint) else found[joint.parent]
        return found

    @cached_property
    def joined(self) -> set[frozenset[str]]:
        """Return pairs of rigid bodies connected by a joint, other than floating joints."""
        return {
            frozenset((self.rigid[joint.parent], self.rigid[joint.child]))
            for joint in self.robot.joints
            if joint.type != "floating" and {joint.parent, joint.child} <= self.rigid.keys()
        }

    @cached_property
    def separated(self) -> set[frozenset[str]]:
        """Return pairs of links that must not collide: of closed loops, and disabled by an SRDF."""
        pairs = set()
        for joint in self.list_whole("joint"):
            ends = [joint.find_child(end) for end in ("parent", "child")]
            pairs.add(frozenset(e.text.strip().rpartition("::")[2] for e in ends if e is not None))
        return pairs | self.disabled

    @cached_property
    def disabled(self) -> set[frozenset[str]]:
        """Return pairs of links that an SRDF disables."""
        return {
            frozenset((element.get("link1") or "", element.get("link2") or ""))
            for element in (self.srdf.list_children("disable_collisions") if self.srdf else ())
        }

    @cached_property
    def settings(self) -> dict[str, JointSettings]:
        """Return the user's settings of each movable hinge and slide."""
        names = [
            joint.name
            for joint in self.robot.joints
            if joint.type in ("revolute", "continuous", "prismatic")
            and self.moves(joint)
            and not is_locked(joint)
        ]
        if self.options.actuator_config is None:
            return dict.fromkeys(names, JointSettings())
        return read_actuator_config(self.options.actuator_config).match_joints(names)

    @cached_property
    def srdf(self) -> Element | None:
        """Return the root element of the SRDF, if there is one."""
        if self.options.srdf is None:
            return None
        path, source = self.options.srdf, self.robot.source
        finder = None if source is None else source.packages.make_finder_for(path)
        return read_description(path, finder=finder).document.root

    @property
    def is_free(self) -> bool:
        """Tell whether the root is free: by the options, or by the description."""
        if self.root == "world" or self.options.base != "auto":
            return self.root != "world" and self.options.base == "free"
        if self.robot.base is not None:
            return self.robot.base.is_free
        for element in self.list_whole("static"):
            if (element.get("value") or element.text).strip().lower() in ("true", "1", "yes"):
                return False
        virtual = self.srdf.find_child("virtual_joint") if self.srdf is not None else None
        if virtual is not None:
            return virtual.get("type") in ("floating", "planar")
        return self.stands or any(self.drive_plugins)

    @property
    def drive_plugins(self) -> Iterator[Element]:
        """Yield the plugins that drive the robot over the ground."""
        for block in self.robot.gazebo:
            for element in block.element.walk():
                words = f"{element.get('filename') or ''} {element.get('name') or ''}"
                if element.tag == "plugin" and DRIVE.search(words.replace("-", "_")):
                    yield element


def is_locked(joint: Joint) -> bool:
    """Tell whether the limits of a joint allow a single position."""
    if joint.type not in ("revolute", "prismatic") or joint.limit is None:
        return False
    return (joint.limit.lower or 0.0) == (joint.limit.upper or 0.0)


def read_pose(element: Element) -> Array:
    """Read the ``<pose>`` of a Gazebo element as a 4 × 4 matrix [m]."""
    child = element.find_child("pose")
    six = parse_numbers(child.text, 6) if child is not None else None
    pose = np.eye(4)
    if six is not None:
        for axis, angle in zip(np.eye(3), six[3:], strict=True):
            pose[:3, :3] = turn(axis, angle) @ pose[:3, :3]
        pose[:3, 3] = six[:3]
    return pose
