"""Selection of baseline entries that a run could have found."""

from __future__ import annotations

import os
from collections.abc import Iterable

from ..rules import FAMILY_OF, get_rule
from .baseline import Baseline, Entry
from .discover import ENDINGS, has_ending
from .outcome import Outcome
from .settings import Settings


def list_expired_candidates(
    entries: Iterable[Entry], baseline: Baseline, outcome: Outcome, line: Settings
) -> list[Entry]:
    """Return the entries whose file was read or is gone, and whose rule has run or is unknown."""
    checked = [report for report in outcome.reports if report.checked]
    files = {os.path.abspath(path) for report in checked for path in report.files}
    targets = frozenset(name for report in checked for name in report.targets)
    selected = set(line.get_names())
    return [
        entry
        for entry in entries
        if _was_read(baseline.get_file(entry), files)
        and _has_run(entry.rule, selected, targets, line)
    ]


def _was_read(file: str, files: set[str]) -> bool:
    """Tell whether a file was read, is gone, or is another kind of file above a read one."""
    if file in files or not os.path.exists(file):
        return True
    if has_ending(file, *ENDINGS, ".xacro"):
        return False
    folder = os.path.join(os.path.dirname(file), "")
    return any(path.startswith(folder) for path in files)


def _has_run(name: str, selected: set[str], targets: frozenset[str], line: Settings) -> bool:
    if name not in FAMILY_OF:
        return True
    if name not in selected:
        return False
    rule = get_rule(name)
    named = name in (line.select or ()) or name in line.extend_select
    return named or (rule.default and rule.is_enabled_for(targets))
