"""Findings as JSON; the schema is ``docs/schemas/lint.json``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..diagnostic import Fix, Severity
from ..extras import EXTRA_OF
from ..finding import Finding
from ..lint.fingerprint import compute_fingerprint
from ..lint.outcome import Outcome
from .json_text import format_json, replace_non_finite


def to_json(outcome: Outcome, fixes: Mapping[str, Any] | None = None) -> str:
    """Format a run as one object, with the record of its fixes if it had any to make."""
    reports, findings = outcome.reports, outcome.findings
    counts = {severity: sum(f.severity is severity for f in findings) for severity in Severity}
    table: dict[str, Any] = {
        "version": 1,
        "findings": [build_finding_record(finding) for finding in findings],
        "summary": {
            "files": sum(report.checked for report in reports),
            "errors": counts[Severity.ERROR],
            "warnings": counts[Severity.WARNING],
            "infos": counts[Severity.INFO],
            "suppressed": sum(report.suppressed for report in reports),
            "targets": sorted(set().union(*(report.targets for report in reports))),
            "skipped": [{"path": r.path, "reason": r.skipped} for r in reports if r.skipped],
            "unreadable": [
                {"path": r.path, "reason": r.error.message} for r in reports if r.error is not None
            ],
            "not_checked": [{"path": r.path, "reason": r.not_checked} for r in outcome.not_checked],
        },
    }
    if outcome.skipped_rules:
        table["summary"]["skipped_rules"] = [
            {"rule": rule, "library": library, "extra": EXTRA_OF[library]}
            for rule, library in outcome.skipped_rules.items()
        ]
    unread = [(report.path, *item) for report in reports for item in report.unread_meshes.items()]
    if unread:
        table["summary"]["unread_meshes"] = [
            {"path": path, "mesh": uri, "reason": reason} for path, uri, reason in unread
        ]
    if outcome.unread_files:
        table["summary"]["unread_files"] = [
            {"path": path, "reason": reason} for path, reason in outcome.unread_files.items()
        ]
    if outcome.for_other_readers:
        table["summary"]["for_other_readers"] = outcome.for_other_readers
    if outcome.known:
        table["summary"]["baselined"] = len(outcome.known)
    if fixes is not None:
        table["fixes"] = dict(fixes)
    return format_json(table, 1) + "\n"


def build_finding_record(finding: Finding) -> dict[str, Any]:
    """Return the JSON form of a finding."""
    line, column = finding.location.file.position(finding.location.start)
    end_line, end_column = finding.location.end_position
    record: dict[str, Any] = {
        "rule": finding.code,
        "severity": finding.severity.label,
        "message": finding.message,
        "path": finding.location.path,
        "line": line,
        "column": column,
        "end_line": end_line,
        "end_column": end_column,
        "element": {"kind": finding.kind, "name": finding.name},
        "fingerprint": compute_fingerprint(finding),
        "targets": list(finding.targets),
        "effects": finding.effects,
        "expansion": _collect_calls(finding.location.calls),
        "instances": [
            {"name": name, "expansion": _collect_calls(calls)} for name, calls in finding.others
        ],
        "hint": finding.hint or None,
        "fix": fix_record(finding.fix),
    }
    if finding.data:
        record["data"] = replace_non_finite(finding.data)
    if finding.unchecked:
        record["not_checked"] = True
    if finding.variants:
        record["variants"] = list(finding.variants)
    if finding.members and finding.group is not None:
        members = [_build_member(member) for member in finding.members]
        record["group"] = {"by": finding.group.by, "count": finding.count, "members": members}
    if finding.consequences:
        record["consequences"] = [build_finding_record(found) for found in finding.consequences]
    return record


def _build_member(member: Finding) -> dict[str, Any]:
    """Return the JSON form of a member of a group: its own message and location."""
    line, column = member.location.file.position(member.location.start)
    return {
        "message": member.message,
        "path": member.location.path,
        "line": line,
        "column": column,
        "element": {"kind": member.kind, "name": member.name},
        "expansions": member.expansions,
    }


def fix_record(fix: Fix | None) -> dict[str, Any] | None:
    """Return the JSON form of a fix; lines and columns refer to the file before any edit."""
    if fix is None:
        return None
    edits = []
    for place, data in fix.replacements:
        line, column = place.file.position(place.start)
        end_line, end_column = place.end_position
        edits.append(
            {
                "path": place.path,
                "start": {"line": line, "column": column},
                "end": {"line": end_line, "column": end_column},
                "replacement": data.decode(place.file.encoding, "replace"),
            }
        )
    record = {"applicability": fix.applicability, "message": fix.message, "edits": edits}
    if fix.rewrites:
        record["files"] = [{"path": f.path, "of": f.origin, "as": f.how} for f in fix.rewrites]
    return record


def _collect_calls(calls: Iterable[Any]) -> list[dict[str, Any]]:
    from .expansion import call_record

    return [call_record(call) for call in calls]
