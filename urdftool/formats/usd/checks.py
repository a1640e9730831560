"""Checks of an export to USD: a temporary copy is compared before user files are replaced."""

from __future__ import annotations

from ...compare.check import Check
from ...model.elements import Robot
from ..written import Written
from .options import Options

NOT_COMPARED = (
    "names of shapes and materials",
    "images inside mesh files",
    "comments",
)
"""Parts of a stage that the verification does not compare."""


def check_unwritten(
    robot: Robot, options: Options, written: Written, *, verify: bool
) -> list[Check]:
    """Compare a copy of an export with its source.

    Raises:
        OutputError: OpenUSD does not open it.
    """
    if not verify:
        return []
    from .verify import verify_copy

    return verify_copy(robot, written, timestep=options.timestep)
