"""What the parts of the MJCF reader share: rows, names of links and joints, places."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from ...model.pose import IDENTITY, Pose, rotation_from_quaternion
from ...model.provenance import Written
from ...model.settings import Setting, Settings, Value
from ...model.world import WORLD
from ...source.document import Element
from ..reading import Losses, take_name
from .read_compile import Compiled, Row
from .read_text import Expanded


@dataclass
class Context:
    """State of reading one model."""

    expanded: Expanded
    compiled: Compiled
    losses: Losses
    links: list[str] = field(default_factory=list)
    shifts: list[Pose] = field(default_factory=list)
    joints: list[str] = field(default_factory=list)

    def list_rows(self, kind: str) -> list[Row]:
        """Return the rows of a kind."""
        return self.compiled.rows[kind]

    def get_element(self, row: Row) -> Element:
        """Return the element of a row; the root if its line is unknown."""
        return self.expanded.get_element_at(row["line"])

    def get_place(self, row: Row) -> Written:
        """Return the place of a row."""
        return Written(self.get_element(row).place)

    def compute_pose_in_link(self, row: Row) -> Pose:
        """Return the pose of a part of a body in the frame of its link."""
        return self.shifts[row["bodyid"]] @ read_pose(row)

    def has_link(self, row: Row) -> bool:
        """Tell whether the body of a row is a link."""
        return bool(self.links[row["bodyid"]])


def read_pose(row: Row, position: str = "pos", quaternion: str = "quat") -> Pose:
    """Return the pose in a row."""
    w, x, y, z = row[quaternion]
    turned = rotation_from_quaternion((w, x, y, z))
    is_turned = any((x, y, z))  # w of a turn below 2e-8 rad is 1, too
    return Pose(turned if is_turned else IDENTITY.rotation, tuple(row[position]))


def read_settings(row: Row, settings: Iterable[Setting], written: Written) -> Settings:
    """Return the settings in a row that are not MuJoCo's defaults."""
    found: Settings = {}
    for setting in settings:
        value = row[setting.mjcf.partition(" ")[2]]
        content = tuple(value) if isinstance(value, list) else value
        if content != setting.default:
            found[setting.name] = Value(written, content)
    return found


def name_bodies(context: Context, world: bool) -> None:
    """Name the link of each body; unnamed bodies are named for their parent.

    Args:
        context: The context, whose ``links`` are set.
        world: Whether the world is a link.
    """
    rows = context.list_rows("body")
    taken = {row["name"] for row in rows if row["name"]} | {WORLD}
    context.links = [WORLD if world else ""]
    counts: dict[int, int] = {}
    for row in rows[1:]:
        parent = row["parentid"]
        counts[parent] = number = counts.get(parent, 0) + 1
        invented = f"{context.links[parent] or WORLD}_body{number}"
        context.links.append(row["name"] or take_name(invented, taken))


def name_joints(context: Context) -> set[str]:
    """Name each joint; unnamed joints are named for their body. Return all names."""
    rows = context.list_rows("joint")
    taken = {row["name"] for row in rows if row["name"]}
    for row in rows:
        invented = f"{context.links[row['bodyid']]}_joint"
        context.joints.append(row["name"] or take_name(invented, taken))
    return taken
