"""Differences of two robots, and their collection."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

from ..model.provenance import NOWHERE
from ..source.location import Place
from .check import Check
from .rows import Row
from .uncompared import COUNTED, Uncompared, explain_row

EXISTENCE = "existence"
"""Property of a part that only one robot has."""

THERE = "there"
"""Value of a part that only one robot has, and that is not described."""

RENAMED = "renamed"
"""Property of a part that only has another name."""


class Located(Protocol):
    """Part or element with a location."""

    @property
    def place(self) -> Place:
        """Return the span in the source."""


Sides = tuple[Located | None, Located | None]
"""A part of both robots; None where it does not exist."""


def name_part(kind: str, name: str) -> str:
    """Return kind and name of a part, or the kind of a part without a name."""
    return f"{kind} '{name}'" if name else kind


@dataclass(frozen=True)
class Difference:
    """A property that differs.

    Attributes:
        row: Name of its row.
        kind: ``link``, ``joint`` or ``robot``; the tag of an element or block; or what plain URDF
            lacks, such as ``closed loop``.
        names: Name of the part in each robot; empty where it does not exist.
        what: The property, such as ``upper limit``.
        values: Value in each robot; None where there is none.
        unit: Unit of the values; empty for none.
        amount: Size of the difference, comparable with the tolerance of the row.
        places: Location in each file.
        note: Explanation, such as ``opposite direction``.
        is_convention: Whether the robots are equal except for a convention, which causes no
            difference in motion, contact or mass.
        owners: Names of the links or joints of a part, such as a sensor, in both robots.
    """

    row: str
    kind: str
    names: tuple[str, str]
    what: str
    values: tuple[object, object]
    unit: str
    amount: float
    places: tuple[Place, Place]
    note: str = ""
    is_convention: bool = False
    owners: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Return the name in the first robot, or in the second if the first has no such part."""
        return self.names[0] or self.names[1]

    @property
    def title(self) -> str:
        """Return kind, name and property; the property of the whole robot alone."""
        if self.kind == "robot" and not self.name:
            return self.what
        return f"{name_part(self.kind, self.name)}: {self.what}"

    @property
    def new_name(self) -> str:
        """Return the name in the second robot, or in the first if the second has no such part."""
        return self.names[1] or self.names[0]

    @property
    def place(self) -> Place | None:
        """Return the location in the second file, or in the first; None without one."""
        return next((place for place in reversed(self.places) if place.path), None)


def describe_change(
    row: str,
    kind: str,
    name: str,
    what: str,
    values: tuple[object, object],
    sides: Sides,
    unit: str = "",
    note: str = "",
) -> Difference:
    """Return a difference of a part that has one name: that in the second robot."""
    one, two = (NOWHERE if side is None else side.place for side in sides)
    return Difference(row, kind, (name, name), what, values, unit, math.inf, (one, two), note)


def describe_presence(
    row: str, kind: str, name: str, sides: Sides, what: str = EXISTENCE
) -> Difference:
    """Return the difference that only one robot has a part or an element."""
    one, two = (None if side is None else THERE for side in sides)
    return describe_change(row, kind, name, what, (one, two), sides)


@dataclass
class Comparison:
    """Result of the comparison of two robots.

    Attributes:
        rows: Compared properties.
        differences: What differs.
        not_comparable: Properties that a format of the two does not have.
        partial: Rows with such properties.
        links: Names of matched links in the second robot, by those in the first.
        joints: Names of matched joints in the second robot, by those in the first.
        worst: Largest difference of each row; rows of which no robot has a part are absent.
        skipped: Rows that were not computed, with the reason.
        uncompared: Parts of computed rows that were not compared.
        equal: Properties of both robots that do not differ.
    """

    rows: tuple[Row, ...]
    differences: list[Difference] = field(default_factory=list)
    not_comparable: list[str] = field(default_factory=list)
    partial: set[str] = field(default_factory=set)
    links: dict[str, str] = field(default_factory=dict)
    joints: dict[str, str] = field(default_factory=dict)
    worst: dict[str, float] = field(default_factory=dict)
    skipped: dict[str, str] = field(default_factory=dict)
    uncompared: list[Uncompared] = field(default_factory=list)
    equal: list[Difference] = field(default_factory=list)

    @property
    def tolerances(self) -> dict[str, float]:
        """Return the tolerances of the compared rows."""
        return {row.name: row.tolerance for row in self.rows}

    def add(self, difference: Difference) -> None:
        """Record a property of both robots; it counts only above the tolerance of its row."""
        tolerance = self.tolerances.get(difference.row)
        if tolerance is None:
            return
        amount = difference.amount
        if not difference.is_convention:
            before = self.worst.get(difference.row, 0.0)
            self.worst[difference.row] = amount if amount != amount else max(before, amount)
        (self.equal if amount <= tolerance else self.differences).append(difference)

    def record_parts(self, row: str, *parts: object) -> None:
        """Record that a row compares something, if a robot has such parts."""
        if any(parts):
            self.worst.setdefault(row, 0.0)

    def start_check(self, row: Row) -> Check:
        """Return the row of the table for a property, without its differences."""
        return Check(
            row.name,
            row.what,
            row.tolerance,
            self.worst.get(row.name, 0.0),
            skipped=self.explain_skipped(row.name),
            is_empty=row.name not in self.worst,
            is_partial=row.name in self.partial,
        )

    def merge(self, other: Comparison) -> None:
        """Record what another comparison found in the compared rows."""
        for row in other.worst.keys() & self.tolerances.keys():
            self.worst[row] = max(self.worst.get(row, 0.0), other.worst[row])
        self.differences += [d for d in other.differences if d.row in self.tolerances]
        for part in other.uncompared:
            self.record_uncompared(part)

    def record_uncompared(self, part: Uncompared) -> None:
        """Record a part of a compared row that was not compared."""
        if part.row in self.tolerances and part not in self.uncompared:
            self.uncompared.append(part)

    def explain_skipped(self, row: str) -> str:
        """Return why a row, or what part of it, was not compared; empty if it was."""
        reasons = self.skipped.get(row, ""), explain_row(self.uncompared, row)
        return "; ".join(reason for reason in reasons if reason)

    def list_skipped(self) -> dict[str, str]:
        """Return why rows, or what parts of them, were not compared."""
        found = ((row.name, self.explain_skipped(row.name)) for row in self.rows)
        return {**self.skipped, **{row: why for row, why in found if why}}

    def record_not_comparable(self, row: str, what: str) -> None:
        """Record a property of a row that one of the formats does not have."""
        if row in self.tolerances:
            self.partial.add(row)
        if what not in self.not_comparable:
            self.not_comparable.append(what)

    @property
    def is_different(self) -> bool:
        """Tell whether more than conventions differs."""
        return not all(difference.is_convention for difference in self.differences)

    @property
    def is_equal(self) -> bool:
        """Tell whether nothing but conventions differs, and all was read that a row compares."""
        return not self.is_different and all(one.kind not in COUNTED for one in self.uncompared)

    @property
    def has_compared(self) -> bool:
        """Tell whether a row compared something that one of the two has."""
        return any(check.verdict not in ("none", "not compared") for check in self.make_checks())

    def make_checks(self) -> list[Check]:
        """Return a row of the table for each property that was compared."""
        checks = []
        for row in self.rows:
            if row.name in self.skipped:
                continue
            check = self.start_check(row)
            for difference in self.differences:
                if difference.row == row.name:
                    place = check.announced if difference.is_convention else check.differing
                    if difference.title not in place:
                        place.append(difference.title)
            checks.append(check)
        return checks
