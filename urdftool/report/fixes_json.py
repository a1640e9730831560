"""What ``lint --fix`` did, as JSON: the fixes that were applied, and those that were refused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..extras import EXTRA_OF
from ..finding import Finding
from ..lint.fingerprint import compute_fingerprint
from ..lint.fix_run import FixResult
from .findings_json import fix_record


def build_fixes_record(
    done: FixResult, *, unsafe: bool, meshes: bool, written: bool
) -> dict[str, Any]:
    """Return the fixes of a run."""
    refused = [*_list_refused(done), *_list_waiting(done, unsafe=unsafe, meshes=meshes)]
    refused += _list_without_library(done)
    return {
        "written": written,
        "applied": [
            {**_build_subject(one.finding), "round": one.round, "fix": fix_record(one.finding.fix)}
            for one in done.made
        ],
        "refused": [one for at, one in enumerate(refused) if one not in refused[:at]],
    }


def _build_subject(finding: Finding) -> dict[str, Any]:
    line, column = finding.location.file.position(finding.location.start)
    return {
        "rule": finding.code,
        "path": finding.location.path,
        "line": line,
        "column": column,
        "element": {"kind": finding.kind, "name": finding.name},
        "fingerprint": compute_fingerprint(finding),
    }


def _list_refused(done: FixResult) -> Iterator[dict[str, Any]]:
    """Yield the fixes that cannot be made, would make the robot worse, or could not be written."""
    for finding, wrong in done.reverted:
        reason = "not-computable" if wrong.of_a_file else "makes-worse"
        yield {**_build_subject(finding), "reason": reason, "message": wrong.text}
    for report in done.reports:
        for finding, text in report.not_fixed:
            yield {**_build_subject(finding), "reason": "not-in-source", "message": text}
        for finding, where in report.outside:
            text = f"it would change {where}"
            yield {**_build_subject(finding), "reason": "outside-of-project", "message": text}
    for one in done.unwritten:
        text = "a file that it changes could not be written"
        yield {**_build_subject(one.finding), "reason": "not-written", "message": text}


def _list_waiting(done: FixResult, *, unsafe: bool, meshes: bool) -> Iterator[dict[str, Any]]:
    """Yield the fixes that further options apply."""
    for finding in (found for report in done.reports for found in report.findings):
        fix = finding.fix
        if fix is None:
            continue
        options = ["--unsafe-fixes"] * (not fix.safe and not unsafe)
        options += ["--fix-meshes"] * (bool(fix.rewrites) and not meshes)
        if options:
            yield {
                **_build_subject(finding),
                "reason": "needs-option",
                "message": f"is applied with {' '.join(options)}: {fix.message}",
                "options": options,
            }


def _list_without_library(done: FixResult) -> Iterator[dict[str, Any]]:
    """Yield the rules whose fixes require a library that is not installed."""
    missing = {rule: name for one in done.reports for rule, name in one.skipped_fixes.items()}
    for rule, library in missing.items():
        text = f"requires pip install 'urdftool[{EXTRA_OF[library]}]'"
        yield {"rule": rule, "reason": "missing-library", "message": text}
