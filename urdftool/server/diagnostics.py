"""Findings as diagnostics of the Language Server Protocol."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..rules import FAMILY_OF
from ..source.location import Call, Place
from .knowledge import Knowledge, make_path

MOST_CALLS = 20
"""Related places of one diagnostic; chosen: editors show them in a small window."""

_LEVELS = {Severity.ERROR: 1, Severity.WARNING: 2, Severity.INFO: 3}
_UNNECESSARY = 1  # DiagnosticTag; source: specification of the protocol, 3.17
_UNUSED = frozenset(
    ("unused-arg", "unused-macro", "unused-material", "unused-property", "unused-suppression")
)
_PAGES = "https://urdftool.readthedocs.io/rules"


def convert_findings(
    knowledge: Knowledge, findings: Iterable[Finding]
) -> dict[str, list[dict[str, Any]]]:
    """Return diagnostics by path of the file."""
    found: dict[str, list[dict[str, Any]]] = {}
    for finding in findings:
        if not (finding.moot and finding.severity is Severity.INFO):
            converted = convert_finding(knowledge, finding)
            found.setdefault(knowledge.get_path(finding.location.path), []).append(converted)
    return found


def convert_finding(knowledge: Knowledge, finding: Finding) -> dict[str, Any]:
    """Return a finding as a diagnostic, whose range ends on its first line."""
    times = f" (in {finding.expansions} expansions)" if finding.expansions > 1 else ""
    hint = f"\n{finding.hint}" if finding.hint else ""
    found = {
        "range": _get_range(knowledge, finding.location),
        "severity": _LEVELS[finding.severity],
        "code": finding.code,
        "source": "urdftool",
        "message": finding.message + times + hint,
        "relatedInformation": list(_list_related(knowledge, finding)),
    }
    if finding.code in FAMILY_OF:
        found["codeDescription"] = {"href": f"{_PAGES}/{FAMILY_OF[finding.code]}.html"}
    if finding.code in _UNUSED:
        found["tags"] = [_UNNECESSARY]
    return found


def make_error(knowledge: Knowledge, error: UrdftoolError, path: str) -> dict[str, Any]:
    """Return an error that stopped a check as a diagnostic with its ``path``."""
    line = max((error.line or 1) - 1, 0)
    place = {"line": line, "character": 0}
    at = error.at
    return {
        "path": knowledge.get_path(at.path if at is not None else error.path or path),
        "range": {"start": place, "end": place} if at is None else _get_range(knowledge, at),
        "severity": _LEVELS[Severity.ERROR],
        "code": error.rule or "not-checked",
        "source": "urdftool",
        "message": error.message,
        "relatedInformation": [],
    }


def make_remark(path: str, message: str) -> dict[str, Any]:
    """Return a remark about a file, at its start, as a diagnostic with its ``path``."""
    start = {"line": 0, "character": 0}
    return {
        "path": make_path(path),
        "range": {"start": start, "end": start},
        "severity": _LEVELS[Severity.INFO],
        "code": "not-checked",
        "source": "urdftool",
        "message": message,
        "relatedInformation": [],
    }


def _get_range(knowledge: Knowledge, place: Place) -> dict[str, Any]:
    end = max(place.end, place.start + 1)
    return knowledge.make_table(place.file).get_first_line(place.start, end)


def _list_related(knowledge: Knowledge, finding: Finding) -> Iterator[dict[str, Any]]:
    """Yield the calls that lead to a finding, then what each reader does."""
    instances = [(finding.name, finding.location.calls), *finding.others]
    for name, calls in instances[:MOST_CALLS]:
        for call in calls:
            prefix = f"{name}: " if len(instances) > 1 and name else ""
            yield _relate(knowledge, call, f"{prefix}{call.what}")
    for reader, effect in finding.effects.items():
        yield {
            "location": {
                "path": knowledge.get_path(finding.location.path),
                "range": _get_range(knowledge, finding.location),
            },
            "message": f"{reader}: {effect}",
        }


def _relate(knowledge: Knowledge, call: Call, message: str) -> dict[str, Any]:
    return {"location": _locate_call(knowledge, call), "message": message}


def _locate_call(knowledge: Knowledge, call: Call) -> dict[str, Any]:
    """Return the location of a call, which is computed once: findings share calls."""
    table, key = knowledge.make_table(call.file), ("call", id(call.file), call.start)
    if key not in knowledge.memo:
        reach = table.get_first_line(call.start, call.file.find_tag_end(call.start))
        knowledge.memo[key] = {"path": knowledge.get_path(call.file.path), "range": reach}
    found: dict[str, Any] = knowledge.memo[key]
    return found
