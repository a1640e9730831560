"""The end of every export: it is checked, written, and compared with its source."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..model.elements import Robot
from ..model.files import sources
from .check import Check
from .common.directory import write_export
from .registry import ExportOptions, Format
from .written import Written


def finish_export(
    target: Format,
    robot: Robot,
    options: ExportOptions,
    written: Written,
    output: str | Path | None,
    *,
    verify: bool,
    overwrite: bool,
    inputs: Iterable[str | Path] = (),
) -> list[Check]:
    """Check an export, write it, and compare it with its source.

    Args:
        target: The format.
        robot: The source.
        options: The options it was written with.
        written: The export.
        output: The file or the folder; None writes nothing.
        verify: Whether to compare it with its source.
        overwrite: Replace also what urdftool did not write.
        inputs: More files that must not be replaced; those of the robot and options never are.

    Returns:
        The comparisons; none without ``verify``.

    Raises:
        OutputError: It cannot be written, or a reader of the format rejects it.
        MissingDependency: A library that the comparison needs is not installed.
    """
    checks = target.check_unwritten(robot, options, written, verify=verify)
    if output is not None:
        read = [*sorted(sources(robot)), *options.input_files, *inputs]
        write_export(output, written, single=bool(options.file), overwrite=overwrite, inputs=read)
    if verify:
        checks += target.check_output(robot, options, written, output)
    return checks
