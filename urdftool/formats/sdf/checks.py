"""The checks of an export to SDF: it is compared where it was written."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from ...model.elements import Robot
from ..check import Check
from ..common.directory import write_export
from ..written import Written
from .options import Options

NOT_COMPARED = (
    "names of the model, its visuals and collisions",
    "model.config and names.json",
    "comments",
)
"""What a file of an export holds and no row compares."""


def check_unwritten(
    robot: Robot, options: Options, written: Written, *, verify: bool
) -> list[Check]:
    """Check nothing: Gazebo's reader is asked about the output."""
    return []


def check_output(
    robot: Robot, options: Options, written: Written, output: str | Path | None
) -> list[Check]:
    """Read an export back and compare it with its source.

    Args:
        robot: The source.
        options: The options it was written with.
        written: The export.
        output: The file or the folder it was written to; None writes a temporary one.
    """
    from .verify.compare import verify

    if output is not None:
        return verify(robot, written, options, output)
    with TemporaryDirectory(prefix="urdftool-") as folder:
        copy = Path(folder) / (options.file or options.folder)
        write_export(copy, written, single=bool(options.file))
        return verify(robot, written, options, copy)
