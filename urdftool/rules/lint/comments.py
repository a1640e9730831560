"""Check the comments that suppress rules."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...source.document import Document
from ...source.location import Place
from ..rule import INFO, Problem, rule

_COMMENT = re.compile(r"\s*urdftool-ignore(-file)?\b\s*\[([^\]]*)\](.*)", re.DOTALL)


def _find_comments(document: Document) -> Iterator[tuple[re.Match[str], Place]]:
    for comment in document.comments:
        match = _COMMENT.match(comment.text) if "urdftool-ignore" in comment.text else None
        if match is not None:
            yield match, Place(document.file, comment.start, comment.end)


@rule(INFO, default=False)
def suppression_without_reason(document: Document) -> Iterator[Problem]:
    """A comment suppresses a rule without a reason.

    Write the reason after the bracket: without one, users cannot tell whether the comment is still
    needed.
    """
    for match, place in _find_comments(document):
        if not match[3].strip():
            yield Problem(
                document.root,
                f"urdftool-ignore[{match[2].strip()}] gives no reason; write it after the bracket",
                at=place,
            )


@rule(INFO, default=False)
def blanket_suppression(document: Document) -> Iterator[Problem]:
    """A comment suppresses whole families of rules.

    It also suppresses rules that are added later. Name the rule to keep the others.
    """
    from .. import FAMILIES

    for match, place in _find_comments(document):
        for name in (word.strip() for word in match[2].split(",")):
            if name in ("all", "ALL", "*") or name in FAMILIES or name.endswith("*"):
                yield Problem(
                    document.root,
                    f"urdftool-ignore[{name}] suppresses more than one rule; name the rule",
                    at=place,
                )
