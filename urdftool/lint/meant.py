"""Values that are meant: a comment directly above them gives a reason, or they are for a test."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePath

from ..diagnostic import Severity
from ..finding import Finding
from ..rules.rule import Problem, Rule
from ..source.document import Element

_COMMENT = re.compile(rb"<!--((?:(?!-->).)*)-->\s*\Z", re.DOTALL)

_REASON = re.compile(
    rb"(?i)\b(?:because|since|so that|in order to|on purpose|purposely|intentional\w*|deliberate\w*"
    rb"|hack|workaround|work around|to (?:avoid|prevent|ensure|keep|match|stabili\w+)|estimated"
    rb"|approximat\w+|instead of|artificial\w*|exaggerat\w+|for stability)\b"
)
"""Words that give a reason. Chosen: of comments above findings that readers called meant."""

_LONGEST = 2000
"""Bytes of a comment that are read. Chosen, no source."""


def is_explained(problem: Problem) -> bool:
    """Tell whether a comment directly above an element that a problem is about gives a reason.

    The elements are that of its place, and its subject: a link or a joint.
    """
    for data, start in _list_starts(problem):
        comment = _COMMENT.search(data, max(0, start - _LONGEST), start)
        if comment is not None and _REASON.search(comment[1]):
            return True
    return False


def _list_starts(problem: Problem) -> Iterator[tuple[bytes, int]]:
    """Yield the bytes of the files, and the first byte of each element."""
    place = problem.place
    yield place.file.data, place.file.data.rfind(b"<", 0, place.start + 1)
    subject = problem.subject
    element = subject if isinstance(subject, Element) else subject.xml
    if isinstance(element, Element):
        yield element.file.data, element.start


_OF_TESTS = frozenset(("test", "tests", "test_data", "testdata"))
"""Names of folders with inputs of tests."""


def is_input_of_test(rule: Rule, finding: Finding) -> bool:
    """Tell whether a remark is about values of an input of a test, which are made for it.

    The path is as the user named it, so that folders above a repository do not count.
    """
    if finding.severity is Severity.ERROR:
        return False
    if not rule.of_motion and rule.family not in ("inertia", "joint", "collision"):
        return False
    path = PurePath(finding.location.path)
    return not path.is_absolute() and not _OF_TESTS.isdisjoint(path.parts[:-1])
