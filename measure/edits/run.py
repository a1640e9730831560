"""Operations made on robots, measured, made undone, and with mistakes."""

from __future__ import annotations

import json
import re
import sys
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path

import numpy as np

import urdftool
from urdftool.edit.finish import Edited
from urdftool.model.elements import Robot

from .engine import Case, Differences, Engine, measure
from .mistakes import is_found, make_generator, plant
from .operations import Operation, list_moving, list_operations, list_zeros

BOUNDS = (1e-9, 1e-9, 1e-8)
"""Largest differences of poses, inertia and mass matrix."""
EVERY = 4
"""Mistakes are planted in each robot of this number."""


@dataclass
class Row:
    """What was measured of an operation.

    Attributes:
        made: Number of results.
        refused: Robots that it refuses, with the reason.
        different: Robots whose result differs by ``verify --map``, and is not written.
        worst: Largest differences of poses, inertia and mass matrix.
        beyond: Robots beyond the bounds.
        bytes_back: Robots of which the way back has every byte.
        numbers_back: Those of which it has equal numbers, within 1e-12.
        other_back: Those of which it has neither.
    """

    made: int = 0
    refused: list[str] = field(default_factory=list)
    different: list[str] = field(default_factory=list)
    worst: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    beyond: list[str] = field(default_factory=list)
    bytes_back: int = 0
    numbers_back: int = 0
    other_back: list[str] = field(default_factory=list)


@dataclass
class Results:
    """All that was measured.

    Attributes:
        read: Number of robots that urdftool and Pinocchio read.
        unread: Number of files that one of them does not read.
        rows: By operation.
        planted: Number of mistakes by operation.
        missed: Mistakes that were not found.
        peer: Lines of the table of the other tool.
    """

    read: int = 0
    unread: int = 0
    rows: dict[str, Row] = field(default_factory=lambda: defaultdict(Row))
    planted: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    missed: list[str] = field(default_factory=list)
    peer: list[str] = field(default_factory=list)


def save_results(results: Results, path: Path) -> None:
    """Write results as JSON."""
    values = vars(results) | {"rows": {name: vars(row) for name, row in results.rows.items()}}
    path.write_text(json.dumps(values), "utf-8")


def merge_results(paths: Sequence[Path]) -> Results:
    """Read the results of several processes, and return their sums."""
    total = Results()
    for path in paths:
        part = json.loads(path.read_text("utf-8"))
        total.read += part["read"]
        total.unread += part["unread"]
        total.missed += part["missed"]
        for name, count in part["planted"].items():
            total.planted[name] += count
        for name, values in part["rows"].items():
            row, other = total.rows[name], Row(**values)
            row.worst = [max(pair) for pair in zip(row.worst, other.worst, strict=True)]
            for one in fields(Row):
                if one.name != "worst":
                    value = getattr(row, one.name) + getattr(other, one.name)
                    setattr(row, one.name, value)
    return total


def open_robot(path: Path) -> tuple[Robot, str] | None:
    """Return a robot with its text; None if urdftool or Pinocchio does not read it."""
    try:
        text = path.read_bytes().decode("utf-8")  # line ends as they are
        Engine(text)
        return urdftool.load(path), text
    except Exception:  # Pinocchio raises several kinds
        return None


def measure_robots(
    paths: Sequence[Path], folder: Path, *, mistakes: bool, save: Path | None = None
) -> Results:
    """Make and measure all operations on robots; save the results after each robot."""
    results = Results()
    for path in paths:
        opened = open_robot(path)
        if opened is None:
            results.unread += 1
            continue
        results.read += 1
        robot, text = opened
        name = "/".join(path.parts[-3:])
        print(name, file=sys.stderr, flush=True)
        for operation in list_operations(robot):
            row = results.rows[operation.name]
            edited = _make(operation, robot, row, name)
            if edited is None:
                continue
            _measure(operation, (robot, text), edited, row, name)
            if operation.back is not None:
                _go_back(operation, (robot, text), edited, row, (name, folder))
            if mistakes and results.read % EVERY == 0:
                _plant(operation, robot, edited, results, (name, folder))
        if save is not None:
            save_results(results, save)
    return results


def _make(operation: Operation, robot: Robot, row: Row, name: str) -> Edited | None:
    try:
        edited = operation.make(robot)
    except urdftool.UrdftoolError as error:
        row.refused.append(f"{name}: {error.message}")
        return None
    row.made += 1
    if not edited.is_proved:
        titles = [d.title for proof in edited.proofs for d in proof.comparison.differences]
        row.different.append(f"{name}: {titles[0]}")
    return edited


