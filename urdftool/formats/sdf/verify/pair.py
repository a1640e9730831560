"""The source of an export and the robot of its file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ....compare.proof import Claims
from ....model.elements import Robot
from ...common.losses import DeclaredLosses
from ..options import Options
from .frames import Array, Frames


@dataclass
class Pair:
    """The source, the exported robot, and what the export declared.

    Attributes:
        robot: The source.
        result: The robot of the file.
        claims: Declared losses and new names.
        declared: Losses that change the behavior, by code and part.
        options: Options of the export.
        where: The model of the file, with its frames.
    """

    robot: Robot
    result: Robot
    claims: Claims
    declared: DeclaredLosses
    options: Options
    where: Frames

    def link(self, name: str) -> str:
        """Return the exported name of a link, or of its frame."""
        return self.claims.renamed.get(("link", name), name)

    def get_joint(self, name: str) -> str:
        """Return the exported name of a joint."""
        return self.claims.renamed.get(("joint", name), name)

    @cached_property
    def bodies(self) -> frozenset[str]:
        """Return the names of the links of the file."""
        return frozenset(e.get("name", "") for e in self.where.model.findall("link"))

    @cached_property
    def joints(self) -> frozenset[str]:
        """Return the names of the joints of the file."""
        return frozenset(e.get("name", "") for e in self.where.model.findall("joint"))

    def place(self, name: str) -> tuple[str, Array] | None:
        """Return the link that holds a link, and the pose in it, 4 × 4; None for no such link.

        In a file without frames, this is the nearest link above over fixed joints.
        """
        return self.where.place(self.robot, name, self.link)
