"""What every export says and does at its end: losses, the comparison, the files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from ..console import Console
from ..report.counted import counted
from ..terminal import visible

if TYPE_CHECKING:
    from ..finding import Finding
    from ..formats.check import Check
    from ..formats.common.written import Written


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


def write_files(
    written: Written,
    output: str,
    *,
    single: bool,
    overwrite: bool,
    inputs: Sequence[str],
    as_json: bool,
) -> None:
    """Write the files where they are wanted; a model without companions may go to stdout.

    Raises:
        OutputError: They cannot be written there; what was there is as it was.
    """
    from ..errors import OutputError
    from ..formats.common.directory import write_export

    if output == "-":
        if len(written.files) > 1:
            raise OutputError("meshes or a scene come with the model; say where to with -o OUT")
        content = written.files[written.main]
        if not as_json and isinstance(content, bytes):
            click.echo(content, nl=False)
        return
    write_export(output, written, single=single, overwrite=overwrite, inputs=inputs)


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
