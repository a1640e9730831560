"""Why a file that a robot names cannot be had: one reason, however many files it keeps away."""

from __future__ import annotations

import os
from pathlib import Path

from ...errors import SourceError
from ...model.elements import Robot


def explain_missing_file(robot: Robot, filename: str) -> tuple[str, str]:
    """What is wrong with the name of a file that is not found, and what would help.

    Args:
        robot: The robot.
        filename: The URI or path as it is written.

    Returns:
        What follows "the mesh …" in a sentence, and a hint, the same for all files that are kept
        away by the same thing.
    """
    if not filename or robot.source is None:
        return "names no file", ""
    try:
        path = Path(robot.source.resolve(filename))
    except (SourceError, ValueError) as error:
        return "is not found", error.message if isinstance(error, SourceError) else ""
    if not os.path.isdir(path.parent):
        return "is not there", f"there is no folder {path.parent}"
    return "is not there", f"there is no file {path}"
