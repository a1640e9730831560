"""``python -m measure.damage.peer [SEEDS [pybullet|examples]]``: simcheck's defects, found by lint.

The eight robots are of pybullet_data; those of example-robot-data are for comparison. A defect
counts as found if lint has a new finding that names what was damaged, and as loud if that is an
error or a warning; simcheck counts new errors and warnings.
"""

from __future__ import annotations

import random
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import urdftool
from urdftool.diagnostic import Severity
from urdftool.rules.mesh.link_extents import get_extents

from .kinds import Robot
from .peer_kinds import PEER_KINDS, Measured
from .robots import EXAMPLES, Sample, of_examples, of_pybullet
from .run import findings, names, said

EIGHT = (
    "a1/a1.urdf",
    "cartpole.urdf",
    "franka_panda/panda.urdf",
    "husky/husky.urdf",
    "kuka_iiwa/model.urdf",
    "laikago/laikago_toes_limits.urdf",
    "mini_cheetah/mini_cheetah.urdf",
    "r2d2.urdf",
)


@dataclass
class Cell:
    """One kind of defect in one robot.

    Attributes:
        loud: How many have an error or a warning, and not only an info.
        missed: The damaged names, and the rules that had something new, of each that was missed.
    """

    tried: int = 0
    found: int = 0
    loud: int = 0
    missed: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        return f"{self.found}/{self.tried}" if self.tried else "–"


def table(
    samples: Iterable[Sample], seeds: int = 1, kinds: Iterable[str] = tuple(PEER_KINDS)
) -> dict[str, dict[str, Cell]]:
    """Plant each kind in each robot, once for each seed; cells by kind and robot."""
    rows: dict[str, dict[str, Cell]] = {kind: {} for kind in kinds}
    for sample in samples:
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            known = {said(f) for f in findings(sample.text, sample, place)}
            extent = _extents(place / "robot.urdf", sample)
            for kind, row in rows.items():
                cell = row[sample.name] = Cell()
                done = {ElementTree.tostring(ElementTree.fromstring(sample.text), "unicode")}
                for seed in range(seeds):
                    root = ElementTree.fromstring(sample.text)
                    robot = Measured(root, place, extent)
                    rng = random.Random(f"{sample.path.stem} {kind} {seed}")
                    damaged = PEER_KINDS[kind](robot, rng)
                    text = ElementTree.tostring(root, encoding="unicode")
                    if damaged is not None and text not in done:
                        done.add(text)
                        _count(cell, text, damaged, robot, sample, known)
    return rows


def _count(
    cell: Cell,
    text: str,
    damaged: set[str],
    robot: Robot,
    sample: Sample,
    known: set[tuple[str, str, str]],
) -> None:
    new = [f for f in findings(text, sample, robot.folder) if said(f) not in known]
    hits = [f.severity for f in new if not damaged or names(f, damaged)]
    cell.tried += 1
    cell.found += bool(hits)
    cell.loud += any(severity > Severity.INFO for severity in hits)
    if not hits:
        cell.missed.append(f"{sorted(damaged)}: {sorted({f.code for f in new})}")


def _extents(path: Path, sample: Sample) -> dict[str, float]:
    """The greatest extent of the collisions of each link [m]."""
    robot = urdftool.load(path, packages=sample.packages)
    boxes = {link.name: get_extents(robot).get_shapes_box(link.collisions) for link in robot.links}
    return {name: max(box.size) for name, box in boxes.items() if box is not None}


def total(rows: dict[str, dict[str, Cell]]) -> Cell:
    """All cells as one."""
    cells = [cell for row in rows.values() for cell in row.values()]
    tried, found, loud = (sum(getattr(c, n) for c in cells) for n in ("tried", "found", "loud"))
    return Cell(tried, found, loud, [line for cell in cells for line in cell.missed])


def main(seeds: int = 1, collection: str = "pybullet") -> None:
    samples = of_pybullet(EIGHT) if collection == "pybullet" else of_examples(EXAMPLES)
    rows = table(samples, seeds)
    for number, sample in enumerate(samples, 1):
        print(f"{number:2} {sample.name}")
    print(" " * 29 + "".join(f"{number:>7}" for number in range(1, len(samples) + 1)))
    for kind, row in rows.items():
        print(f"{kind:29}" + "".join(f"{cell!s:>7}" for cell in row.values()))
    for kind, row in rows.items():
        for name, cell in row.items():
            for line in cell.missed:
                print(f"missed: {kind}: {name} {line}")
    all_of = total(rows)
    for what, count in (("found", all_of.found), ("with an error or warning", all_of.loud)):
        print(f"{count} of {all_of.tried} {what}, {100 * count / all_of.tried:.1f} %")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *sys.argv[2:3])
