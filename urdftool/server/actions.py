"""Code actions: fixes of findings, computed when the editor asks, and comments that suppress."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from ..diagnostic import Fix, Replacement
from ..finding import Finding
from ..inertia.scales import Scales
from ..lint.fix_run import fix_description
from ..lint.options import Options
from ..lint.outcome import Report
from ..lint.run import check_file
from ..rules.inertia.solids import DENSITY
from ..source.document import Element
from .edits import Edits, convert_replacements, make_edit
from .knowledge import Knowledge, make_path

_UNSAFE = " (unsafe)"
_BLANKS = re.compile(rb"[ \t]*\Z")


def list_actions(knowledge: Knowledge, params: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the actions for the findings that meet a range of a document, the best first."""
    path = make_path(params["path"])
    table = knowledge.make_table(knowledge.read(path))
    start = table.get_offset(params["range"]["start"])
    end = table.get_offset(params["range"]["end"])
    reports = [report for report, _ in _list_reports(knowledge, path)]
    found = [
        finding
        for report in reports
        for finding in report.findings
        if make_path(finding.location.path) == path
        and finding.location.start <= end
        and start <= _get_line_end(finding)
    ]
    everything = [finding for report in reports for finding in report.findings]
    actions = [*_list_fixes(knowledge, found, everything), *_list_comments(knowledge, found)]
    return _remove_repeated(actions)


def _get_line_end(finding: Finding) -> int:
    """Return the last byte of a finding on its first line, where its mark ends."""
    place = finding.location
    newline = place.file.data.find(b"\n", place.start, place.end)
    return place.end if newline < 0 else newline


def _list_reports(knowledge: Knowledge, path: str) -> list[tuple[Report, Options]]:
    """Return reports with fixes of the robots that a file belongs to."""
    key = "fixes", path
    if key not in knowledge.memo:
        robots = knowledge.list_robots(path) or knowledge.list_reporting_robots(path) or [path]
        found = []
        for robot in robots:
            options = replace(
                knowledge.make_options(robot), fixes=True, compute_inertia=Scales(DENSITY)
            )
            found.append((check_file(robot, options), options))
        knowledge.memo[key] = found
    reports: list[tuple[Report, Options]] = knowledge.memo[key]
    return reports


def _list_fixes(
    knowledge: Knowledge, found: Iterable[Finding], everything: list[Finding]
) -> Iterator[dict[str, Any]]:
    for finding in sorted(found, key=lambda one: not (one.fix and one.fix.safe)):
        for number, fix in enumerate(finding.fixes):
            yield _make_action(knowledge, finding, fix, preferred=fix.safe and not number)
    for code in dict.fromkeys(finding.code for finding in found):
        alike = [one.fix for one in everything if one.code == code and one.fix is not None]
        whole = _choose_disjoint(fix for fix in alike if not fix.rewrites)
        if len(whole) > 1:
            safe = all(fix.safe for fix in whole)
            edits = convert_replacements(knowledge, _list_replacements(whole))
            title = f"Fix {len(whole)} findings of {code}" + ("" if safe else _UNSAFE)
            yield {"title": title, "kind": "quickfix", "edits": edits, "code": code}


def _make_action(
    knowledge: Knowledge, finding: Finding, fix: Fix, *, preferred: bool
) -> dict[str, Any]:
    title = f"{finding.code}: {fix.message}" + ("" if fix.safe else _UNSAFE)
    action: dict[str, Any] = {"title": title, "kind": "quickfix", "code": finding.code}
    if fix.rewrites:
        return {
            **action,
            "edits": {},
            "disabled": f"it writes {fix.rewrites[0].path}; run: urdftool lint {fix.option}",
        }
    edits = convert_replacements(knowledge, fix.replacements)
    return {**action, "edits": edits, "preferred": preferred}


def _choose_disjoint(fixes: Iterable[Fix]) -> list[Fix]:
    """Return fixes that change different bytes."""
    chosen: list[Fix] = []
    taken: list[tuple[str, int, int]] = []
    for fix in fixes:
        spans = [(r.place.path, r.place.start, r.place.end) for r in fix.replacements]
        if not any(_has_overlap(one, other) for one in spans for other in taken):
            chosen.append(fix)
            taken += spans
    return chosen


def _has_overlap(one: tuple[str, int, int], other: tuple[str, int, int]) -> bool:
    return one[0] == other[0] and one[1] <= other[2] and other[1] <= one[2]


def _list_replacements(fixes: Iterable[Fix]) -> list[Replacement]:
    return [replacement for fix in fixes for replacement in fix.replacements]


def _list_comments(knowledge: Knowledge, found: Iterable[Finding]) -> Iterator[dict[str, Any]]:
    """Yield actions that suppress a finding with a comment before its element."""
    for finding in found:
        document = knowledge.parse(finding.location.path)
        if document is None:
            continue
        element = find_innermost(document.root, finding.location.start)
        if element is None:
            continue
        start = element.start
        before = _BLANKS.search(document.file.data[:start])
        blanks = before[0] if before is not None else b""
        line_begins = start == len(blanks) or document.file.data[: start - len(blanks)].endswith(
            (b"\n", b"\r")
        )
        ending = b"\r\n" if b"\r\n" in document.file.data[:65536] else b"\n"
        text = f"<!-- urdftool-ignore[{finding.code}] -->"
        gap = (ending + blanks).decode("ascii") if line_begins else " "
        position = knowledge.make_table(document.file).get_position(start)
        edit = {"range": {"start": position, "end": position}, "newText": text + gap}
        yield {
            "title": f"Suppress {finding.code} here with a comment",
            "kind": "quickfix",
            "code": finding.code,
            "edits": {make_path(finding.location.path): [edit]},
        }


def find_innermost(root: Element, offset: int) -> Element | None:
    """Return the innermost element of a source tree that contains a byte; None outside of it."""
    found, todo = None, [root]
    while todo:
        element = todo.pop()
        if element.start <= offset < element.end:
            found, todo = element, list(element.children)
    return found


def _remove_repeated(actions: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the actions without those of equal title and edits, which several robots offer."""
    found: list[dict[str, Any]] = []
    for action in actions:
        if not any(a["title"] == action["title"] and a["edits"] == action["edits"] for a in found):
            found.append(action)
    return found


def list_safe_edits(knowledge: Knowledge, params: dict[str, Any]) -> Edits:
    """Return the edits of all safe fixes of the robots of a document, proved by checking again.

    A fix may change several documents, and is never applied in part.
    """
    path = make_path(params["path"])
    edits: Edits = {}
    for report, options in _list_reports(knowledge, path):
        if report.error is not None:
            continue
        for changed, after in fix_description(report, options).after.items():
            place = make_path(changed)
            if place not in edits:
                edits[place] = [make_edit(knowledge, knowledge.read(place), after)]
    return edits
