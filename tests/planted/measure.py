"""Make each change and ask ``--verify``."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from lxml import etree

from urdftool.formats.check import Check
from urdftool.formats.directory import write_directory
from urdftool.formats.written import Written
from urdftool.model.elements import Robot
from urdftool.model.load import load

from . import mjcf, sdf
from .change import Planted

FOLDER = Path(__file__).resolve().parents[2] / "fixtures" / "formats" / "everything"
ROBOT = FOLDER / "everything.urdf"
CHANGES: dict[str, Sequence[Planted]] = {"mjcf": mjcf.CHANGES, "sdf": sdf.CHANGES}


def changed(written: Written, planted: Planted | None) -> Written:
    """Return an export with a change in its model."""
    files = dict(written.files)
    if planted is not None:
        root = etree.fromstring(written.text.encode())
        planted.edit(root)
        files[written.main] = etree.tostring(root)
    return replace(written, files=files)


def differing(form: str, planted: Planted | None) -> list[Check]:
    """Return the rows that find a difference in an export with a change.

    Args:
        form: ``mjcf`` or ``sdf``.
        planted: The change; None for none, where nothing should be found.
    """
    return [c for c in compared(form, planted) if c.verdict == "differs"]


def compared(form: str, planted: Planted | None) -> list[Check]:
    """Return all rows of the comparison of an export with a change."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "everything"
        return (_mjcf if form == "mjcf" else _sdf)(load(ROBOT), folder, planted)


def _mjcf(robot: Robot, folder: Path, planted: Planted | None) -> list[Check]:
    from urdftool.formats.mjcf.options import Options
    from urdftool.formats.mjcf.verify import verify
    from urdftool.formats.mjcf.write import write

    options = Options(srdf=FOLDER / "everything.srdf")
    written = changed(write(robot, options), planted)
    write_directory(folder, written.files, main=written.main)
    return verify(robot, written, folder / written.main, written, options)


def _sdf(robot: Robot, folder: Path, planted: Planted | None) -> list[Check]:
    from urdftool.formats.sdf.options import Options
    from urdftool.formats.sdf.verify.compare import compare, pair_of
    from urdftool.formats.sdf.write import write

    options = Options()
    written = changed(write(robot, options), planted)
    write_directory(folder, written.files, main=written.main)
    return compare(pair_of(robot, written, folder / written.main, options))
