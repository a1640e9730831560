"""Definitions that the server finds, against what xacro used."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from urdftool.errors import UrdftoolError
from urdftool.model.load import make_robot
from urdftool.server.knowledge import Knowledge, RobotState
from urdftool.server.names import Names
from urdftool.server.words import Word
from urdftool.source.description import Description, read_description
from urdftool.source.document import read_file
from urdftool.source.expand import expand_xacro
from urdftool.source.expansion import Expansion
from urdftool.source.packages import Packages

from .peer import find_by_line
from .robots import CORPUS, XacroRobot, find_packages, list_robots

Use = tuple[str, int, str, str]
"""Resolved path, first byte of the element, kind and name."""
Truth = dict[Use, frozenset[tuple[str, int]]]

MOST_ARGUMENTS = 12
"""Arguments of one robot that are changed, one after the other; chosen."""


@dataclass
class Tally:
    """Answers for uses.

    Attributes:
        right: Answers that contain what xacro used.
        only: Answers that are only what xacro used.
        wrong: Other answers.
        nothing: Uses without an answer.
    """

    right: int = 0
    only: int = 0
    wrong: int = 0
    nothing: int = 0

    @property
    def total(self) -> int:
        """Return the number of uses."""
        return self.right + self.wrong + self.nothing

    def add(self, found: set[tuple[str, int]], truth: frozenset[tuple[str, int]]) -> None:
        """Count an answer."""
        if not found:
            self.nothing += 1
        elif truth <= found:
            self.right += 1
            self.only += truth == found
        else:
            self.wrong += 1


@dataclass
class Definitions:
    """Results.

    Attributes:
        robots: Robots that were expanded.
        failed: Robots that were not.
        recorded: Uses that the server recorded, by kind.
        hidden: Uses in code that did not run with the arguments of the server, by kind.
        text: All uses, with the record taken away, by kind.
        peer: All uses, as rde-urdf finds them, by kind.
        without_text: Uses whose name is not written in the element.
    """

    robots: int = 0
    failed: int = 0
    recorded: dict[str, Tally] = field(default_factory=dict)
    hidden: dict[str, Tally] = field(default_factory=dict)
    text: dict[str, Tally] = field(default_factory=dict)
    peer: dict[str, Tally] = field(default_factory=dict)
    without_text: Counter[str] = field(default_factory=Counter)
    missed: list[str] = field(default_factory=list)


def measure_definitions(robots: Iterable[XacroRobot] | None = None) -> Definitions:
    """Ask for the definition of each name that xacro looked up in the robots of the corpus."""
    result = Definitions()
    seen: set[tuple[str, Use]] = set()
    for robot in robots or list_robots():
        try:
            _measure(robot, result, seen)
            result.robots += 1
        except UrdftoolError as error:
            print(f"not expanded: {robot.path.name}: {error.message}", file=sys.stderr)
            result.failed += 1
    return result


def _measure(robot: XacroRobot, result: Definitions, seen: set[tuple[str, Use]]) -> None:
    description = _read(robot, robot.arguments)
    assert description is not None
    names, without = _make_names(robot, description), _make_names(robot, None)
    base = _record(robot, robot.arguments)
    truth = collect(base)
    hidden: Truth = {}
    for arguments in list_other_arguments(base, robot.arguments):
        try:
            found = collect(_record(robot, arguments))
        except UrdftoolError:
            continue
        hidden.update({use: sites for use, sites in found.items() if use not in truth})
    for use, sites in truth.items():
        if _is_new(use, "recorded", seen):
            _ask(use, sites, names, result.recorded, result)
            _ask(use, sites, without, result.text, result)
            _ask_peer(use, sites, names, robot.repository, result)
    for use, sites in hidden.items():
        if _is_new(use, "hidden", seen):
            _ask(use, sites, names, result.hidden, result)


def _is_new(use: Use, what: str, seen: set[tuple[str, Use]]) -> bool:
    """Tell whether a use was not counted for another robot."""
    is_new = (what, use) not in seen
    seen.add((what, use))
    return is_new and use[2] != "file"


def _read(robot: XacroRobot, arguments: dict[str, str]) -> Description:
    return read_description(robot.path, arguments, packages=find_packages(), package_paths=[CORPUS])


def _record(robot: XacroRobot, arguments: dict[str, str]) -> Expansion:
    finder = Packages(robot.path, named=find_packages(), paths=[CORPUS])
    return expand_xacro(read_file(robot.path, finder.files), arguments, finder, record=True)


def collect(expansion: Expansion) -> Truth:
    """Return what xacro used, by use."""
    return {
        (os.path.realpath(one.file.path), one.start, one.kind, one.name): frozenset(
            (os.path.realpath(file.path), start) for file, start in one.definitions
        )
        for one in expansion.lookups or ()
    }


def list_other_arguments(expansion: Expansion, given: dict[str, str]) -> Iterator[dict[str, str]]:
    """Yield the arguments with one that is true or false changed to its contrary."""
    contrary = {"true": "false", "false": "true", "1": "0", "0": "1", "True": "False"}
    known = {name: given.get(name, one.default) for name, one in expansion.arguments.items()}
    changed = [name for name, value in known.items() if value in contrary]
    for name in changed[:MOST_ARGUMENTS]:
        yield {**given, name: contrary[known[name]]}


def _make_names(robot: XacroRobot, description: Description | None) -> Names:
    """Return the names of a robot; without a description, those that the text gives."""
    knowledge = Knowledge()
    knowledge.configure(
        "utf-8", [str(robot.repository)], find_packages(), [str(CORPUS)], (), None, ()
    )
    real = os.path.realpath(robot.path)
    if description is not None:
        files = {os.path.realpath(file.path) for file in description.files}
        state = RobotState([(description, make_robot(description))], files, knowledge.version)
        knowledge.states[real] = state
    return Names(knowledge, real)


def _find_words(names: Names, use: Use) -> list[Word]:
    """Return the names in the source that are a use, those that are no definition first."""
    path, start, kind, name = use
    table = names.tables.get(path)
    written = name.lstrip("*")
    found = [
        word
        for word in (table.words if table is not None else ())
        if word.element.start == start and word.kind == kind
        if word.name == written
        if kind != "name" or word.owner != word.element.tag.removeprefix("xacro:")
    ]
    return sorted(found, key=lambda word: word.is_definition)


def _ask(
    use: Use,
    sites: frozenset[tuple[str, int]],
    names: Names,
    tallies: dict[str, Tally],
    result: Definitions,
) -> None:
    words = _find_words(names, use)
    if not words:
        result.without_text[use[2]] += tallies is result.recorded
        return
    found = {
        (os.path.realpath(one.element.file.path), one.element.start)
        for one in names.find_definitions(words[0])
    }
    tally = tallies.setdefault(_classify(use, sites, names), Tally())
    before = tally.right
    tally.add(found, sites)
    if tally.right == before:
        line = words[0].element.file.position(words[0].start)[0]
        what = next(k for k in ("recorded", "hidden", "text") if getattr(result, k) is tallies)
        result.missed.append(
            f"{what} {Path(use[0]).name}:{line} {use[2]} {use[3]}: {len(found)} answers"
        )


def _classify(use: Use, sites: frozenset[tuple[str, int]], names: Names) -> str:
    """Return the kind of a use: parameters apart from properties."""
    if use[2] != "name":
        return use[2]
    for path, start in sites:
        table = names.tables.get(path)
        for word in table.list_definitions(start) if table is not None else ():
            return "parameter" if word.element.tag == "xacro:macro" else "property"
    return "property"


def _ask_peer(
    use: Use, sites: frozenset[tuple[str, int]], names: Names, folder: Path, result: Definitions
) -> None:
    words = _find_words(names, use)
    if not words:
        return
    tally = result.peer.setdefault(_classify(use, sites, names), Tally())
    found = find_by_line(words[0], folder)
    lines = {
        (path, names.tables[path].words[0].element.file.position(start)[0])
        for path, start in sites
        if path in names.tables and names.tables[path].words
    }
    if found is None:
        tally.nothing += 1
    elif found in lines:
        tally.right += 1
        tally.only += len(lines) == 1
    else:
        tally.wrong += 1
