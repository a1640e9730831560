"""``urdftool lint --fix`` and ``--diff``: the fixes, on disk or shown."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ..console import Console
from ..extras import missing

if TYPE_CHECKING:
    from ..lint.fix_run import Mended
    from ..lint.outcome import Options, Report
    from ..lint.settings import Settings
    from .lint_report import Wanted

_MOST = 6


@dataclass
class _Done:
    """What came of fixing many descriptions.

    Attributes:
        before: The bytes of each file that changed, as they were; None for one that is new.
        after: The same as they are to be.
        applied: How many fixes of each rule were made.
        code: The exit code that something that failed asks for.
    """

    before: dict[str, bytes | None] = field(default_factory=dict)
    after: dict[str, bytes] = field(default_factory=dict)
    applied: Counter[str] = field(default_factory=Counter)
    code: int = 0


def fix_files(
    console: Console,
    files: Sequence[str],
    options: Options,
    settings: Settings,
    wanted: Wanted,
    *,
    jobs: int | None,
    unsafe: bool,
    diff: bool,
) -> int:
    """Fix descriptions, or show how; gives the exit code.

    Standard input is fixed to standard output, and what remains is reported on stderr.
    """
    from contextlib import ExitStack

    from ..inertia.scales import Scales
    from ..lint.parallel import lint_files
    from ..rules.fixes.inertia import DENSITY
    from ..source.document import STDIN, reading_instead
    from .lint_report import report

    scales = Scales(DENSITY) if unsafe else None
    options = replace(options, fixes=True, cache=None, weigh=scales)
    with ExitStack() as stack:
        given = b""
        if "-" in files:
            given = sys.stdin.buffer.read()
            stack.enter_context(reading_instead({STDIN: given}))
        reports = list(lint_files(files, options, jobs))
        done = _Done()
        for number in range(len(reports)):
            _fix_one(console, reports, number, options, done, unsafe=unsafe, diff=diff)
        _say_what_is_left(console, reports, unsafe=unsafe)
        if diff:
            return _show(console, done, wanted)
        _say(console, "Fixed", done)
        _say_where(console, done, files)
        if "-" in files:
            wanted.to_stderr = wanted.output_file is None
            sys.stdout.flush()
            sys.stdout.buffer.write(done.after.get(STDIN, given))
            sys.stdout.buffer.flush()
        return max(report(console, reports, settings, wanted), done.code)


def _fix_one(
    console: Console,
    reports: list[Report],
    number: int,
    options: Options,
    done: _Done,
    *,
    unsafe: bool,
    diff: bool,
) -> None:
    """Fix one description; others that read the same files are checked anew."""
    from ..errors import OutputError
    from ..lint.fix_run import concerns, mend
    from ..lint.run import lint_file
    from ..output import rewrite
    from ..source.document import STDIN, reading_instead

    one = reports[number]
    if not any(f.fix is not None and (f.fix.safe or unsafe) for f in one.findings):
        return
    shown = done.after if diff else {k: v for k, v in done.after.items() if k == STDIN}
    with reading_instead(shown):
        mended = mend(one, options, unsafe=unsafe, others=reports)
    _say_broken(console, mended)
    if not mended.after:
        return
    if not diff:
        try:
            rewrite(mended.before, {k: v for k, v in mended.after.items() if k != STDIN})
        except OutputError as error:
            console.error(error)
            done.code = 2
            return
    for path, data in mended.before.items():
        done.before.setdefault(path, data)
    done.after.update(mended.after)
    done.applied += mended.applied
    reports[number] = mended.report
    with reading_instead(done.after):
        for other, report in enumerate(reports):
            if other != number and concerns(report, mended.after):
                reports[other] = lint_file(report.path, options)


def _say_broken(console: Console, mended: Mended) -> None:
    for rule, how in mended.broken.items():
        console.say(
            f"the fix of {rule} would make things worse and is not made: {how}. "
            "If that is not plain from the file, it is a bug in urdftool"
        )
    for rule, how in mended.unmade.items():
        console.note(f"is not fixed [{rule}]: {how}")


def _say_what_is_left(console: Console, reports: Sequence[Report], *, unsafe: bool) -> None:
    """Fixes that could not be made, and those that were not asked for."""
    outside: Counter[str] = Counter()
    for report in reports:
        for finding, reason in report.unmended:
            if "outside of" in reason:
                outside[reason.removeprefix("it is written in ")] += 1
            else:
                console.note(f"{finding.place}: is not fixed [{finding.rule}]: {reason}", level=1)
    for where, count in outside.items():
        what = "1 fix is" if count == 1 else f"{count} fixes are"
        console.note(f"{what} not made in {where}")
    skipped = {rule: name for report in reports for rule, name in report.skipped_fixes.items()}
    for rule, library in skipped.items():
        console.note(str(missing(library, f"not fixed: the fix of {rule}")))
    left = {
        (f.rule, f.place.path, f.place.start)
        for report in reports
        for f in report.findings
        if f.fix is not None and not f.fix.safe
    }
    if left and not unsafe:
        what = "1 more finding has" if len(left) == 1 else f"{len(left)} more findings have"
        console.note(f"{what} an unsafe fix (--unsafe-fixes)")


def _say(console: Console, did: str, done: _Done) -> None:
    """``Fixed 5: axis-not-unit × 3, empty-dynamics × 2 (in 2 files)``."""
    total = sum(done.applied.values())
    if not total:
        console.note("Nothing to fix.")
        return
    rules = [f"{rule} × {count}" for rule, count in done.applied.most_common()]
    others = len(rules) - _MOST
    more = f", and {others} more rule{'s' * (others > 1)}" if others > 0 else ""
    files = len(done.after)
    where = f"in {files} file{'s' * (files != 1)}"
    console.note(f"{did} {total} {where}: {', '.join(rules[:_MOST])}{more}")


def _say_where(console: Console, done: _Done, files: Sequence[str]) -> None:
    """The files that changed or were made beside the ones that were asked for."""
    from ..source.packages import shown_path

    asked = {os.path.realpath(path) for path in files}
    for what, new in (("changed", False), ("made", True)):
        paths = [
            shown_path(path)
            for path, before in done.before.items()
            if (before is None) is new
            and before != done.after[path]
            and os.path.realpath(path) not in asked
        ]
        if paths:
            console.note(f"{what}: {', '.join(sorted(paths))}")


def _show(console: Console, done: _Done, wanted: Wanted) -> int:
    """The fixes as a unified diff; exit 1 if there are any."""
    from ..output import write_result
    from ..report.file_diff import file_diff

    changed = [path for path, data in done.after.items() if data != done.before[path]]
    text = "".join(file_diff(path, done.before[path], done.after[path]) for path in changed)
    inputs = [path for path in done.after if os.path.exists(path)]
    write_result(text, wanted.output_file, inputs=inputs)
    _say(console, "Would fix", done)
    return max(done.code, int(bool(changed) and not wanted.exit_zero))
