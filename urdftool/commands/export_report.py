"""What every export says and does at its end: losses, the comparison, the files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import click

from ..console import Console
from ..report.counted import counted
from ..terminal import visible

if TYPE_CHECKING:
    from ..finding import Finding
    from ..formats.check import Check
    from ..formats.registry import ExportOptions, Format
    from ..formats.written import Written
    from ..model.elements import Robot


def report_refused(findings: Sequence[Finding], *, as_json: bool) -> int:
    """Every defect, one a line; nothing is written."""
    from ..formats.common.loss_report import format_lines

    if as_json:
        from ..report.exports import to_json

        click.echo(to_json(None, (), findings, ()), nl=False)
    report = list(format_lines(findings))
    for line in report:
        click.echo(visible(line), err=True)
    click.echo(f"urdftool: nothing is written: {counted(len(report), 'error')}", err=True)
    return 2


def run_export(
    console: Console,
    target: Format,
    robot: Robot,
    options: ExportOptions,
    output: str,
    *,
    strict: bool,
    verify: bool,
    overwrite: bool,
    as_json: bool,
    more_checks: Callable[[Robot], list[Finding]] | None = None,
) -> int:
    """Export a robot, and report what was lost, compared and written.

    Args:
        console: Where messages go.
        target: The format.
        robot: The robot.
        options: The options of its writer.
        output: Where it goes; ``-`` is standard output.
        strict: Treat losses as errors.
        verify: Compare the result with the robot.
        overwrite: Replace also what urdftool did not write.
        as_json: Print the result as JSON.
        more_checks: Finds what else to report of the robot.

    Returns:
        The exit code.

    Raises:
        OutputError: It cannot be written there; what was there is as it was.
    """
    from ..formats.common.loss_report import losses_as_errors
    from ..formats.defects import Refused
    from ..formats.export import finish_export

    try:
        written = target.write(robot, options)
        if more_checks is not None:
            written.losses += more_checks(robot)
        if strict and (lost := losses_as_errors(written.losses)):
            raise Refused(lost)
    except Refused as refused:
        return report_refused(refused.findings, as_json=as_json)
    place = None if output == "-" else output
    checks = finish_export(
        target, robot, options, written, place, verify=verify, overwrite=overwrite
    )
    if place is None:
        _print_model(written, as_json=as_json)
    not_compared = target.not_compared if verify else ()
    return report_written(
        console, written, checks, output, as_json=as_json, not_compared=not_compared
    )


def _print_model(written: Written, *, as_json: bool) -> None:
    """Print a model without companions, unless standard output is for JSON.

    Raises:
        OutputError: Other files come with it.
    """
    from ..errors import OutputError

    if len(written.files) > 1:
        raise OutputError("meshes or a scene come with the model; say where to with -o OUT")
    content = written.files[written.main]
    if not as_json and isinstance(content, bytes):
        click.echo(content, nl=False)


def report_written(
    console: Console,
    written: Written,
    checks: Sequence[Check],
    output: str,
    *,
    as_json: bool,
    not_compared: Sequence[str] = (),
) -> int:
    """Losses on stderr, the table or JSON on stdout; notes only for those who asked for more.

    Args:
        console: Where messages go.
        written: What was exported.
        checks: What was compared; nothing without ``--verify``.
        output: Where it was written; ``-`` for standard output.
        as_json: Whether the result is JSON.
        not_compared: What ``--verify`` does not compare.

    Returns:
        The exit code: 1 where something differs that was not announced.
    """
    from ..finding import Severity
    from ..formats.check import is_faithful
    from ..formats.common.loss_report import format_lines, merge_instances

    shown = [f for f in written.losses if f.severity > Severity.INFO or console.verbosity > 0]
    hidden = len(merge_instances(written.losses)) - len(merge_instances(shown))
    if as_json:
        from ..report.exports import to_json

        click.echo(to_json(output, written.files, written.losses, checks, not_compared), nl=False)
    else:
        for line in format_lines(shown):
            console.note(line)
        if checks:
            from ..report.exports import check_table

            click.echo(visible(check_table(checks, not_compared)), nl=False, err=output == "-")
    if output != "-":
        more = f", {counted(hidden, 'note')} (-v shows them)" if hidden else ""
        for sentence in written.advice:
            console.note(f"{output}: warning: {sentence}")
        facts = [written.main, counted(len(written.files), "file"), *written.summary]
        console.note(f"{output}: {', '.join(facts)}{more}")
    return 0 if is_faithful(checks) else 1
