"""Findings as workflow commands, which GitHub Actions shows next to the changed lines."""

from __future__ import annotations

from collections.abc import Iterator

from ..control_characters import escape_controls
from ..diagnostic import Severity
from ..lint.outcome import Outcome
from .findings import NOT_CHECKED
from .findings_words import call_lines, format_member_lines, format_message, format_remarks

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def format_github(outcome: Outcome) -> Iterator[str]:
    """Yield ``::error file=…,line=…,title=RULE::message`` for each finding."""
    for report in outcome.reports:
        if report.error is not None:
            where = f"file={_escape_property(report.path)},title={NOT_CHECKED}"
            yield f"::error {where}::{_escape_data(escape_controls(report.error.message))}"
    for finding in outcome.findings:
        line, column = finding.location.file.position(finding.location.start)
        end_line, end_column = finding.location.end_position
        properties: dict[str, object] = {"file": finding.location.path, "line": line}
        properties["endLine"] = end_line
        if line == end_line:  # GitHub rejects columns of a span over several lines
            properties |= {"col": column, "endColumn": end_column}
        properties["title"] = finding.code
        parameters = ",".join(
            f"{key}={_escape_property(str(value))}" for key, value in properties.items()
        )
        came = (f"from {call}" for call in call_lines(finding.location.calls))
        also = (f"also {line}" for line in format_member_lines(finding))
        text = "\n".join([format_message(finding), *format_remarks(finding), *came, *also])
        yield f"::{_COMMANDS[finding.severity]} {parameters}::{_escape_data(text)}"


def _escape_data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _escape_property(text: str) -> str:
    return _escape_data(escape_controls(text, "\r\n")).replace(":", "%3A").replace(",", "%2C")
