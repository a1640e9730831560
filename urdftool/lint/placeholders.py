"""Descriptions that are templates: a program replaces words in capitals before they are read."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..errors import SourceError, UrdftoolError
from ..listing import quote_first
from ..model.urdf_schema import VOCABULARY
from ..source.document import Document, Element

_WORD = re.compile(r"(?!INF|NAN)[A-Z][A-Z0-9_]{2,}|__[A-Z][A-Z0-9_]*__")
"""A word that a program replaces by a number."""

_NUMBERS = frozenset(name for kind in VOCABULARY.values() for name in kind.numbers)
"""Attributes of URDF that are numbers."""

FEWEST = 2
"""Placeholders in numbers from which a file is a template. Chosen, so that a slip is none."""

_NAMES = 3
"""Number of words that a message names. Chosen, no source."""


def refuse_template(document: Document) -> None:
    """Check that numbers of a description are not words that a program replaces, such as ``MASS``.

    Raises:
        SourceError: At least ``FEWEST`` words in capitals are in place of numbers.
    """
    words: dict[str, Element] = {}
    for element in document.elements:
        for name, text in element.attributes.items():
            if name in _NUMBERS and text.isupper() and _WORD.fullmatch(text.strip()):
                words.setdefault(text.strip(), element)
    if len(words) >= FEWEST:
        at = next(iter(words.values())).place
        raise SourceError(_describe_template(list(words)), at=at, rule="not-a-number")


def find_template_error(error: UrdftoolError) -> UrdftoolError:
    """Return the error of a template instead of one of a file that a program has yet to name."""
    word = error.data.get("placeholder")
    if word is None:
        return error
    return SourceError(_describe_template([word]), at=error.at)


def _describe_template(words: Sequence[str]) -> str:
    shown = quote_first(words, _NAMES)
    return (
        f"a template, in which a program replaces {shown}; lint what it writes, and name the "
        "template in lint.exclude"
    )
