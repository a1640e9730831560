"""Findings as text: ``full`` with the source, ``concise`` with one line for each."""

from __future__ import annotations

import re
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator

import click

from ..control_characters import escape_controls
from ..diagnostic import Severity
from ..finding import Finding
from ..lint.outcome import Outcome, Report
from ..rules.table import FIXES
from .counted import format_count
from .findings_words import call_lines, format_member_lines, format_message, format_remarks

_COLORS = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}
_MOST_LINES = 3  # lines of the source that are shown for a finding
_MOST_CALLS = 4  # calls of macros that are shown
_LONGEST_LINE = 160  # characters of a line that is shown; chosen
_LONGEST_MESSAGE = 300  # characters of a message whose names are all shown; chosen, no source
_WIDEST = 200  # characters of a line of ``full``; chosen, no source
_MOST_NAMES = 4  # names that a longer message shows; chosen, no source
_NAME = re.compile(r"'[^']*'(?: and '[^']*')?[^,;']*, ")
_NAMES = re.compile(r"(?:'[^']*'(?: and '[^']*')?[^,;']*, ){6,}")


class Painter:
    """Styles text if colors are enabled."""

    def __init__(self, colors: bool) -> None:
        """Enable or disable colors."""
        self.colors = colors

    def __call__(self, text: str, color: str | None = None, *, bold: bool = False) -> str:
        """Return the text in a color."""
        return click.style(text, fg=color, bold=bold) if self.colors else text


def format_concise(
    findings: Iterable[Finding], *, colors: bool = False, cut: bool = False
) -> Iterator[str]:
    """Yield ``FILE:LINE:COLUMN: severity: message [rule]`` for each finding."""
    paint = Painter(colors)
    for finding in findings:
        yield _format_headline(finding, paint, cut)


def is_cut(finding: Finding) -> bool:
    """Tell whether the message of a finding is so long that its list of names is cut."""
    text = format_message(finding)
    return len(text) > _LONGEST_MESSAGE and _NAMES.search(text) is not None


def format_full(
    findings: Iterable[Finding], *, colors: bool = False, whole: bool = True, cut: bool = False
) -> Iterator[str]:
    """Yield headline, source, effects in readers, macro calls and hint of each finding."""
    paint = Painter(colors)
    for finding in findings:
        yield from _wrap(_format_headline(finding, paint, cut))
        yield from _format_source(finding, paint)
        for line in _format_remarks(finding, paint, whole):
            yield from _wrap(f"   {paint('=', 'cyan')} {_cut(line) if cut else line}")
        yield ""


