"""Plant changes in an export and compare it with ``--verify``."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from lxml import etree

from urdftool.compare.check import Check
from urdftool.formats.common.directory import write_directory
from urdftool.formats.mjcf.options import Options as MjcfOptions
from urdftool.formats.mjcf.verify import verify
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.formats.sdf.options import Options as SdfOptions
from urdftool.formats.sdf.verify.compare import compare, read_pair
from urdftool.formats.sdf.write import write as write_sdf
from urdftool.formats.written import Written
from urdftool.model.elements import Robot
from urdftool.model.load import load

from . import mjcf, sdf
from .change import Planted

FOLDER = Path(__file__).resolve().parents[2] / "fixtures" / "formats" / "everything"
CHANGES: dict[str, Sequence[Planted]] = {"mjcf": mjcf.CHANGES, "sdf": sdf.CHANGES}
MJCF = MjcfOptions(srdf=FOLDER / "everything.srdf")
SDF = SdfOptions()


@dataclass(frozen=True)
class Found:
    """What was found of a change.

    Attributes:
        planted: The change.
        rows: The rows that differ, by their names.
    """

    planted: Planted
    rows: list[str]

    @property
    def is_right(self) -> bool:
        """Whether the row that has to differ does."""
        return self.planted.row in self.rows


def measure(form: str) -> list[Found]:
    """Plant each change of a format."""
    return [Found(one, [c.name for c in differing(form, one)]) for one in CHANGES[form]]


def differing(form: str, planted: Planted | None) -> list[Check]:
    """Return the rows that differ in an export with a change.

    Args:
        form: ``mjcf`` or ``sdf``.
        planted: The change; None for none, with which nothing should differ.
    """
    robot, written = exported(form)
    files = dict(written.files)
    if planted is not None:
        root = etree.fromstring(written.text.encode())
        planted.edit(root)
        files[written.main] = etree.tostring(root)
    written = replace(written, files=files)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "everything"
        write_directory(folder, written.files, main=written.main)
        place = folder / written.main
        if form == "mjcf":
            checks = verify(robot, written, place, written, MJCF)
        else:
            checks = compare(read_pair(robot, written, place, SDF))
    return [check for check in checks if check.verdict == "differs"]


@cache
def exported(form: str) -> tuple[Robot, Written]:
    """Return the robot and its export."""
    robot = load(FOLDER / "everything.urdf")
    return robot, write_mjcf(robot, MJCF) if form == "mjcf" else write_sdf(robot, SDF)
