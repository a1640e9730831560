"""Rules about comments that suppress rules; the engine that reads the comments reports these."""

from __future__ import annotations

import re

from ...finding import Finding
from ..fix import FixContext, Proposal, Span, safe, write_inside
from ..rule import ERROR, INFO, SAFE, UNSAFE, WARNING, Problem, rule

APPLIES_TO = ()


@rule(WARNING)
def unused_suppression() -> tuple[Problem, ...]:
    """A comment suppresses a rule that finds nothing there.

    The defect is fixed, or the comment is on the wrong line. Remove it: it would hide the next
    defect of the same kind.
    """
    return ()


@unused_suppression.fix(SAFE, of_file=True)
def remove_comment(finding: Finding, context: FixContext) -> Proposal | None:
    """Remove the comment, and its line if nothing else is on it."""
    place, data = finding.location, finding.location.file.data
    start, end = place.start, place.end
    begin = data.rfind(b"\n", 0, start) + 1
    rest = re.compile(rb"[ \t]*\r?\n").match(data, end)
    if not data[begin:start].strip() and rest is not None:
        start, end = begin, rest.end()
    else:
        while data[start - 1 : start] in (b" ", b"\t"):
            start -= 1
    return safe("remove the comment", Span(place.file, start, end, b""))


@rule(ERROR)
def unknown_rule() -> tuple[Problem, ...]:
    """A comment names a rule that does not exist.

    A misspelled rule in ``urdftool-ignore[…]`` suppresses nothing, and an empty list would
    suppress all rules.
    """
    return ()


@unknown_rule.fix(UNSAFE, of_file=True)
def write_suggested_rule(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the suggested rule."""
    right = finding.data.get("suggestion", "")
    return write_inside(finding, finding.data["name"], right) if right else None


@rule(INFO, infos=True)
def renamed_rule() -> tuple[Problem, ...]:
    """A comment names a rule by its old name.

    The comment still suppresses the rule. In the next release the old name will be unknown, and
    the comment will suppress nothing.
    """
    return ()


@renamed_rule.fix(SAFE, of_file=True)
def write_new_name(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the present name of the rule."""
    data = finding.data
    return write_inside(finding, data["name"], data["suggestion"], harmless=True)
