"""Comparison of all pairs of several robots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations

from ..model.elements import Robot
from ..source.location import Place
from .compare import compare_robots
from .correspondence import Correspondence
from .declared import compare_declared
from .difference import Comparison, Difference
from .mesh_measure import MeshMeasures
from .names import Line, get_pair
from .rows import EQUIPMENT_ROWS, ROWS, Row

Key = tuple[str, str, str, str]

_BY_PART = (*EQUIPMENT_ROWS, "textures")
"""Rows whose equal values are not recorded."""


@dataclass
class Disagreement:
    """A property that differs between some of the robots.

    Attributes:
        row: Name of its row.
        kind: ``link``, ``joint`` or ``robot``.
        name: Name in the first robot that has the part.
        what: The property.
        unit: Unit of the values.
        note: Explanation of the first difference.
        is_convention: Whether it is a convention only.
        values: Value in each robot; None where there is none, or none was compared.
        places: Location in each file; None where there is none.
        pairs: Numbers of the robots that differ from each other.
        compared: Numbers of the robots whose value was compared.
        is_complete: Whether every pair of the robots was compared in this row.
    """

    row: str
    kind: str
    name: str
    what: str
    unit: str
    note: str
    is_convention: bool
    values: list[object]
    places: list[Place | None]
    pairs: list[tuple[int, int]] = field(default_factory=list)
    compared: set[int] = field(default_factory=set)
    is_complete: bool = True

    def set_side(self, number: int, difference: Difference, side: int) -> None:
        """Set the value and place of a robot, which is one of the two of a difference."""
        self.values[number] = difference.values[side]
        self.compared.add(number)
        if difference.places[side].file.path:
            self.places[number] = difference.places[side]

    @property
    def alone(self) -> int | None:
        """Return the number of the robot that differs from all others, which agree; or None."""
        count = len(self.values)
        if count < 3 or not self.is_complete:
            return None
        for number in range(count):
            others = [pair for pair in self.pairs if number not in pair]
            if not others and len(self.pairs) == count - 1:
                return number
        return None


@dataclass
class Agreement:
    """Result of the comparison of several robots.

    Attributes:
        rows: Compared properties.
        pairs: Comparison of each pair, by the numbers of the robots.
    """

    rows: tuple[Row, ...]
    pairs: dict[tuple[int, int], Comparison]

    @property
    def is_equal(self) -> bool:
        """Tell whether a row compared something, no pair differs, and all that counts was read."""
        return self.has_compared and all(one.is_equal for one in self.pairs.values())

    @property
    def has_compared(self) -> bool:
        """Tell whether a row compared something that one of the robots has."""
        return any(comparison.has_compared for comparison in self.pairs.values())

    @property
    def count(self) -> int:
        """Return the number of robots."""
        return 1 + max(number for pair in self.pairs for number in pair)

    def list_disagreements(self) -> list[Disagreement]:
        """Return the differences of all pairs, one for each property of a part."""
        found: dict[Key, Disagreement] = {}
        for (i, j), comparison in self.pairs.items():
            for difference in comparison.differences:
                key = self._get_key(i, difference)
                entry = found.get(key)
                if entry is None:
                    entry = found[key] = _make_entry(difference, key[2], self.count)
                entry.pairs.append((i, j))
                for side, number in enumerate((i, j)):
                    entry.set_side(number, difference, side)
        for (i, j), comparison in self.pairs.items() if self.count > 2 else ():
            for difference in comparison.equal:
                entry = found.get(self._get_key(i, difference))
                for side, number in enumerate((i, j) if entry is not None else ()):
                    if entry is not None and number not in entry.compared:
                        entry.set_side(number, difference, side)
        for entry in found.values():
            reasons = (one.explain_skipped(entry.row) for one in self.pairs.values())
            entry.is_complete = not any(reasons)
            self._complete(entry)
        order = {row.name: number for number, row in enumerate(self.rows)}
        return sorted(found.values(), key=lambda entry: order[entry.row])

    def _get_key(self, i: int, difference: Difference) -> Key:
        """Return row, kind, name in the first robot and property of a difference."""
        name = difference.names[0] or difference.names[1]
        if i and difference.names[0]:
            first = self.pairs[0, i]
            known = first.joints if difference.kind == "joint" else first.links
            name = {new: old for old, new in known.items()}.get(name, name)
        return difference.row, difference.kind, name, difference.what

    def _complete(self, entry: Disagreement) -> None:
        """Set the value of robots that have the same part as one whose value is known.

        Parts that two robots have are not recorded one by one, unlike values.
        """
        is_part = entry.row in _BY_PART or None in [entry.values[n] for n in entry.compared]
        for (i, j), comparison in self.pairs.items() if is_part else ():
            if comparison.explain_skipped(entry.row) or (i, j) in entry.pairs:
                continue
            if (i in entry.compared) != (j in entry.compared):
                known, new = (i, j) if i in entry.compared else (j, i)
                entry.values[new] = entry.values[known]
                entry.compared.add(new)


def _make_entry(difference: Difference, name: str, count: int) -> Disagreement:
    return Disagreement(
        difference.row,
        difference.kind,
        name,
        difference.what,
        difference.unit,
        difference.note,
        difference.is_convention,
        [None] * count,
        [None] * count,
    )


def compare_all(
    robots: Sequence[Robot],
    *,
    rows: Sequence[Row] = ROWS,
    names: Sequence[Line] | Correspondence = (),
) -> Agreement:
    """Compare all pairs of at least two robots.

    Args:
        robots: The robots.
        rows: Properties to compare.
        names: Known names, ``joint`` or ``link`` and one in each robot, or how the second of two
            robots was made of the first.

    Raises:
        ConfigError: The first robot cannot be what the correspondence declares.
        ModelError: The links of a robot do not form a tree.
    """
    meshes = MeshMeasures()
    if isinstance(names, Correspondence):
        if names.is_declared:
            result = compare_declared(robots[0], robots[1], names, rows=rows, meshes=meshes)
            return Agreement(tuple(rows), {(0, 1): result})
        names = names.names
    pairs = {
        (i, j): compare_robots(
            robots[i], robots[j], rows=rows, names=get_pair(names, i, j), meshes=meshes
        )
        for i, j in combinations(range(len(robots)), 2)
    }
    return Agreement(tuple(rows), pairs)
