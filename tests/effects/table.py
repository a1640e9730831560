"""The table: what rules say of readers, and how it is known.

``fixtures/effects/FAMILY.yaml`` is written by hand::

    zero-axis:
      mujoco:
        says: "rejects the file: axis too small"
        runs:
          - [mujoco, bad.urdf, {outcome: rejects, messages: ~axis too small}]
      moveit:
        says: ...
        sources: [moveit/moveit2 moveit_core/robot_model/src/robot_model.cpp]

A robot is a file of ``fixtures/rules/RULE``, or, without an ending, of ``fixtures/effects/robots``;
after a colon stand edits that give it the defect: ``pendulum: OLD => NEW ;; OLD => NEW``. For
sdformat an empty root link is given a mass, because it would load nothing of the robot otherwise;
``as written:`` before the name leaves it.

``kind`` is a kind of effect that no run shows: ``as intended``, ``as written`` or ``only with the
flag`` (:mod:`urdftool.lint.effect_kinds`). Runs show which readers reject the robot; where an
effect names no kind, a reader gets another robot.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from urdftool.lint.effect_kinds import REJECTS

from .expected import SAME_AS, differences, unlike
from .readers import Robot

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "fixtures" / "effects"
RULES = ROOT / "fixtures" / "rules"
RUNS = TABLE / "runs"
VERSIONS = TABLE / "readers.json"
KINDS = ROOT / "urdftool" / "rules" / "effect_kinds.json"
PACKAGED = ROOT / "urdftool" / "rules" / "effect_sources.json"

AS_WRITTEN = "as written:"
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True)
class Run:
    """One reader on one robot, and what is expected of it."""

    rule: str
    reader: str
    robot: str
    expected: Mapping[str, Any]

    @property
    def same_as(self) -> str | None:
        """The robot that the reader is expected to take this one for."""
        name = self.expected.get(SAME_AS)
        if name and self.robot.startswith(AS_WRITTEN):
            return f"{AS_WRITTEN} {name}"
        return name

    def wrong(self, record: Mapping[str, Any]) -> list[str]:
        """What of a record (robot, then reader, then facts) is not as expected."""
        facts = record[self.robot][self.reader]
        found = list(differences(facts, self.expected))
        if self.same_as:
            found += unlike(facts, record[self.same_as][self.reader])
        return found


@dataclass(frozen=True)
class Row:
    """One sentence of a rule about one or more readers."""

    rule: str
    key: str
    says: str
    runs: tuple[Run, ...]
    sources: tuple[str, ...]
    rejects: tuple[str, ...] = ()
    kind: str = ""


@cache
def rows() -> tuple[Row, ...]:
    """All rows, as the families' files say them."""
    return tuple(row for path in sorted(TABLE.glob("*.yaml")) for row in _rows_of(path))


def _rows_of(path: Path) -> Iterator[Row]:
    for rule, effects in (yaml.load(path.read_text("utf-8"), LOADER) or {}).items():
        for key, row in effects.items():
            unknown = set(row) - {"says", "runs", "sources", "rejects", "kind"}
            if unknown:
                raise ValueError(f"{path.name}: {rule}: {key}: unknown {sorted(unknown)}")
            runs = tuple(
                Run(rule, reader, robot, expected)
                for readers, robot, expected in row.get("runs", ())
                for reader in readers.split(", ")
            )
            more = (tuple(row.get(name, ())) for name in ("sources", "rejects"))
            yield Row(rule, key, row["says"], runs, *more, row.get("kind", ""))


def robot_of(rule: str, robot: str) -> Robot:
    """A robot of the table."""
    name = robot.removeprefix(AS_WRITTEN).strip()
    name, _, changes = name.partition(": ")
    folder = RULES / rule if "." in name else TABLE / "robots"
    file = folder / (name if "." in name else f"{name}.urdf")
    edits = tuple(_edit(change) for change in changes.split(" ;; ")) if changes else ()
    return Robot(file, edits, as_written=robot.startswith(AS_WRITTEN))


def _edit(change: str) -> tuple[str, str]:
    old, arrow, new = change.partition(" =>")
    if not arrow:
        raise ValueError(f"no ' => ' in {change!r}")
    old, new = (part.replace("\\t", "\t").replace("\\n", "\n") for part in (old, new))
    return old, new.removeprefix(" ")


def sound_one(rule: str, robot: str) -> str | None:
    """The sound robot that stands beside one of the table."""
    prefix = f"{AS_WRITTEN} " if robot.startswith(AS_WRITTEN) else ""
    name = robot.removeprefix(AS_WRITTEN).strip()
    if ": " in name:
        return prefix + name.partition(": ")[0]
    good = "good" + name.removeprefix(name.partition(".")[0])
    return prefix + good if (RULES / rule / good).exists() else None


def pairs() -> dict[str, dict[str, set[str]]]:
    """The runs that are recorded: by rule and robot, the readers."""
    found: dict[str, dict[str, set[str]]] = {}
    for row in rows():
        for run in row.runs:
            robots = found.setdefault(row.rule, {})
            robots.setdefault(run.robot, set()).add(run.reader)
            if run.same_as:
                robots.setdefault(run.same_as, set()).add(run.reader)
            elif beside := sound_one(run.rule, run.robot):
                robots.setdefault(beside, set()).add(run.reader)
    return found


def record_of(rule: str) -> dict[str, dict[str, Any]]:
    """What is recorded of a rule: by robot and reader, the facts."""
    path = RUNS / f"{rule}.json"
    return json.loads(path.read_text("utf-8")) if path.exists() else {}  # type: ignore[no-any-return]


def versions() -> dict[str, str]:
    """The versions of the recorded readers, with their names as pages write them."""
    return json.loads(VERSIONS.read_text("utf-8"))  # type: ignore[no-any-return]


_PROGRAMS = {"gz": "sdformat", "gazebo-classic": "sdformat"}


def kinds() -> dict[str, dict[str, dict[str, list[str]]]]:
    """List readers by the kind of an effect on them: by rule and by key of the effect.

    A reader rejects a robot where all its runs of the row end in a rejection or a crash, or where
    the row says so, as other runs of it are of a case that the finding excludes.
    """
    found: dict[str, dict[str, dict[str, list[str]]]] = {}
    for row in rows():
        readers = row.key.partition(" (")[0].split(", ")
        ends = {
            reader: [
                run.expected.get("outcome")
                for run in row.runs
                if run.reader == _PROGRAMS.get(reader, reader)
            ]
            for reader in readers
        }
        rejecting = [
            reader
            for reader, found_ends in ends.items()
            if reader in row.rejects or (found_ends and set(found_ends) <= _REJECTED)
        ]
        others = [reader for reader in readers if reader not in rejecting]
        of_kind = {REJECTS: rejecting, row.kind: others if row.kind else []}
        if any(of_kind.values()):
            listed = {kind: names for kind, names in of_kind.items() if names}
            found.setdefault(row.rule, {})[row.key] = listed
    return found


_REJECTED = {"rejects", "crashes"}


def packaged() -> dict[str, dict[str, str]]:
    """How each sentence is known, as rule pages quote it."""
    titles = versions()
    found: dict[str, dict[str, str]] = {}
    for row in rows():
        parts = []
        if row.runs:
            names = dict.fromkeys(titles[run.reader] for run in row.runs)
            parts.append("run: " + ", ".join(names))
        if row.sources:
            parts.append("source: " + ", ".join(row.sources))
        found.setdefault(row.rule, {})[row.key] = "; ".join(parts)
    return found
