"""The checks of an export to MJCF: a copy is compiled before a file of the user is touched."""

from __future__ import annotations

from pathlib import Path

from ...model.elements import Robot
from ..check import Check
from ..written import Written
from .options import Options

NOT_COMPARED = (
    "texture coordinates and normals of meshes",
    "names of the model, its classes, geoms, sites and materials",
    "<visual>, <statistic> and <size>",
    "comments",
)
"""What a model holds and no row compares."""


def check_unwritten(
    robot: Robot, options: Options, written: Written, *, verify: bool
) -> list[Check]:
    """Compile a copy of an export, where MuJoCo is installed, and compare it with its source.

    Args:
        robot: The source.
        options: The options it was written with.
        written: The export.
        verify: Whether to compare it; if not, it is compiled alone.

    Raises:
        OutputError: MuJoCo does not compile it.
        MissingDependency: MuJoCo is not installed, and it is to be compared.
    """
    if verify:
        from .verify import verify_copy

        return verify_copy(robot, options, written)
    from .compiled import compile_copy

    compile_copy(written)
    return []


def check_output(
    robot: Robot, options: Options, written: Written, output: str | Path | None
) -> list[Check]:
    """Check nothing: a copy was compared already."""
    return []
