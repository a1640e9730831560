"""The comments that silence rules; the engine that reads them reports these."""

from __future__ import annotations

import re

from ...finding import Finding
from ..fix import FixContext, Proposal, Span, safe, write_inside
from ..rule import ERROR, SAFE, UNSAFE, WARNING, Problem, rule

APPLIES_TO = ()


@rule(WARNING)
def unused_suppression() -> tuple[Problem, ...]:
    """A comment silences a rule that finds nothing there.

    The fault is mended, or the comment stands at the wrong line. Left behind, it hides the next
    fault of the same kind.
    """
    return ()


@unused_suppression.fix(SAFE, of_file=True)
def remove_comment(finding: Finding, context: FixContext) -> Proposal | None:
    """Remove the comment, with its line where nothing else is on it."""
    place, data = finding.location, finding.location.file.data
    start, end = place.start, place.end
    begin = data.rfind(b"\n", 0, start) + 1
    rest = re.compile(rb"[ \t]*\r?\n").match(data, end)
    if not data[begin:start].strip() and rest is not None:
        start, end = begin, rest.end()
    else:
        while data[start - 1 : start] in (b" ", b"\t"):
            start -= 1
    return safe("take it away", Span(place.file, start, end, b""))


@rule(ERROR)
def unknown_rule() -> tuple[Problem, ...]:
    """A comment names a rule that does not exist.

    A misspelt rule in ``urdftool-ignore[…]`` silences nothing, and one that is not named at all
    would silence everything.
    """
    return ()


@unknown_rule.fix(UNSAFE, of_file=True)
def write_suggested_rule(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the suggested rule."""
    right = finding.data.get("suggestion", "")
    return write_inside(finding, finding.data["name"], right) if right else None