def make_case(operation: str, robot: Robot, edited: Edited) -> Case:
    """Return what is expected of a result."""
    start = "p_" if operation == "prefix" else ""
    moving, zeros = list_moving(robot), list_zeros(robot)
    links = {name: start + name for name in robot.link if start + name in edited.robot.link}
    if operation == "root `--move-frames`":
        moved = {words[1] for words in edited.proofs[0].lines if words[0] == "frame"}
        links = {name: new for name, new in links.items() if name not in moved}
    is_root = operation.startswith("root")
    is_part = operation in ("attach", "cut")
    flip = np.diag([1.0, -1.0, 1.0, 1.0]) if operation.startswith("mirror") else np.eye(4)

    def move(positions):
        if operation == "zero":
            return {name: value - zeros[name] for name, value in positions.items()}
        if operation == "sign":
            return {name: -value for name, value in positions.items()}
        return {start + name: value for name, value in positions.items()}

    sign = -1.0 if operation == "sign" else 1.0
    return Case(links, moving, move, flip, sign, start, not is_part, not (is_part or is_root))


def _measure(
    operation: Operation, source: tuple[Robot, str], edited: Edited, row: Row, name: str
) -> None:
    robot, text = source
    case = make_case(operation.name, robot, edited)
    try:
        found = measure(text, edited.data.decode(), case)
    except Exception as error:
        row.beyond.append(f"{name}: not measured: {error}")
        return
    numbers = found[:3]
    row.worst = [max(pair) for pair in zip(row.worst, numbers, strict=True)]
    if any(value > bound for value, bound in zip(numbers, BOUNDS, strict=True)):
        row.beyond.append(f"{name}: {', '.join(f'{value:.1e}' for value in numbers)}")


def _go_back(
    operation: Operation,
    source: tuple[Robot, str],
    edited: Edited,
    row: Row,
    place: tuple[str, Path],
) -> None:
    """Make the opposite operation, and compare the file with the one before."""
    name, folder = place
    path = folder / "there.urdf"
    path.write_bytes(edited.data)
    robot = urdftool.load(path)
    robot.source.packages = edited.robot.source.packages
    assert operation.back is not None
    try:
        back = operation.back(robot)
    except urdftool.UrdftoolError as error:
        row.other_back.append(f"{name}: {error.message}")
        return
    before, text = source
    if back.data.decode() == text:
        row.bytes_back += 1
    elif has_equal_numbers(back.robot, before):
        row.numbers_back += 1
    else:
        row.other_back.append(name)


def has_equal_numbers(one: Robot, two: Robot, tolerance: float = 1e-12) -> bool:
    """Tell whether two robots have the same parts, with numbers within a tolerance."""
    x, y = _describe(one), _describe(two)
    return len(x) == len(y) and all(_is_close(a, b, tolerance) for a, b in zip(x, y, strict=True))


def _describe(robot: Robot) -> list[object]:
    found: list[object] = []
    for joint in robot.joints:
        found += [joint.name, joint.type, joint.parent, joint.child]
        found += joint.origin.xyz if joint.origin else (0.0, 0.0, 0.0)
        found += _flatten_rotation(joint.origin)
        found += (joint.axis.xyz if joint.axis else (1.0, 0.0, 0.0)) if joint.has_axis else ()
        found += (joint.limit.lower or 0.0, joint.limit.upper or 0.0) if joint.limit else ()
        found += (joint.mimic.multiplier, joint.mimic.offset) if joint.mimic else ()
    for link in robot.links:
        body = link.inertial
        found += [link.name, link.mass or 0.0]
        found += body.inertia.six if body and body.inertia else ()
        for part in (body, *link.visuals, *link.collisions):
            if part is not None:
                found += part.origin.xyz if part.origin else (0.0, 0.0, 0.0)
                found += _flatten_rotation(part.origin)
    return found


def _flatten_rotation(origin: object) -> list[float]:
    from urdftool.model.pose import make_pose

    return [value for row in make_pose(origin).rotation for value in row]  # type: ignore[arg-type]


def _is_close(one: object, two: object, tolerance: float) -> bool:
    if isinstance(one, float | int) and isinstance(two, float | int):
        return abs(one - two) <= tolerance * max(1.0, abs(one))
    return one == two


def _plant(
    operation: Operation, robot: Robot, edited: Edited, results: Results, place: tuple[str, Path]
) -> None:
    name, folder = place
    generator = make_generator(f"{name} {operation.name}")
    text, what = plant(edited.data, generator)
    if text is None or not edited.is_proved:
        return
    found = is_found(robot, edited, text, folder)
    if found is None:
        return
    results.planted[operation.name] += 1
    if not found:
        results.missed.append(f"{name}: {operation.name}: {re.sub(' +', ' ', what)}")


def compare_links(found: Differences, bound: float = 1e-6) -> tuple[int, int]:
    """Return the number of links that moved, and of all that were compared."""
    moved = [name for name, away in found.links.items() if away > bound]
    return len(moved), len(found.links)
