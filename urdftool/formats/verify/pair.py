"""Two robots that are compared."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...model.elements import Link
from ...model.part import Part
from ...model.provenance import NOWHERE
from ...source.location import Place
from ..detect import format_of
from ..mechanics import Array
from .bodies import Bodies, Body
from .difference import Comparison, Difference
from .mesh_measure import MeshMeasures


@dataclass
class Pair:
    """Two robots, and the names of the parts of one in the other.

    Attributes:
        a: Bodies of the first robot.
        b: Bodies of the second.
        joints: Joints of the second robot by those of the first.
        links: Links of the second robot by those of the first.
        meshes: Measured meshes of both robots.
    """

    a: Bodies
    b: Bodies
    joints: dict[str, str]
    links: dict[str, str]
    meshes: MeshMeasures = field(default_factory=MeshMeasures)

    @property
    def formats(self) -> tuple[str, str]:
        """Return the names of the formats of both robots."""
        return get_format(self.a), get_format(self.b)

    def match_members(self, one: Body, two: Body) -> list[tuple[str, str]]:
        """Return the links of two bodies that have equal or mapped names."""
        pairs = [(name, self.links.get(name, name)) for name in one.members]
        return [(x, y) for x, y in pairs if y in two.members]


@dataclass
class Match:
    """Two bodies that are compared.

    Attributes:
        one: Body of the first robot.
        two: Body of the second.
        frame: Pose of the frame of ``two`` in that of ``one``, 4 × 4.
    """

    one: Body
    two: Body
    frame: Array


def get_format(bodies: Bodies) -> str:
    """Return the name of the format of a robot; ``urdf`` for one without a file."""
    source = bodies.robot.source
    return "urdf" if source is None else format_of(source.document.file).name


def locate(part: Part | None, owner: Part | None) -> Place:
    """Return the place of a part, or that of its owner if it is None or generated."""
    for candidate in (part, owner):
        if candidate is not None and candidate.provenance is not None:
            return candidate.place
    return NOWHERE


def add_presence(
    comparison: Comparison,
    row: str,
    kind: str,
    what: str,
    side: int,
    part: Part,
    name: str,
    value: object,
    *,
    other: Part | None = None,
) -> None:
    """Record a part that only one robot has.

    Args:
        comparison: Where it is recorded.
        row: Its row.
        kind: ``link`` or ``joint``.
        what: What it is.
        side: 0 if the first robot has it, else 1.
        part: The part.
        name: Name of its link or joint.
        value: Description of the part.
        other: The part of the other robot that should have it.
    """
    here, there = locate(part, None), locate(other, None)
    names = (name, "") if side == 0 else ("", name)
    values = (value, None) if side == 0 else (None, value)
    places = (here, there) if side == 0 else (there, here)
    comparison.add(Difference(row, kind, names, what, values, "", float("inf"), places))


def get_members(bodies: Bodies, body: Body) -> list[tuple[Link, Array]]:
    """Return the links of a body with their poses in its frame."""
    return [(bodies.robot.link[name], pose) for name, pose in body.members.items()]
