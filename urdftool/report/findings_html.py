"""Findings as a self-contained HTML page, without network access or other files."""

from __future__ import annotations

import os
import re
from base64 import b64encode
from collections import Counter
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from string import Template
from types import MappingProxyType

from ..control_characters import escape_controls
from ..diagnostic import Severity
from ..finding import Finding
from ..lint.outcome import Outcome, Report
from ..rules import FAMILY_OF
from .findings import NOT_CHECKED, summarize
from .findings_screen import sort_by_severity
from .findings_words import call_lines, format_member_lines, format_message, format_remarks
from .rule_pages import format_page

_PAGE = Path(__file__).with_name("findings_page.html")
_MOST_LINES = 6  # lines of the source that are shown for a finding
_LONGEST_LINE = 400  # characters of a line that is shown; chosen


def to_html(outcome: Outcome, pictures: Mapping[str, bytes | str] = MappingProxyType({})) -> str:
    """Format a run as a page: findings by severity, with filters, and the pages of their rules."""
    by_level: dict[Severity, list[Finding]] = {}
    for finding in sort_by_severity(outcome.findings):
        by_level.setdefault(finding.severity, []).append(finding)
    sections = [_format_picture(path, picture) for path, picture in pictures.items()]
    sections += [_format_unreadable(r) for r in outcome.reports if r.error is not None]
    sections += [_format_level(level, by_level[level]) for level in sorted(by_level, reverse=True)]
    rules = sorted({finding.code for finding in outcome.findings} & FAMILY_OF.keys())
    return Template(_PAGE.read_text("utf-8")).substitute(
        summary=_escape_text(summarize(outcome)),
        filters=_format_filters(outcome),
        files="\n".join(sections) or "<p>Nothing was found.</p>",
        rules="\n".join(_format_rule(rule) for rule in rules),
    )


def _format_picture(path: str, picture: bytes | str) -> str:
    """Format the picture of a robot, or the reason why there is none."""
    caption = _escape_text(path)
    if isinstance(picture, str):
        return f'<p class="soft">{caption}: no picture, {_escape_text(picture)}</p>'
    data = b64encode(picture).decode()
    image = f'<img alt="the robot with its findings" src="data:image/png;base64,{data}">'
    return f"<figure>{image}<figcaption>{caption}</figcaption></figure>"


def _format_rule(rule: str) -> str:
    """Format the page of a rule, to which the findings link."""
    page = _escape_text(format_page(rule))
    return f'<h3 id="rule-{escape(rule)}">{escape(rule)}</h3>\n<pre class="page">{page}</pre>'


def _escape_text(text: str) -> str:
    """Escape a text, with paths below the current folder relative to it."""
    here = re.compile(rf"(?<![/\w]){re.escape(os.getcwd().rstrip(os.sep) + os.sep)}")
    return escape(escape_controls(here.sub("", text)))


def _format_filters(outcome: Outcome) -> str:
    """Return a check box for each severity, and a list of the rules with their counts."""
    levels = Counter(finding.severity for finding in outcome.findings)
    rules = Counter(finding.code for finding in outcome.findings)
    boxes = [
        f'<label class="{s.label}"><input type="checkbox" value="{s.label}" checked> '
        f'<span class="level">{_format_counted(levels[s], s)}</span></label>'
        for s in reversed(Severity)
    ]
    options = [
        f'<option value="{escape(rule)}">{escape(rule)} ({count})</option>'
        for rule, count in rules.most_common()
    ]
    chooser = f'<select aria-label="rule"><option value="">all rules</option>{"".join(options)}'
    return "\n".join([*boxes, f"{chooser}</select>"])


def _format_counted(count: int, severity: Severity) -> str:
    return f"{count} {severity.label}{'s' if count != 1 and severity != Severity.INFO else ''}"


def _format_level(severity: Severity, findings: list[Finding]) -> str:
    shown = "\n".join(_format_finding(finding) for finding in findings)
    title = _format_counted(len(findings), severity)
    return f"<section>\n<h2>{title}</h2>\n{shown}\n</section>"


def _format_unreadable(report: Report) -> str:
    """Format a file that could not be read, which has no finding."""
    text = _escape_text(report.not_checked)
    return (
        f"<section>\n<h2>{_escape_text(report.path)}</h2>\n"
        f'<article class="error" data-rule="{NOT_CHECKED}">\n'
        f'<p><span class="level">error</span> {text}; nothing of it was checked</p>\n'
        "</article>\n</section>"
    )


def _format_finding(finding: Finding) -> str:
    level, rule = finding.severity.label, escape(finding.code)
    rows = "".join(
        f"<dt>{_escape_text(a)}</dt><dd>{_escape_text(b)}</dd>" for a, b in _list_rows(finding)
    )
    place = _escape_text(str(finding.location))
    named = f'<a href="#rule-{rule}">{rule}</a>' if finding.code in FAMILY_OF else rule
    return (
        f'<article class="{level}" data-rule="{rule}">\n'
        f'<p><span class="level">{level}</span> {_escape_text(format_message(finding))}</p>\n'
        f'<p class="soft"><code>{place} {named}</code></p>\n'
        f"{_format_source(finding)}<dl>{rows}</dl>\n</article>"
    )


def _list_rows(finding: Finding) -> Iterator[tuple[str, str]]:
    """Yield effects in readers, hint, macro calls and other instances of a finding."""
    for remark in format_remarks(finding):
        label, _, text = remark.partition(": ")
        yield label, text
    for line in call_lines(finding.location.calls):
        yield "from", line
    for line in format_member_lines(finding):
        yield "also", line
    for name, calls in () if finding.members else finding.others:
        yield "also", ", ".join([name, *call_lines(calls[:1])])


def _format_source(finding: Finding) -> str:
    """Format the source lines of a finding, with the marked bytes highlighted."""
    place = finding.location
    if not place.file.data:
        return ""
    first, column = place.file.position(place.start)
    last, end_column = place.end_position
    lines = []
    for number in range(first, min(last, first + _MOST_LINES - 1) + 1):
        text = place.file.get_line_text(number)
        begin = column - 1 if number == first else len(text) - len(text.lstrip())
        end = end_column - 1 if number == last else len(text.rstrip())
        start = max(0, begin - 40) if len(text) > _LONGEST_LINE else 0
        stop = start + _LONGEST_LINE
        before, marked = text[start:begin], text[begin : min(end, stop)]
        after = text[end:stop]
        lines.append(
            f"<i>{number:>4} "
            f"</i>{_format_code(before)}<mark>{_format_code(marked)}</mark>{_format_code(after)}"
        )
    return f"<pre>{chr(10).join(lines)}</pre>\n"


def _format_code(text: str) -> str:
    return _escape_text(text.expandtabs(4))
