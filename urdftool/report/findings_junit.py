"""Findings as JUnit XML, for colcon and CI servers: a suite for each file, a case for each rule."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ..control_characters import escape_controls
from ..diagnostic import Severity
from ..extras import make_missing_error
from ..finding import Finding
from ..lint.outcome import Outcome, Report
from .findings import NOT_CHECKED
from .findings_words import call_lines, format_member_lines, format_message, format_remarks


def to_junit(outcome: Outcome, fail_on: Severity) -> str:
    """Format a run; findings below a severity are output of cases that pass."""
    by_file: dict[str, dict[str, list[Finding]]] = {r.path: {} for r in outcome.reports}
    for finding in outcome.findings:
        by_rule = by_file.setdefault(finding.location.path, {})
        by_rule.setdefault(finding.code, []).append(finding)
    reports = {report.path: report for report in outcome.reports}
    root = Element("testsuites", name="urdftool lint")
    for path, by_rule in by_file.items():
        root.append(_build_suite(path, by_rule, reports.get(path), fail_on))
    for count in ("tests", "failures", "errors"):
        root.set(count, str(sum(int(suite.get(count, "0")) for suite in root)))
    indent(root, " ")
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _build_suite(
    path: str, by_rule: Mapping[str, list[Finding]], report: Report | None, fail_on: Severity
) -> Element:
    suite = Element("testsuite", name=escape_controls(path))
    for rule, findings in by_rule.items():
        _add_findings(_build_case(suite, path, rule), findings, fail_on)
    if report is not None:
        _add_unchecked(suite, report)
    if not len(suite):
        _build_case(suite, path, "lint")
    suite.set("tests", str(len(suite)))
    for count, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(count, str(len(suite.findall(f"testcase/{tag}"))))
    return suite


def _build_case(suite: Element, path: str, name: str) -> Element:
    return SubElement(suite, "testcase", classname=escape_controls(path), name=name, time="0")


def _add_findings(case: Element, findings: Iterable[Finding], fail_on: Severity) -> None:
    """Add the findings of one rule in a file: a failure, or output of a case that passes."""
    findings = list(findings)
    worst = max(finding.severity for finding in findings)
    text = "\n".join(line for finding in findings for line in _format_lines(finding))
    if worst < fail_on:
        SubElement(case, "system-out").text = text
        return
    more = f" (and {len(findings) - 1} more)" if len(findings) > 1 else ""
    failure = SubElement(
        case, "failure", type=worst.label, message=format_message(findings[0]) + more
    )
    failure.text = text


def _format_lines(finding: Finding) -> Iterable[str]:
    yield (
        f"{escape_controls(str(finding.location))}: {finding.severity.label}: "
        f"{format_message(finding)}"
    )
    yield from (f"  {remark}" for remark in format_remarks(finding))
    yield from (f"  from {escape_controls(line)}" for line in call_lines(finding.location.calls))
    yield from (f"  also {line}" for line in format_member_lines(finding))


def _add_unchecked(suite: Element, report: Report) -> None:
    """Add cases for a skipped or unchecked file, and for skipped or failed rules."""
    if report.skipped:
        SubElement(
            _build_case(suite, report.path, "lint"),
            "skipped",
            message=escape_controls(report.skipped),
        )
    if report.not_checked:
        case = _build_case(suite, report.path, "lint")
        kind = "unreadable" if report.error is not None else NOT_CHECKED
        SubElement(case, "error", type=kind, message=escape_controls(report.not_checked))
    for rule, library in report.skipped_rules.items():
        why = str(make_missing_error(library, f"rule {rule}"))
        SubElement(_build_case(suite, report.path, rule), "skipped", message=escape_controls(why))
    for uri, why in report.unread_meshes.items():
        message = escape_controls(f"mesh '{uri}' {why}")
        SubElement(_build_case(suite, report.path, "lint"), "skipped", message=message)
    for path, why in report.unread_files.items():
        case = _build_case(suite, path, "lint")
        SubElement(case, "skipped", message=escape_controls(f"not checked: {why}"))
    for rule, why in report.failed_rules.items():
        SubElement(
            _build_case(suite, report.path, rule),
            "error",
            type="broken rule",
            message=escape_controls(why),
        )
