"""Checks of an export to MJCF: a temporary copy is compiled before user files are replaced."""

from __future__ import annotations

from ...compare.check import Check
from ...model.elements import Robot
from ..written import Written
from .options import Options

NOT_COMPARED = (
    "texture coordinates and normals of meshes",
    "names of the model, its classes, geoms, sites and materials",
    "<visual>, <statistic> and <size>",
    "comments",
)
"""Parts of a model that the verification does not compare."""


def check_unwritten(
    robot: Robot, options: Options, written: Written, *, verify: bool
) -> list[Check]:
    """Compile a copy of an export if MuJoCo is installed, and compare it with its source.

    Raises:
        OutputError: MuJoCo does not compile it.
        MissingDependency: MuJoCo is not installed, and ``verify`` is set.
    """
    if verify:
        from .verify import verify_copy

        return verify_copy(robot, options, written)
    from .compiled import compile_copy

    compile_copy(written)
    return []
