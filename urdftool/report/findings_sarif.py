"""Findings as SARIF 2.1.0, for code scanning services and editors."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from typing import Any
from urllib.parse import quote

from .. import __version__
from ..control_characters import escape_controls
from ..diagnostic import Fix, Severity
from ..finding import Finding
from ..lint.fingerprint import compute_fingerprint
from ..lint.outcome import Outcome, Report
from ..rules import FAMILY_OF, get_rule
from ..rules.old_names import get_first_name
from ..source.location import Call, Place
from .findings import NOT_CHECKED
from .findings_words import (
    call_words,
    format_message,
    format_remarks,
    list_skipped_rules,
    list_unread_meshes,
)
from .json_text import format_json

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def to_sarif(outcome: Outcome) -> str:
    """Format a run; findings ignored by comments or in the baseline are suppressed results."""
    excused = [(finding, _build_in_source(reason)) for finding, reason in outcome.ignored]
    excused += [(finding, {"kind": "external"}) for finding in outcome.known]
    found: list[tuple[Finding, list[dict[str, Any]]]] = [
        *((finding, []) for finding in outcome.findings),
        *((finding, [suppression]) for finding, suppression in excused),
    ]
    unreadable = [report for report in outcome.reports if report.error is not None]
    names = sorted({finding.code for finding, _ in found} | {NOT_CHECKED for _ in unreadable})
    seen: Counter[tuple[str, str]] = Counter()
    results = []
    for finding, suppressions in found:
        result = _build_result(finding, names.index(finding.code), seen)
        results.append(result | {"suppressions": suppressions} if excused else result)
    results += [_build_unreadable(report, names.index(NOT_CHECKED)) for report in unreadable]
    driver = {
        "name": "urdftool",
        "semanticVersion": __version__,
        "rules": [_build_rule(name) for name in names],
    }
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "invocations": [_build_invocation(outcome)],
        "results": results,
    }
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return format_json(log, 1) + "\n"


def _build_rule(name: str) -> dict[str, Any]:
    """Return the record of a rule, with its page as help."""
    record: dict[str, Any] = {"id": name}
    if name == NOT_CHECKED:
        fact = {"text": "A file could not be read, so nothing of it was checked."}
        return record | {
            "shortDescription": fact,
            "help": fact,
            "defaultConfiguration": {"level": "error", "enabled": True},
            "properties": {"tags": ["lint"]},
        }
    if name not in FAMILY_OF:
        return record
    from .rule_pages import format_page, remove_markup

    rule = get_rule(name)
    if (first := get_first_name(name)) != name:
        record["deprecatedIds"] = [first]
    return record | {
        "shortDescription": {"text": remove_markup(rule.fact)},
        "help": {"text": format_page(name)},
        "defaultConfiguration": {"level": _LEVELS[rule.severity], "enabled": rule.default},
        "properties": {"tags": [rule.family]},
    }


def _build_unreadable(report: Report, index: int) -> dict[str, Any]:
    """Return the result for a file that could not be read, which has no finding."""
    return {
        "ruleId": NOT_CHECKED,
        "ruleIndex": index,
        "level": "error",
        "message": {"text": escape_controls(report.not_checked)},
        "locations": [{"physicalLocation": _build_file(report.path)}],
        "partialFingerprints": {"primaryLocationLineHash": f"{NOT_CHECKED}:1"},
    }


def _build_result(finding: Finding, index: int, seen: Counter[tuple[str, str]]) -> dict[str, Any]:
    known_by = compute_fingerprint(finding)
    seen[finding.location.path, known_by] += 1
    location: dict[str, Any] = {"physicalLocation": _place(finding.location)}
    if finding.name:
        location["logicalLocations"] = [{"name": finding.name, "kind": finding.kind}]
    text = "\n".join([format_message(finding), *format_remarks(finding)])
    record = {
        "ruleId": finding.code,
        "ruleIndex": index,
        "level": _LEVELS[finding.severity],
        "message": {"text": text},
        "locations": [location],
        "partialFingerprints": {
            "primaryLocationLineHash": f"{known_by}:{seen[finding.location.path, known_by]}"
        },
    }
    if finding.fix is not None and not finding.fix.rewrites:  # SARIF fixes can only replace text
        record["fixes"] = [_fix(finding.fix)]
    related = [
        {**location, "id": number}
        for number, location in enumerate(_list_related(finding), start=1)
    ]
    return record | {"relatedLocations": related} if related else record


def _fix(fix: Fix) -> dict[str, Any]:
    """Return the record of a fix, by file, with its applicability as a property."""
    by_path: dict[str, list[dict[str, Any]]] = {}
    for place, data in fix.replacements:
        by_path.setdefault(place.path, []).append(
            {
                "deletedRegion": _place(place)["region"],
                "insertedContent": {"text": data.decode(place.file.encoding, "replace")},
            }
        )
    return {
        "description": {"text": escape_controls(fix.message)},
        "artifactChanges": [
            {"artifactLocation": {"uri": format_uri(path)}, "replacements": replacements}
            for path, replacements in by_path.items()
        ],
        "properties": {"applicability": fix.applicability},
    }


def _list_related(finding: Finding) -> Iterator[dict[str, Any]]:
    """Yield the locations of macro calls and includes, then of other instances and consequences."""
    for call in finding.location.calls:
        yield _call(call, f"from {call_words(call)}")
    for member in finding.members[1:]:
        text = escape_controls(member.message)
        yield {"physicalLocation": _place(member.location), "message": {"text": text}}
    for name, calls in () if finding.members else finding.others:
        for call in calls[:1]:
            yield _call(call, f"also {escape_controls(name)}, from {call_words(call)}")
    for found in finding.consequences:
        text = f"{format_message(found)} [{found.code}]"
        yield {"physicalLocation": _place(found.location), "message": {"text": text}}


def _call(call: Call, text: str) -> dict[str, Any]:
    place = Place(call.file, call.start, call.file.find_tag_end(call.start))
    return {"physicalLocation": _place(place), "message": {"text": text}}


def _build_file(path: str) -> dict[str, Any]:
    return {"artifactLocation": {"uri": format_uri(path)}}


def _place(place: Place) -> dict[str, Any]:
    where = _build_file(place.path)
    if place.file.data:
        line, column = place.file.position(place.start)
        end_line, end_column = place.end_position
        where["region"] = {
            "startLine": line,
            "startColumn": column,
            "endLine": end_line,
            "endColumn": end_column,
        }
    return where


def format_uri(path: str) -> str:
    """Return a path as a URI: relative paths unchanged, absolute ones with ``file://``."""
    quoted = quote(os.fsencode(path.replace(os.sep, "/")))
    return f"file://{quoted}" if os.path.isabs(path) else quoted


def _build_in_source(reason: str) -> dict[str, Any]:
    record = {"kind": "inSource"}
    return record | {"justification": escape_controls(reason)} if reason else record


def _build_invocation(outcome: Outcome) -> dict[str, Any]:
    """Return whether all files were read and no rule failed, with notifications."""
    notes = []
    for report in outcome.reports:
        where = {"physicalLocation": _build_file(report.path)}
        messages = [escape_controls(report.not_checked)] if report.not_checked else []
        messages += [f"rule {r}: {escape_controls(why)}" for r, why in report.failed_rules.items()]
        notes += [
            {"level": "error", "message": {"text": text}, "locations": [where]} for text in messages
        ]
    record: dict[str, Any] = {"executionSuccessful": not notes}
    unchecked = (*list_skipped_rules(outcome), *list_unread_meshes(outcome))
    notes += [{"level": "note", "message": {"text": text}} for text in unchecked]
    return record | {"toolExecutionNotifications": notes} if notes else record
