"""Checks of an export to SDF, which is compared after it is written."""

from __future__ import annotations

from pathlib import Path

from ...compare.check import Check
from ...model.elements import Robot
from ..common.directory import place_export
from ..written import Written
from .options import Options

NOT_COMPARED = (
    "names of the model, its visuals and collisions",
    "model.config and names.json",
    "comments",
)
"""Parts of an export that the verification does not compare."""


def check_output(
    robot: Robot, options: Options, written: Written, output: str | Path | None
) -> list[Check]:
    """Read an export back and compare it with its source.

    Without an output, it is a temporary copy.
    """
    from .verify.compare import verify

    name = options.file or options.folder
    with place_export(written, output, name, single=bool(options.file)) as path:
        return verify(robot, written, options, path)
