"""Report of ``urdftool lint``: findings, baseline, summary and exit code."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from ..report.counted import format_count

if TYPE_CHECKING:
    from ..finding import Finding
    from ..lint.baseline import Baseline, Entry
    from ..lint.outcome import Outcome, Report
    from ..lint.settings import Settings

_MOST_ENTRIES = 3  # entries that a message names; chosen


@dataclass
class OutputOptions:
    """Options of the report.

    Attributes:
        style: Output format; None for the default of a terminal or a file.
        output_file: File of the findings; None for standard output.
        statistics: Print the number of findings per rule instead.
        exit_zero: Return exit code 0 despite findings.
        fail_on: Lowest severity that causes exit code 1.
        baseline: File with findings to ignore.
        write_baseline: File to which the findings are written as a baseline.
        to_stderr: Write the findings to stderr, because the fixed description goes to stdout.
        paths: Files and folders of the command line.
        whole: Print all findings, without the limit per rule family.
        arguments: Names of the xacro arguments of the command line.
        draw: Function that returns the pictures of a page, or the reason for each missing one.
        ending: Function that returns the last line for the reports of a run.
        fixes: Record of the applied and refused fixes; None without ``--fix``.
        junit: Additional JUnit XML file; None for none.
    """

    style: str | None
    output_file: str | None
    statistics: bool
    exit_zero: bool
    fail_on: str
    baseline: str | None
    write_baseline: str | None
    to_stderr: bool = False
    paths: Sequence[str] = ()
    whole: bool = False
    arguments: Sequence[str] = ()
    draw: Callable[[Outcome], Mapping[str, bytes | str]] | None = None
    ending: Callable[[Sequence[Report]], str] | None = None
    fixes: Mapping[str, Any] | None = None
    junit: str | None = None


def report(
    console: Console, reports: Iterable[Report], settings: Settings, output: OutputOptions
) -> int:
    """Print the report of a run, and return the exit code."""
    from ..diagnostic import Severity
    from ..lint.group import group_outcome
    from ..lint.merge import gather
    from ..output import check_targets, write_result
    from ..report.findings import summarize
    from ..report.findings_formats import as_text
    from ..report.findings_screen import MANY, format_advice
    from ..report.findings_words import (
        list_completed,
        list_left_out,
        list_rejections,
        list_skipped_rules,
        list_unread_meshes,
    )

    outcome = gather(reports)
    targets = output.output_file, output.write_baseline, output.junit
    check_targets(targets, inputs=_list_inputs(outcome))
    read = [path for path in (output.baseline, console.config) if path]
    check_targets((output.output_file, output.junit), inputs=read)
    if output.baseline or output.write_baseline:
        outcome = _apply_baseline(console, outcome, settings, output)
    single = [finding for finding in outcome.findings if not finding.is_deferred]
    outcome = group_outcome(outcome)
    threshold = Severity[output.fail_on.upper()]
    to_file = output.output_file not in (None, "-")
    at_terminal = not to_file and sys.stdout.isatty()
    many = len(outcome.findings) > MANY
    style = output.style or ("concise" if at_terminal and many and not output.whole else "full")
    text = as_text(
        outcome,
        style,
        colors=console.has_colors(to_file=to_file),
        fail_on=threshold,
        statistics=output.statistics,
        whole=output.whole or to_file or (style == "concise" and not at_terminal),
        cut=not (output.whole or to_file),
        pictures=output.draw(outcome) if output.draw is not None and style == "html" else {},
        fixes=output.fixes,
    )
    if output.to_stderr:
        click.echo(text, err=True, nl=False)
    else:
        write_result(text, output.output_file, inputs=_list_inputs(outcome) if to_file else [])
        if console.transcript is not None:
            console.transcript.add("stdout", text)
    if output.junit is not None:
        junit = as_text(outcome, "junit", fail_on=threshold)
        write_result(junit, output.junit, inputs=_list_inputs(outcome))
    _report_unread(console, outcome.reports)
    _report_unknown_arguments(console, outcome.reports, output.arguments)
    _report_skipped(console, outcome.reports, output.paths)
    broken = report_errors(console, outcome.reports)
    if any(report.checked or report.stopped or report.unexpanded for report in outcome.reports):
        for line in list_rejections(outcome) if style == "full" else ():
            console.print_note(line)
        console.print_note(summarize(outcome))
        left_out = list_left_out(outcome)
        for line in (
            *list_skipped_rules(outcome),
            *list_completed(outcome),
            *list_unread_meshes(outcome),
            *left_out,
        ):
            console.print_note(line)
        people = style in ("full", "concise") and not output.statistics
        for line in format_advice(outcome.findings, single) if people else ():
            console.print_note(line)
    if output.ending is not None:
        console.print_note(output.ending(outcome.reports))
    if broken:
        return broken
    worst = max((f.severity for f in outcome.findings), default=None)
    failed = worst is not None and worst >= threshold
    return int(failed and not output.exit_zero)


def _list_inputs(outcome: Outcome) -> list[str]:
    """Return all source files of all descriptions, and what else is known to have been read."""
    from ..source.document import STDIN

    named = [path for report in outcome.reports for path in (report.path, *report.files)]
    rows = [row for report in outcome.reports for row in report.rows or ()]
    named += [path for kind, path, *_ in rows if kind == "file" and os.path.isfile(path)]
    return [path for path in dict.fromkeys(named) if path not in ("-", STDIN)]


def _apply_baseline(
    console: Console, outcome: Outcome, settings: Settings, output: OutputOptions
) -> Outcome:
    """Remove the findings of the baseline from a run; first write the baseline if requested."""
    from ..lint.baseline import compare, read_baseline
    from ..lint.stale import list_expired_candidates

    old = read_baseline(output.baseline) if output.baseline else None
    if output.write_baseline:
        written = _write(console, outcome, settings, output.write_baseline)
        if written is not None:
            return compare(outcome, written)[0]
    if old is None:
        return outcome
    outcome, unmatched = compare(outcome, old)
    stale = list_expired_candidates(unmatched, old, outcome, settings)
    if stale:
        console.print_note(_describe_stale(old, stale))
    return outcome


def _write(console: Console, outcome: Outcome, settings: Settings, path: str) -> Baseline | None:
    """Write a baseline; keep entries of the old file for which this run did not search."""
    import os

    from ..lint.baseline import make_baseline, read_baseline, to_text
    from ..lint.stale import list_expired_candidates
    from ..output import write_result

    if not outcome.complete:
        console.print_message(f"{path}: not written, because a robot could not be checked")
        return None
    entries = {}
    if os.path.exists(path):
        old = read_baseline(path)
        gone = set(list_expired_candidates(old.counts, old, outcome, settings))
        entries = {entry: count for entry, count in old.counts.items() if entry not in gone}
    written = make_baseline(path, outcome.findings, entries)
    write_result(to_text(written), path, inputs=_list_inputs(outcome))
    number = len(written.counts)
    console.print_note(f"{path}: written, {number} {'entry' if number == 1 else 'entries'}")
    return written


def _describe_stale(baseline: Baseline, stale: list[Entry]) -> str:
    """Describe the baseline entries that match no finding, with the first of them."""
    some = [f"{e.path}: {e.rule} of {e.kind} '{e.name}'" for e in stale[:_MOST_ENTRIES]]
    more = ["…"] if len(stale) > _MOST_ENTRIES else []
    what = "1 entry matches" if len(stale) == 1 else f"{len(stale)} entries match"
    return (
        f"{baseline.path}: {what} no finding ({'; '.join(some + more)}); "
        f"remove with --write-baseline {baseline.path}"
    )


def _report_unread(console: Console, reports: Iterable[Report]) -> None:
    """Print what readers of SDF and MJCF left out, once for each kind; all with ``-v``.

    What a finding of a rule is about is not repeated.
    """
    reports = tuple(reports)
    known = {(f.location.path, f.location.start) for report in reports for f in report.findings}
    findings = [
        finding
        for report in reports
        for finding in report.unread
        if (finding.location.path, finding.location.start) not in known
    ]
    if not findings:
        return
    from ..formats.common.loss_report import format_lines

    if console.verbosity > 0:
        for line in format_lines(findings):
            console.print_note(line)
        return
    kinds: dict[str, list[Finding]] = {}
    for finding in findings:
        kinds.setdefault(finding.code, []).append(finding)
    for first, *others in kinds.values():
        files = {finding.location.path for finding in others} - {first.location.path}
        more = f" (and {len(others)} more; -v shows them)" if others else ""
        more = f" (and in {format_count(len(files), 'more file')})" if files else more
        for line in format_lines([first]):
            console.print_note(line + more)


def _report_unknown_arguments(
    console: Console, reports: Iterable[Report], given: Sequence[str]
) -> None:
    """Print the arguments of the command line that no checked description declares."""
    if not given:
        return
    from ..report.expansion import format_unknown_argument

    checked = [report for report in reports if report.checked]
    for name in given:
        unknown = [report for report in checked if name in report.unknown_arguments]
        if unknown and len(unknown) == len(checked):
            first = unknown[0]
            console.print_note(
                format_unknown_argument(first.path, name, first.unknown_arguments[name])
            )


def _report_skipped(console: Console, reports: Iterable[Report], named: Sequence[str]) -> None:
    """Print the skipped files with the reason; some of them only with ``-v``."""
    groups: dict[tuple[str, int], list[Report]] = {}
    reports = list(reports)
    read = {path for report in reports if report.checked for path in report.files}
    for report in reports:
        if report.skipped:
            usual = report.path in named or not report.path.endswith((".urdf", ".urdf.xacro"))
            macros = report.path.endswith(".urdf.xacro") and "excluded" not in report.skipped
            level = 0 if usual or (macros and report.path not in read) else 1
            reason = re.sub(r" \([^)]*\)", "", report.skipped)  # without the names of macros
            groups.setdefault((reason, level), []).append(report)
    for (reason, level), some in groups.items():
        more = len(some) - _MOST_ENTRIES
        shown = ", ".join(report.path for report in some[:_MOST_ENTRIES])
        shown += f" and {more} more" if more > 0 else ""
        why = reason if len(some) > 1 else some[0].skipped
        console.print_note(f"{shown}: skipped, {why}", level=level)


def report_errors(console: Console, reports: Iterable[Report]) -> int:
    """Print errors of files and of rules, and return their exit code; 0 without errors."""
    from .. import __version__
    from ..cli import REPORT_BUGS

    code = 0
    for report in reports:
        if report.error is not None:
            console.print_error(report.error)
        if report.not_checked:
            code = max(code, 2)
        for rule, reason in report.failed_rules.items():
            console.print_message(
                f"{report.path}: rule {rule} failed because of a bug in urdftool {__version__} "
                f"({reason}); other rules are not affected. Please report it at {REPORT_BUGS}"
            )
            code = 3
    return code
