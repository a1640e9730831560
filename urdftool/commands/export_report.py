"""Run an export, and report its losses, the comparison and the files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from ..report.counted import format_count

if TYPE_CHECKING:
    from ..compare.check import Check
    from ..finding import Finding
    from ..formats.registry import ExportOptions, Format
    from ..formats.written import Written
    from ..model.elements import Robot


def report_refused(console: Console, findings: Sequence[Finding], *, as_json: bool) -> int:
    """Print a line for each defect; nothing is written. Return the exit code."""
    from ..formats.common.loss_report import count_messages, format_lines, keep_largest

    if as_json:
        from ..report.exports import to_json

        click.echo(to_json(None, (), findings, ()), nl=False)
    for line in format_lines(findings if console.verbosity > 0 else keep_largest(findings)):
        console.print_note(line, level=-1)
    count = format_count(count_messages(findings), "error")
    console.print_message(f"no file was written: {count}")
    return 2


def restore_output(console: Console, output: str) -> None:
    """Restore an output folder that a killed process left under a temporary name."""
    from ..leftovers import restore_folder

    if restore_folder(output):
        console.print_note(f"{output} was restored: the process that replaced it was killed")


def run_export(
    console: Console,
    target: Format,
    robot: Robot,
    options: ExportOptions,
    output: str,
    values: Mapping[str, Any],
    *,
    more_checks: Callable[[Robot], list[Finding]] | None = None,
) -> int:
    """Export a robot, and report what was lost, compared and written; return the exit code.

    ``values`` are those of :func:`make_export_options`; an output ``-`` is standard output.

    Raises:
        OutputError: The output cannot be written; existing files are unchanged.
    """
    from ..formats.common.loss_report import raise_losses_as_errors
    from ..formats.export import finish_export
    from ..refusal import Refused

    as_json, verify = values["style"] == "json", values["verified"]
    try:
        written = target.write(robot, options)
        if more_checks is not None:
            written.losses += more_checks(robot)
        if values["strict"] and (lost := raise_losses_as_errors(written.losses)):
            raise Refused(lost)
    except Refused as refused:
        return report_refused(console, refused.findings, as_json=as_json)
    place = None if output == "-" else output
    if place is not None:
        restore_output(console, place)
    checks = finish_export(
        target, robot, options, written, place, verify=verify, overwrite=values["overwrite"]
    )
    if place is None:
        _print_model(written, as_json=as_json)
    not_compared = target.not_compared if verify else ()
    return report_written(
        console,
        written,
        checks,
        output,
        as_json=as_json,
        not_compared=not_compared,
        not_read=robot.unread if written.unread is None else written.unread,
    )


def _print_model(written: Written, *, as_json: bool) -> None:
    """Print a model that consists of one file, unless the report is printed as JSON.

    Raises:
        OutputError: The model consists of several files.
    """
    from ..errors import OutputError

    if len(written.files) > 1:
        raise OutputError("the model has several files (meshes or a scene); write them with -o OUT")
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
    not_read: Sequence[Finding] = (),
) -> int:
    """Print losses to stderr, and the table or JSON to stdout; notes only with ``-v``.

    Returns:
        The exit code: 1 if a property differs without a reported loss.
    """
    from ..compare.check import is_faithful
    from ..diagnostic import Severity
    from ..formats.common.loss_report import format_lines, keep_largest, merge_instances

    shown = [f for f in written.losses if f.severity > Severity.INFO or console.verbosity > 0]
    hidden = len(merge_instances(written.losses)) - len(merge_instances(shown))
    if as_json:
        from ..report.exports import to_json

        text = to_json(output, written.files, written.losses, checks, not_compared, not_read)
        click.echo(text, nl=False)
    else:
        for line in format_lines(shown if console.verbosity > 0 else keep_largest(shown)):
            console.print_note(line)
        if checks:
            from ..report.exports import format_check_table

            table = format_check_table(checks, not_compared, not_read)
            click.echo(table, nl=False, err=output == "-")
    if output != "-":
        more = f", {format_count(hidden, 'note')} (-v shows them)" if hidden else ""
        for sentence in written.advice:
            console.print_note(f"{output}: warning: {sentence}")
        facts = [written.main, format_count(len(written.files), "file"), *written.summary]
        console.print_note(f"{output}: {', '.join(facts)}{more}")
    return 0 if is_faithful(checks) else 1
