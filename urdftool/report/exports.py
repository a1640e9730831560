"""What an export says: its losses and comparisons as lines, and all of it as JSON."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..finding import Finding
from ..formats.check import Check, is_faithful
from ..formats.said import merged
from .findings_json import finding_record
from .json_text import json_text


def to_json(
    output: str | None,
    files: Iterable[str],
    findings: Iterable[Finding],
    checks: Sequence[Check],
    not_compared: Sequence[str] = (),
) -> str:
    """The report of an export as one object.

    Args:
        output: Where it was written; None where nothing was.
        files: The files of it.
        findings: Losses, or the defects that forbade it.
        checks: The comparisons of a verification; none where it was not asked for.
        not_compared: What the verification does not compare.
    """
    report = {
        "version": 1,
        "output": output,
        "files": sorted(files),
        "findings": [finding_record(finding) for finding in merged(findings)],
        "checks": [check.as_dict() for check in checks],
        "not_compared": list(not_compared) if checks else [],
        "faithful": is_faithful(checks) if checks else None,
    }
    return json_text(report, 1) + "\n"
