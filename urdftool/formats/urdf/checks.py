"""Checks of an export to URDF, which is read back after it is written."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from ...compare.check import Check
from ...compare.compare import compare_robots
from ...compare.difference import Comparison
from ...compare.names import NameMap
from ...model.elements import Robot
from ..common.directory import write_export
from ..common.losses import DeclaredLosses
from ..written import Written
from .options import Options
from .read import read
from .verify_extensions import check_extensions

NOT_COMPARED = ("contact bits", "textures", "world settings", "closed loops")
"""Parts of a description that no check compares."""

_CODES = {
    "tree": ("lossy-ball", "lossy-screw"),
    "collisions": ("lossy-shape",),
    "visuals": ("lossy-shape",),
    "surface": ("lossy-surface",),
    "joint physics": ("lossy-spring",),
}
"""Codes of the losses that explain a difference, by row."""

_ENDS = ("", "_x", "_y", "_z")
"""Ends of the names of hinges in place of a ball joint."""


def check_unwritten(
    robot: Robot, options: Options, written: Written, *, verify: bool
) -> list[Check]:
    """Return no checks: the meshes are compared on disk."""
    return []


def check_output(
    robot: Robot, options: Options, written: Written, output: str | Path | None
) -> list[Check]:
    """Read an export back and compare it with its source.

    Args:
        robot: The source.
        options: Options of the export.
        written: The export.
        output: Path of the written file or folder; None writes a temporary copy.
    """
    if output is not None:
        path = Path(output) if options.file else Path(output) / written.main
        return _compare(robot, written, path)
    with TemporaryDirectory(prefix="urdftool-") as folder:
        copy = Path(folder) / (options.file or "robot")
        write_export(copy, written, single=bool(options.file))
        return _compare(robot, written, copy if options.file else copy / written.main)


def _compare(robot: Robot, written: Written, path: Path) -> list[Check]:
    renamed = {
        kind: {old: new for (of, old), new in written.renamed.items() if of == kind}
        for kind in ("joint", "link")
    }
    names = NameMap(renamed["joint"], renamed["link"])
    result, declared = read(path).robot, DeclaredLosses.from_findings(written.losses)
    checks = _make_checks(compare_robots(robot, result, names=names), declared)
    if robot.xml is None:  # the extensions of a URDF source are copied
        checks += check_extensions(robot, result, path, written.renamed, declared)
    return checks


def _make_checks(comparison: Comparison, declared: DeclaredLosses) -> list[Check]:
    """Return the rows, in which declared losses are announced differences."""
    checks = comparison.make_checks()
    for check in checks:
        codes = _CODES.get(check.name, ())
        for difference in comparison.differences:
            if difference.row == check.name and difference.title in check.differing:
                names = [name.removesuffix(end) for name in difference.names for end in _ENDS]
                known = declared.has_for(codes, *names)
                if check.name in ("mass matrix", "gravity"):
                    known = declared.has_any("lossy-ball", "lossy-screw")
                if known or difference.is_convention:
                    check.differing.remove(difference.title)
                    check.announced.append(difference.title)
    return checks
