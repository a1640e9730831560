"""Reports of an export: losses and comparisons as lines and JSON."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..compare.check import Check, is_faithful
from ..control_characters import escape_controls
from ..finding import Finding
from ..formats.common.loss_report import merge_instances
from ..listing import list_first
from .findings_json import build_finding_record
from .json_text import format_json
from .tables import render_table


def to_json(
    output: str | None,
    files: Iterable[str],
    findings: Iterable[Finding],
    checks: Sequence[Check],
    not_compared: Sequence[str] = (),
    not_read: Sequence[Finding] = (),
) -> str:
    """Format the report of an export as one object."""
    report = {
        "version": 1,
        "output": output,
        "files": sorted(files),
        "findings": [build_finding_record(finding) for finding in merge_instances(findings)],
        "checks": [check.as_dict() for check in checks],
        "not_compared": list(not_compared) if checks else [],
        "not_read": [finding.message for finding in not_read] if checks else [],
        "faithful": is_faithful(checks) if checks else None,
    }
    return format_json(report, 1) + "\n"


def format_check_table(
    checks: Sequence[Check], not_compared: Sequence[str] = (), not_read: Sequence[Finding] = ()
) -> str:
    """Format comparisons as a table, followed by the differences and the parts not compared."""
    rows = [("check", "compared", "worst", "tolerance", "verdict")]
    lines: list[str] = []
    for check in checks:
        is_exact = check.tolerance == 0 and check.worst == 0
        worst = "-" if is_exact or check.skipped or check.is_empty else f"{check.worst:.1e}"
        bound = "exact" if check.tolerance == 0 else f"{check.tolerance:.0e}"
        rows.append((check.name, check.what, worst, bound, check.shown))
        lines += [f"{check.name}: differs: {item}" for item in check.differing]
        if check.announced:
            lines.append(f"{check.name}: announced: {list_first(check.announced, 3)}")
        if check.skipped:
            lines.append(f"{check.name}: not compared: {check.skipped}")
    if not_compared:
        lines.append(f"not compared: {', '.join(not_compared)}")
    if not_read:
        lines.append(f"not read, so not compared: {'; '.join(one.message for one in not_read)}")
    table = render_table(rows, left=range(5), rule=True)
    return table + "".join(f"{escape_controls(line)}\n" for line in lines)
