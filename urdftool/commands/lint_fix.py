"""``urdftool lint --fix`` and ``--diff``: apply the fixes, or print them."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from ..console import Console
from ..extras import make_missing_error

if TYPE_CHECKING:
    from ..lint.fix_run import FixResult
    from ..lint.options import Options
    from ..lint.outcome import Report
    from ..lint.settings import Settings
    from .lint_report import OutputOptions

_MOST = 6  # rules that a message names; chosen


class Kinds(NamedTuple):
    """Kinds of fixes to apply in addition to the safe ones."""

    unsafe: bool = False
    meshes: bool = False


def fix_files(
    console: Console,
    files: Sequence[str],
    options: Options,
    settings: Settings,
    output: OutputOptions,
    *,
    jobs: int | None,
    kinds: Kinds,
    diff: bool,
) -> int:
    """Fix descriptions, or print the changes, and return the exit code.

    The fixed standard input is written to standard output; its remaining findings to stderr.
    """
    from ..inertia.scales import Scales
    from ..lint.fix_run import apply_fixes
    from ..lint.parallel import check_files
    from ..lint.skipped import add_skipped_parts
    from ..rules.inertia.solids import DENSITY
    from ..workspace import STDIN
    from .lint_report import report
    from .lint_repository import check_source

    scales = Scales(DENSITY) if kinds.unsafe else None
    options = replace(options, fixes=True, cache=None, compute_inertia=scales)
    given = sys.stdin.buffer.read() if "-" in files else b""
    if "-" in files:
        options.workspace = options.workspace.get_with_overlay({STDIN: given})
    reports = list(check_files(files, options, jobs))
    done = apply_fixes(reports, options, unsafe=kinds.unsafe, meshes=kinds.meshes)
    _report_broken_fixes(console, done)
    code = 0 if diff else _write(console, done, reports, options)
    _report_unfixed(console, done.reports, kinds)
    if output.style == "json":
        from ..report.fixes_json import build_fixes_record

        output.fixes = build_fixes_record(
            done, unsafe=kinds.unsafe, meshes=kinds.meshes, written=not diff
        )
    if diff and output.style != "json":
        return _show(console, done, output)
    if diff:
        _report_count(console, "Would fix", done)
        whole = add_skipped_parts(done.reports, output.paths, check_source, options)
        failure = report(console, whole, settings, output)
        return failure if failure > 1 else int(bool(done.made) and not output.exit_zero)
    _report_count(console, "Fixed", done)
    _report_files(console, done, files)
    if "-" in files:
        output.to_stderr = output.output_file is None
        sys.stdout.flush()
        sys.stdout.buffer.write(done.after.get(STDIN, given))
        sys.stdout.buffer.flush()
    whole = add_skipped_parts(done.reports, output.paths, check_source, options)
    return max(report(console, whole, settings, output), code)


def _write(console: Console, done: FixResult, reports: Sequence[Report], options: Options) -> int:
    """Write the changed files, and return the exit code.

    The files of one description are written together or not at all. If they cannot be written,
    the description is linted again, so that its original findings are reported.
    """
    from ..errors import OutputError
    from ..lint.fix_run import is_concerned
    from ..lint.run import check_file
    from ..output import rewrite
    from ..workspace import STDIN

    failed: set[str] = set()
    for group in done.groups:
        after = {path: done.after[path] for path in group if path != STDIN}
        try:
            rewrite({path: done.before[path] for path in after}, after)
        except OutputError as error:
            console.print_error(error)
            failed |= after.keys()
    if not failed:
        return 0
    done.drop(failed)
    options = replace(options, workspace=options.workspace.with_empty_memo())
    for number, report in enumerate(reports):
        if is_concerned(report, failed) or is_concerned(done.reports[number], failed):
            done.reports[number] = check_file(report.path, options)
    return 2


def _report_broken_fixes(console: Console, done: FixResult) -> None:
    for rule, how in done.broken.items():
        console.print_message(
            f"the fix of {rule} was not applied, because it would introduce a defect: {how}. "
            "If the file does not explain this, it is a bug in urdftool"
        )
    for rule, how in done.unmade.items():
        console.print_note(f"not fixed [{rule}]: {how}")


def _report_unfixed(console: Console, reports: Sequence[Report], kinds: Kinds) -> None:
    """Print which fixes could not be applied, and which options enable others."""
    outside: Counter[str] = Counter()
    for report in reports:
        if report.format != "urdf":
            console.print_note(f"{report.path}: not changed; fixes edit URDF and xacro only")
        outside.update(where for _, where in report.outside)
        for finding, reason in report.not_fixed:
            place, rule = finding.location, finding.code
            console.print_note(f"{place}: not fixed [{rule}]: {reason}", level=1)
    for where, count in outside.items():
        what = "1 fix was" if count == 1 else f"{count} fixes were"
        console.print_note(f"{what} not applied to {where}")
    skipped = {rule: name for report in reports for rule, name in report.skipped_fixes.items()}
    for rule, library in skipped.items():
        console.print_note(str(make_missing_error(library, f"not fixed [{rule}]: the fix")))
    left: dict[str, set[tuple[str, str, int]]] = {}
    for finding in (f for report in reports for f in report.findings):
        if finding.fix is None:
            continue
        needed = []
        if not finding.fix.safe and not kinds.unsafe:
            needed.append("--unsafe-fixes")
        if finding.fix.rewrites and not kinds.meshes:
            needed.append("--fix-meshes")
        if needed:
            key = finding.code, finding.location.path, finding.location.start
            left.setdefault(" ".join(needed), set()).add(key)
    for options, found in left.items():
        have = "1 more finding has" if len(found) == 1 else f"{len(found)} more findings have"
        console.print_note(f"{have} {_KINDS[options]} ({options})")


_KINDS = {
    "--unsafe-fixes": "an unsafe fix",
    "--fix-meshes": "a fix that writes mesh files",
    "--unsafe-fixes --fix-meshes": "an unsafe fix that writes mesh files",
}


def _report_count(console: Console, did: str, done: FixResult) -> None:
    """Print a line such as ``Fixed 5 in 2 files: axis-not-unit × 3, empty-dynamics × 2``."""
    total = sum(done.applied.values())
    if not total:
        console.print_note("Nothing to fix.")
        return
    rules = [f"{rule} × {count}" for rule, count in done.applied.most_common()]
    others = len(rules) - _MOST
    more = f", and {others} more rule{'s' * (others > 1)}" if others > 0 else ""
    files = len(done.after)
    where = f"in {files} file{'s' * (files != 1)}"
    console.print_note(f"{did} {total} {where}: {', '.join(rules[:_MOST])}{more}")


def _report_files(console: Console, done: FixResult, files: Sequence[str]) -> None:
    """Print the files that were changed or created in addition to the named ones."""
    from ..source.packages import shorten_path

    named = {os.path.realpath(path) for path in files}
    for what, new in (("changed", False), ("created", True)):
        paths = [
            shorten_path(path)
            for path, before in done.before.items()
            if (before is None) is new
            and before != done.after[path]
            and os.path.realpath(path) not in named
        ]
        if paths:
            console.print_note(f"{what}: {', '.join(sorted(paths))}")


def _show(console: Console, done: FixResult, output: OutputOptions) -> int:
    """Print the fixes as a unified diff; return 1 if there are any, 2 if a file was not checked."""
    from ..output import write_result
    from ..report.file_diff import format_file_diff
    from .lint_report import report_errors

    changed = [path for path, data in done.after.items() if data != done.before[path]]
    text = "".join(format_file_diff(path, done.before[path], done.after[path]) for path in changed)
    inputs = [path for path in done.after if os.path.exists(path)]
    write_result(text, output.output_file, inputs=inputs)
    broken = report_errors(console, done.reports)
    for report in done.reports:
        if report.not_checked and report.error is None:
            console.print_message(f"{report.path}: not checked: {report.not_checked}")
    if done.made or not broken:
        _report_count(console, "Would fix", done)
    return broken or int(bool(changed) and not output.exit_zero)
