"""Last steps of every export: check it, write it, and compare it with its source."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..compare.check import Check
from ..model.elements import Robot
from ..model.files import list_sources
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

    Without an output, nothing is written; ``inputs`` are more files that must not be replaced.

    Returns:
        The comparisons; none without ``verify``.

    Raises:
        OutputError: The export cannot be written, or a reader of the format rejects it.
        MissingDependency: A library that the comparison needs is not installed.
    """
    checks = target.check_unwritten(robot, options, written, verify=verify)
    if output is not None:
        read = [*sorted(list_sources(robot)), *options.input_files, *inputs]
        write_export(output, written, single=bool(options.file), overwrite=overwrite, inputs=read)
    if verify:
        checks += target.check_output(robot, options, written, output)
    return checks
