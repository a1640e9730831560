"""Texts that all reports of findings share."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from ..control_characters import escape_controls
from ..extras import make_missing_error
from ..finding import Finding
from ..listing import list_first
from ..source.location import Call
from .counted import format_count

if TYPE_CHECKING:
    from ..lint.outcome import Outcome

_LONGEST_CALL = 90  # characters of a call of a macro; chosen


def format_message(finding: Finding) -> str:
    """Return the message, with the number of instances, the variants, and what it prevented."""
    several = finding.expansions > 1 and not finding.members
    times = f" (in {finding.expansions} expansions)" if several else ""
    only = (
        f" (only with {escape_controls('; '.join(finding.variants))})" if finding.variants else ""
    )
    alone = "; nothing else in this description was checked" if finding.unchecked else ""
    return f"{escape_controls(finding.message)}{times}{only}{alone}"


def format_remarks(finding: Finding) -> Iterator[str]:
    """Yield a line for each reader's behavior, the hint, the fix and each consequence."""
    for reader, effect in finding.effects.items():
        yield f"{reader}: {effect}"
    if finding.hint:
        yield f"hint: {escape_controls(finding.hint)}"
    if finding.fix is not None:
        yield f"fix: {escape_controls(finding.fix.message)} ({finding.fix.option})"
    for consequence in finding.consequences:
        yield f"so: {format_message(consequence)} [{consequence.code}]"


def format_member_lines(finding: Finding) -> Iterator[str]:
    """Yield ``FILE:LINE:COLUMN: MESSAGE`` for each member of a group but the first.

    If the sentence of the group covers the messages, only the name of the member follows.
    """
    for member in finding.members[1:]:
        text = escape_controls(member.message)
        if finding.group is not None and finding.group.sentence:
            text = f"'{escape_controls(member.name)}'" if member.name else ""
        yield f"{escape_controls(str(member.location))}: {text}".removesuffix(": ")


def call_words(call: Call) -> str:
    """Format a call as ``macro 'name' argument=value``, or ``include``."""
    what = escape_controls(call.what)
    return what if len(what) < _LONGEST_CALL else what[: _LONGEST_CALL - 3] + "…"


def call_lines(calls: Iterable[Call]) -> Iterator[str]:
    """Yield ``FILE:LINE:COLUMN: macro 'name' argument=value`` for each call, innermost first."""
    for call in calls:
        yield f"{escape_controls(call.file.path)}:{call.line}:{call.column}: {call_words(call)}"


def list_skipped_rules(outcome: Outcome) -> list[str]:
    """List the rules that require a library that is not installed: a sentence for each library."""
    rules: dict[str, list[str]] = {}
    for rule, library in outcome.skipped_rules.items():
        rules.setdefault(library, []).append(rule)
    return [
        str(
            make_missing_error(
                library,
                f"not checked: {'rule' if len(names) == 1 else 'each of the rules'} "
                f"{', '.join(names)}",
            )
        )
        for library, names in rules.items()
    ]


def list_unread_meshes(outcome: Outcome) -> Iterator[str]:
    """Yield how many meshes were not checked, for each reason, with the remedy."""
    for reason, uris in outcome.unread_meshes.items():
        count, first = len(uris), escape_controls(uris[0])
        named = f"mesh '{first}'" if count == 1 else f"{count} meshes; the first, '{first}',"
        yield f"not checked: {named} {escape_controls(reason)}"


def list_completed(outcome: Outcome) -> Iterator[str]:
    """Yield how many files were not checked because code completes them, for each cause."""
    files: dict[str, list[str]] = {}
    for report in outcome.reports:
        if report.completed_by:
            files.setdefault(report.completed_by, []).append(report.path)
    for cause, paths in files.items():
        first, count = escape_controls(paths[0]), len(paths)
        named = f"'{first}'" if count == 1 else f"{count} files; the first is '{first}'"
        yield f"not checked: {escape_controls(cause)}: {named}; lint what the program loads"


def list_left_out(outcome: Outcome) -> Iterator[str]:
    """Yield how many findings are left out, and why.

    They concern nothing that the code of the project does, or are off by default.
    """
    about_dynamics = sum(report.about_dynamics for report in outcome.reports)
    counts = {
        "with effects only on readers that the project does not use": (
            sum(outcome.for_other_readers.values()) - about_dynamics
        ),
        "about dynamics, which no code here computes": about_dynamics,
        "infos and mild cases": sum(report.minor for report in outcome.reports),
    }
    reasons = {reason: count for reason, count in counts.items() if count}
    count = sum(reasons.values())
    if count:
        why = [
            reason if len(reasons) == 1 else f"{number} {reason}"
            for reason, number in reasons.items()
        ]
        yield (
            f"{format_count(count, 'finding')} left out, {', '.join(why)}; "
            f"--extend-select pedantic shows {'it' if count == 1 else 'them'}"
        )


def list_rejections(outcome: Outcome) -> Iterator[str]:
    """Yield what readers do with each robot as a whole, by its findings.

    Several robots are counted for each reader. A reader that is not named may reject a robot too:
    only known effects of findings count.
    """
    rejected = [report for report in outcome.reports if report.rejected]
    robots = sum(not report.skipped for report in outcome.reports)
    if robots > 1:
        counts = Counter(reader for report in rejected for reader in report.rejected)
        for count in sorted(set(counts.values()), reverse=True):
            readers = sorted(reader for reader in counts if counts[reader] == count)
            verb = "rejects" if len(readers) == 1 else "reject"
            yield f"{', '.join(readers)} {verb} {count} of {robots} robots"
        return
    for report in rejected:
        together: dict[tuple[str, ...], list[str]] = {}
        for reader, rules in report.rejected.items():
            together.setdefault(rules, []).append(reader)
        for rules, readers in together.items():
            verb = "rejects" if len(readers) == 1 else "reject"
            yield f"{', '.join(readers)} {verb} the robot: {_name_lines(outcome, rules, readers)}"


def _name_lines(
    outcome: Outcome, rules: Iterable[str], readers: Sequence[str], shown: int = 3
) -> str:
    """Name rules with the line of their first finding, of those that affect the readers if any."""
    findings = sorted(outcome.findings, key=lambda found: not _has_effect_in(found, readers))
    places = {
        f.code: f"{os.path.basename(f.location.path)}:{f.location.line}" for f in reversed(findings)
    }
    names = [f"{rule} ({places[rule]})" if rule in places else rule for rule in rules]
    return list_first(names, shown)


def _has_effect_in(finding: Finding, readers: Sequence[str]) -> bool:
    """Tell whether a finding has an effect in one of the readers."""
    named = {reader for key in finding.effects for reader in key.split(", ")}
    return not named.isdisjoint(readers)