def _wrap(line: str) -> Iterator[str]:
    """Yield a long line in several, the others indented; words are not broken."""
    if len(line) <= _WIDEST:
        yield line
        return
    indent = " " * 5
    yield from textwrap.wrap(
        line, _WIDEST, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def _cut(text: str) -> str:
    """Shorten the list of names in a long text to its first ones; what follows it stays."""
    if len(text) <= _LONGEST_MESSAGE:
        return text
    return _NAMES.sub(_shorten_list, text)


def _shorten_list(match: re.Match[str]) -> str:
    names = _NAME.findall(match[0])
    return f"{''.join(names[:_MOST_NAMES])}… {len(names) - _MOST_NAMES} more …, "


def _format_headline(finding: Finding, paint: Painter, cut: bool) -> str:
    color = _COLORS[finding.severity]
    message = format_message(finding)
    return (
        f"{paint(escape_controls(str(finding.location)), bold=True)}: "
        f"{paint(finding.severity.label, color, bold=True)}: "
        f"{_cut(message) if cut else message} {paint(f'[{finding.code}]', color)}"
    )


def _format_source(finding: Finding, paint: Painter) -> Iterator[str]:
    """Yield the source lines of a finding, with the marked bytes underlined."""
    place = finding.location
    first, column = place.file.position(place.start)
    last, end_column = place.end_position
    if not place.file.data:
        return
    width = max(3, len(str(last)))
    bar = paint("|", "cyan")
    shown = range(first, min(last, first + _MOST_LINES - 1) + 1)
    for number in shown:
        text = place.file.get_line_text(number)
        begin = column - 1 if number == first else len(text) - len(text.lstrip())
        end = end_column - 1 if number == last else len(text.rstrip())
        text, begin, end = _shorten_excerpt(text, begin, end)
        yield f"{paint(f'{number:>{width}}', 'cyan')} {bar} {escape_controls(_expand_tabs(text))}"
        begin, end = len(_expand_tabs(text[:begin])), len(_expand_tabs(text[:end]))
        marks = "^" * max(1, end - begin)
        yield f"{'':>{width}} {bar} {'':>{begin}}{paint(marks, _COLORS[finding.severity])}"
    if last > shown[-1]:
        yield f"{'':>{width}} {bar} …"


def _shorten_excerpt(text: str, begin: int, end: int) -> tuple[str, int, int]:
    """Shorten a long line to an excerpt around the marked columns; return it and the columns."""
    if len(text) <= _LONGEST_LINE:
        return text, begin, end
    start = max(0, min(begin - 20, len(text) - _LONGEST_LINE))
    piece = ("…" if start else "") + text[start : start + _LONGEST_LINE]
    shift = start - (1 if start else 0)
    tail = "…" if start + _LONGEST_LINE < len(text) else ""
    return piece + tail, begin - shift, min(end - shift, len(piece))


def _expand_tabs(text: str) -> str:
    return text.expandtabs(4)


def _format_remarks(finding: Finding, paint: Painter, whole: bool) -> Iterator[str]:
    for remark in format_remarks(finding):
        label, _, text = remark.partition(": ")
        yield f"{paint(label, bold=True)}: {text}"
    yield from (f"from {line}" for line in call_lines(finding.location.calls))
    if finding.members:
        lines = list(format_member_lines(finding))
        most = len(lines) if whole or len(lines) <= _MOST_CALLS else _MOST_CALLS - 1
        yield from (f"also {line}" for line in lines[:most])
        if lines[most:]:
            yield f"and {len(lines) - most} more"
        return
    chains = [(name, calls) for name, calls in finding.others if calls]
    for name, calls in chains[: _MOST_CALLS - 1]:
        through = ", ".join(call_lines(calls[:1]))
        yield f"also {escape_controls(name)}: from {through}" if name else f"also from {through}"
    if len(chains) > _MOST_CALLS - 1:
        yield f"and {len(chains) - _MOST_CALLS + 1} more"


def format_statistics(outcome: Outcome) -> Iterator[str]:
    """Yield the number of findings of each rule, the most first; for groups also of places."""
    counts: Counter[tuple[str, Severity]] = Counter()
    places: Counter[tuple[str, Severity]] = Counter()
    for finding in outcome.findings:
        key = (finding.code, finding.severity)
        counts[key] += 1
        places[key] += len(finding.members) or 1
    for key, count in sorted(counts.items(), key=lambda kv: (-kv[1], kv[0][0])):
        rule, severity = key
        several = f", {places[key]} places" if places[key] > count else ""
        fixable = f" (fix: {FIXES[rule].applicability})" if rule in FIXES else ""
        yield f"{count:>6}  {severity.label:<8} {rule}{several}{fixable}"
    if outcome.not_checked:
        yield f"{len(outcome.not_checked):>6}  error    {NOT_CHECKED} (a file without its robot)"


NOT_CHECKED = "not-checked"
"""Rule name, in formats that require one, for a file whose robot was not checked."""


def format_severity_counts(findings: Iterable[Finding]) -> str:
    """Format the counts, such as ``2 errors, 1 warning, 3 info``; zero counts are omitted."""
    counts = dict.fromkeys(reversed(Severity), 0)
    for finding in findings:
        counts[finding.severity] += 1
    return ", ".join(
        f"{count} {severity.label}{'s' if count != 1 and severity is not Severity.INFO else ''}"
        for severity, count in counts.items()
        if count
    )


def _name_readers(reports: Iterable[Report]) -> str:
    """Name who reads descriptions without a target: what all code imports, or any reader."""
    used = {report.readers for report in reports}
    if len(used) != 1 or not all(used):
        return "any reader of URDF"
    return f"none; the project uses {', '.join(sorted(used.pop()))}"


def summarize(outcome: Outcome) -> str:
    """Summarize a run in one line: counts by severity, files and targets."""
    checked = [report for report in outcome.reports if report.checked]
    files = len(checked)
    targets = {name for report in checked for name in report.targets}
    suppressed = sum(report.suppressed for report in outcome.reports)
    none = "no new findings" if outcome.known else "no findings"
    what = format_severity_counts(outcome.findings) or none
    known = f", {len(outcome.known)} in the baseline" if outcome.known else ""
    hidden = f", {suppressed} ignored by comments" if suppressed else ""
    names = ", ".join(sorted(targets)) or _name_readers(checked)
    overruled = sorted({report.overruled for report in checked} - {""})
    names = "; ".join((names, *overruled))
    where = f" in {format_count(files, 'file')}" if files else ""
    missing = len(outcome.not_checked) + len(outcome.unread_files)
    unchecked = f", {format_count(missing, 'file')} not checked" if missing else ""
    written = sum(report.unexpanded for report in outcome.reports)
    if written:
        unchecked += f", {format_count(written, 'xacro file')} not expanded and so not checked"
    failed = {rule for report in outcome.reports for rule in report.failed_rules}
    if failed:
        unchecked += f", {format_count(len(failed), 'rule')} failed: {', '.join(sorted(failed))}"
    return f"{what}{hidden}{known}{where}{unchecked}" + (f" (targets: {names})" if files else "")
