"""The source of an export and the robot of its file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ....compare.proof import Claims
from ....compare.rows import Row
from ....model.elements import Robot
from ..options import Options


@dataclass
class Pair:
    """The source, the exported robot, and what the export declared.

    Attributes:
        robot: The source.
        result: The robot of the file.
        claims: Declared losses and new names.
        options: Options of the export.
        place: Path of the file.
        rows: Compared properties.
    """

    robot: Robot
    result: Robot
    claims: Claims
    options: Options
    place: Path
    rows: Sequence[Row]
