"""Names of prims: ASCII letters, digits and underscores, unique among siblings."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from ...model.elements import Robot
from ..common.naming import UniqueNames

RESERVED = ("joints", "materials", "prototypes", "visuals", "collisions")
"""Names of scopes in the stage, which no link gets."""


def make_identifier(text: str, fallback: str = "unnamed") -> str:
    """Replace the characters that a prim name cannot have by underscores."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", text)
    if not name.strip("_"):
        return fallback
    return f"_{name}" if name[0].isdigit() else name


@dataclass(frozen=True)
class Names:
    """Prim names of a robot."""

    robot: str
    link: dict[str, str] = field(default_factory=dict)
    joint: dict[str, str] = field(default_factory=dict)

    @property
    def renamed(self) -> dict[tuple[str, str], str]:
        """Return the new names by kind and old name, of those that changed."""
        kinds = (("link", self.link), ("joint", self.joint))
        return {(kind, old): new for kind, names in kinds for old, new in names.items()
                if old != new}  # fmt: skip


def make_names(robot: Robot, name: str) -> Names:
    """Choose the prim names of a robot; names that are valid stay."""
    return Names(
        make_identifier(name, "robot"),
        _make_unique([link.name for link in robot.links], RESERVED),
        _make_unique([joint.name for joint in robot.joints], ("root_joint",)),
    )


def _make_unique(names: list[str], reserved: tuple[str, ...]) -> dict[str, str]:
    taken = UniqueNames(reserved)
    found = {name: taken.take(name) for name in names if make_identifier(name) == name
             and name not in reserved}  # fmt: skip
    for name in names:
        if name not in found:
            found[name] = taken.take(make_identifier(name))
    return found
