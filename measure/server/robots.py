"""The xacro robots of the corpus, with the arguments of its list."""

from __future__ import annotations

import csv
import os
from pathlib import Path
from typing import NamedTuple

CORPUS = (Path(__file__).resolve().parents[3] / "shared" / "corpus").resolve()

STRANDBEEST = "RobotLocomotion__drake/examples/multibody/strandbeest/model"
FRANKA = "frankaemika__franka_description/robots"
LARGEST = (
    "ros__xacro/test/robots/pr2/pr2.urdf.xacro",
    f"{STRANDBEEST}/StrandbeestBushings.urdf.xacro",
    f"{STRANDBEEST}/StrandbeestConstraints.urdf.xacro",
    f"{FRANKA}/fr3/fr3.urdf.xacro",
    f"{FRANKA}/multi_arm/multi_arm.urdf.xacro",
)
"""The five xacro robots of the corpus with the most elements after expansion."""


class XacroRobot(NamedTuple):
    """A robot of the corpus.

    Attributes:
        path: Its file.
        arguments: Arguments of its expansion.
    """

    path: Path
    arguments: dict[str, str]

    @property
    def repository(self) -> Path:
        """Return the folder of its repository."""
        return CORPUS / self.path.relative_to(CORPUS).parts[0]


def list_robots() -> list[XacroRobot]:
    """Return the xacro robots that the list of the corpus has."""
    found = []
    with (CORPUS / "MANIFEST.tsv").open(encoding="utf-8") as table:
        for row in csv.DictReader(table, delimiter="\t"):
            if row["kind"] == "xacro":
                words = (row["xacro_args"] or "").split()
                pairs = [word.split(":=", 1) for word in words if ":=" in word]
                found.append(XacroRobot(CORPUS / row["path"], dict(pairs)))
    return found


def find_packages() -> dict[str, str]:
    """Return the folders of the packages of the corpus by name."""
    with (CORPUS / "PACKAGE_ROOTS.tsv").open(encoding="utf-8") as table:
        rows = csv.DictReader(table, delimiter="\t")
        return {row["package"]: os.path.join(CORPUS, row["dir"]) for row in rows}
