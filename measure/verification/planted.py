"""Planted differences: one change of a file, which verify must find at the right part."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from lxml import etree

from urdftool.compare.compare import compare_robots
from urdftool.compare.difference import Difference
from urdftool.compare.mesh_measure import MeshMeasures
from urdftool.errors import UrdftoolError
from urdftool.formats.detect import format_of
from urdftool.formats.registry import format_named
from urdftool.model.elements import Robot

from .changes import Change
from .mjcf_changes import list_mjcf
from .round_trips import export
from .sdf_changes import list_sdf
from .urdf_changes import list_urdf

FORMATS = ("urdf", "sdf", "mjcf")
PAIRS = (
    ("urdf", "urdf"), ("urdf", "sdf"), ("urdf", "mjcf"),
    ("sdf", "sdf"), ("sdf", "mjcf"), ("mjcf", "mjcf"),
)  # fmt: skip
LISTS = {"urdf": list_urdf, "sdf": list_sdf, "mjcf": list_mjcf}

Key = tuple[str, tuple[str, str], str]


@dataclass
class Planted:
    """Result of one planted difference.

    Attributes:
        robot: Name of the robot.
        kind: Kind of the change.
        changed: Format of the changed file.
        other: Format of the other file.
        names: Parts at which it may be reported.
        at_its_part: Titles of the new differences there.
        elsewhere: Titles of the new differences of other links and joints.
        of_robot: Rows of the new differences of the whole robot.
        is_convention: Whether the change is listed at its part, as a convention.
        error: Why the changed file could not be compared.
    """

    robot: str
    kind: str
    changed: str
    other: str
    names: list[str]
    at_its_part: list[str] = field(default_factory=list)
    elsewhere: list[str] = field(default_factory=list)
    of_robot: list[str] = field(default_factory=list)
    is_convention: bool = False
    error: str = ""

    @property
    def is_found(self) -> bool:
        """Tell whether the change was found at its part."""
        return bool(self.at_its_part)

    @property
    def is_exact(self) -> bool:
        """Tell whether it was found at its part, and nothing elsewhere."""
        return self.is_found and not self.elsewhere


@dataclass
class Invented:
    """Differences of two files of one robot.

    Attributes:
        robot: Name of the robot.
        formats: Both formats.
        announced: Differences of parts for which an export reported a loss.
        invented: The others.
    """

    robot: str
    formats: tuple[str, str]
    announced: list[str] = field(default_factory=list)
    invented: list[str] = field(default_factory=list)


class Harness:
    """A robot in every format, whose files are changed one at a time.

    The source is compared with the exports. For a pair of equal formats, the file of the source
    is compared with its export to the same format, if that is the format of the source; else the
    export with itself.
    """

    def __init__(self, robot: Robot, name: str, folder: Path) -> None:
        """Export a robot to every format and read it back.

        Raises:
            UrdftoolError: It cannot be exported.
        """
        self.name, self.source, self.lost = name, robot, set[str]()
        self.files: dict[str, Path] = {}
        for format_ in FORMATS:
            self.files[format_], lost = export(robot, format_, folder / format_)
            self.lost |= lost.keys()
        self.robots = {format_: self.read(format_, self.files[format_]) for format_ in FORMATS}
        assert robot.source is not None
        source = format_of(robot.source.document.file).name
        self.others = {**self.robots, source: robot}
        self.meshes = MeshMeasures()
        self.before: dict[tuple[str, str], list[Difference]] = {}

    @staticmethod
    def read(name: str, path: Path) -> Robot:
        """Read a robot."""
        return format_named(name).read(path).robot

    def compare(self, one: Robot, two: Robot) -> list[Difference]:
        """Return the differences of two robots, and the conventions."""
        return compare_robots(one, two, meshes=self.meshes).differences

    def compare_unchanged(self, one: str, two: str) -> list[Difference]:
        """Return the differences of the unchanged files of a pair of formats."""
        if (one, two) not in self.before:
            self.before[one, two] = self.compare(self.robots[one], self.others[two])
        return self.before[one, two]

    def compare_equal(self) -> Iterator[Invented]:
        """Compare the unchanged files of all pairs."""
        for one, two in PAIRS:
            result = Invented(self.name, (one, two))
            for d in self.compare_unchanged(one, two):
                if d.is_convention:
                    continue
                known = {d.kind, *d.names} & self.lost or (d.kind == "robot" and result.announced)
                if d.row == "base" and self.source.base is None:  # each export chooses and prints
                    known = True
                place = result.announced if known else result.invented
                place.append(f"{d.row}: {d.title} {d.values} {d.note}")
            yield result

    def list_changes(
        self, changed: str, other: str, generator: random.Random
    ) -> dict[str, list[Change]]:
        """Return the changes of a file by kind.

        They are changes of properties that both formats have, at links and joints without a
        difference before the change.
        """
        root = etree.parse(
            str(self.files[changed]), etree.XMLParser(remove_comments=True)
        ).getroot()
        by_kind: dict[str, list[Change]] = {}
        known = {*self.others[other].link, *(f.name for f in self.others[other].frames)}
        own = {*self.robots[changed].link} - known  # frames that were announced as lost
        unequal = {n for d in self.compare_unchanged(changed, other) for n in d.names} - {""}
        for change in LISTS[changed](root, generator):
            has_velocity = "mjcf" not in (changed, other) or not change.kind.startswith("velocity")
            if change.names & unequal:
                continue
            if has_velocity and not (change.names & own and change.kind.startswith("fixed joint")):
                by_kind.setdefault(change.kind, []).append(change)
        return by_kind

    def plant(self, changed: str, other: str, change: Change) -> Planted:
        """Change a file and compare it with another."""
        result = Planted(self.name, change.kind, changed, other, sorted(filter(None, change.names)))
        path = self.files[changed].with_name(f"changed{self.files[changed].suffix}")
        change.apply().write(path)
        unchanged = self.compare_unchanged(changed, other)
        before = {(d.row, d.title, str(d.values)) for d in unchanged}
        try:
            found = self.compare(self.read(changed, path), self.others[other])
        except UrdftoolError as error:
            result.error = error.message
            return result
        for d in found:
            if (d.row, d.title, str(d.values)) in before:
                continue
            text = f"{d.row}: {d.title}"
            if d.is_convention:
                result.is_convention |= bool({*d.names, *d.owners} & change.names)
            elif d.kind in ("robot", "configuration"):
                result.of_robot.append(d.row)
            elif {*d.names, *d.owners} & change.names:
                result.at_its_part.append(text)
            else:
                result.elsewhere.append(text)
        return result


def plant_some(harness: Harness, count: int, generator: random.Random) -> Iterator[Planted]:
    """Plant changes of random kinds at random parts, for each pair of formats in turn."""
    start = generator.randrange(len(PAIRS))
    done: set[tuple[str, str]] = set()
    for number in range(count):
        pair = PAIRS[(start + number) % len(PAIRS)]
        changed, other = generator.sample(pair, 2)
        kinds = harness.list_changes(changed, other, generator)
        left = sorted(kind for kind in kinds if (changed, kind) not in done) or sorted(kinds)
        if not left:
            continue
        kind = generator.choice(left)
        done.add((changed, kind))
        yield harness.plant(changed, other, generator.choice(kinds[kind]))
