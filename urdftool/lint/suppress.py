"""Suppression comments, ``<!-- urdftool-ignore[RULE, …] reason -->``.

A comment applies to its own line if other text precedes it there, else to the next element. It
suppresses findings located in that range, and findings whose xacro calls are in it: a comment
before a macro call applies to the whole expansion, one inside the macro to every expansion.
``urdftool-ignore-file[RULE]`` applies to the file.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ..diagnostic import Severity
from ..errors import ConfigError
from ..finding import Finding
from ..rules import FAMILY_OF
from ..rules.old_names import find_old_rules, resolve_selectors
from ..source.document import Document
from ..source.location import Place
from .settings import check_selectors, suggest_word

_WORD = re.compile(r"\s*(urdftool-[\w-]+)\s*(?:\[|$)")
_WORDS = ("urdftool-ignore", "urdftool-ignore-file")
_COMMENT = re.compile(r"\s*urdftool-ignore(-file)?\b\s*(?:\[([^\]]*)\])?")


@dataclass
class Suppression:
    """Suppression comment.

    Attributes:
        names: Rules, by their present names, prefixes and families named in it.
        place: Location of the comment.
        start: First byte to which it applies.
        end: Byte after the last to which it applies.
        reason: Text after the rules.
        used: Whether it has suppressed a finding.
    """

    names: tuple[str, ...]
    place: Place
    start: int
    end: int
    reason: str = ""
    used: bool = False

    def covers(self, finding: Finding) -> bool:
        """Tell whether the comment suppresses a finding, by its rule and place."""
        if not self._is_named(finding.code):
            return False
        places = [(finding.location.file, finding.location.start)]
        places += [(call.file, call.start) for call in finding.location.calls]
        return any(
            file.path == self.place.file.path and self.start <= at < self.end for file, at in places
        )

    def _is_named(self, rule: str) -> bool:
        family = FAMILY_OF.get(rule)
        return any(
            name in (rule, family, "all", "*")
            or (name.endswith("*") and rule.startswith(name[:-1]))
            for name in self.names
        )


def read_suppressions(documents: Iterable[Document]) -> tuple[list[Suppression], list[Finding]]:
    """Return the suppression comments in the files, and findings on invalid ones."""
    found: list[Suppression] = []
    wrong: list[Finding] = []
    for document in documents:
        for comment in document.comments:
            if "urdftool-" not in comment.text:
                continue
            place = Place(document.file, comment.start, comment.end)
            word = _WORD.match(comment.text)
            if word is not None and word[1] not in _WORDS:
                wrong.append(_report_unknown(word[1], place))
                continue
            match = _COMMENT.match(comment.text)
            if match is None:
                continue
            wrong.extend(_report_faults(match[2], place))
            names = resolve_selectors(
                word.strip() for word in (match[2] or "").split(",") if word.strip()
            )
            whole = bool(match[1])
            start, end = (
                _get_covered_range(document, place) if not whole else (0, len(document.file.data))
            )
            reason = " ".join(comment.text[match.end() :].split())
            found.append(Suppression(names, place, start, end, reason))
    return found, wrong


def _report_unknown(word: str, place: Place) -> Finding:
    hint = suggest_word(word, _WORDS) or f"; there are {' and '.join(_WORDS)}"
    message = f"there is no comment '{word}'{hint}"
    return Finding("unknown-rule", Severity.ERROR, message, place, "comment")


def _report_faults(names: str | None, place: Place) -> Iterator[Finding]:
    """Yield findings on unknown and renamed rules, and on a comment without rules."""
    if not (names or "").strip():
        yield Finding(
            "unknown-rule",
            Severity.ERROR,
            "does not name a rule; write urdftool-ignore[RULE]",
            place,
            "comment",
        )
    for word in (names or "").split(","):
        try:
            check_selectors([word])
        except ConfigError as error:
            yield Finding(
                "unknown-rule",
                Severity.ERROR,
                error.message,
                place,
                "comment",
                data=error.data,
            )
    for old in find_old_rules([names or ""]):
        yield Finding(
            "renamed-rule",
            Severity.INFO,
            old.message,
            place,
            "comment",
            data={"name": old.old, "suggestion": old.new},
        )


def _get_covered_range(document: Document, comment: Place) -> tuple[int, int]:
    """Return the range of bytes to which a comment applies: its line, or the next element."""
    data = document.file.data
    line_start = data.rfind(b"\n", 0, comment.start) + 1
    if data[line_start : comment.start].strip():
        line_end = data.find(b"\n", comment.start)
        return _extend_to_element(document, line_start, len(data) if line_end < 0 else line_end)
    elements = sorted(document.root.walk(), key=lambda element: element.start)
    index = bisect_left([element.start for element in elements], comment.end)
    if index == len(elements):
        return comment.start, comment.end
    following = elements[index]
    return following.start, following.end


def _extend_to_element(document: Document, start: int, end: int) -> tuple[int, int]:
    """Return the range of a line, extended to the start of a tag that ends on it."""
    inside = [
        element.start
        for element in document.root.walk()
        if element.start < start < document.file.find_tag_end(element.start) <= end
    ]
    return min([start, *inside]), end


def suppress(
    findings: Iterable[Finding], suppressions: list[Suppression]
) -> tuple[list[Finding], list[tuple[Finding, str]]]:
    """Return the findings that are not suppressed, and the suppressed ones with the reason."""
    kept: list[Finding] = []
    ignored: list[tuple[Finding, str]] = []
    for finding in findings:
        covering = [] if finding.unchecked else [s for s in suppressions if s.covers(finding)]
        for suppression in covering:
            suppression.used = True
        if covering:
            ignored.append((finding, covering[0].reason))
        else:
            kept.append(finding)
    return kept, ignored


def report_unused(suppressions: Iterable[Suppression], ran: set[str]) -> Iterator[Finding]:
    """Yield a finding for each comment that suppresses nothing though a rule of it has run."""
    for suppression in suppressions:
        if suppression.used or not any(suppression._is_named(rule) for rule in ran):
            continue
        yield Finding(
            "unused-suppression",
            Severity.WARNING,
            f"urdftool-ignore[{', '.join(suppression.names)}] suppresses no finding; remove it",
            suppression.place,
            "comment",
        )
