"""Descriptions that are templates: a program replaces words in capitals before they are read."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..source.document import Element

_WORD = re.compile(r"(?!INF|NAN)[A-Z][A-Z0-9_]{2,}|__[A-Z][A-Z0-9_]*__")
"""A word that a program replaces by a number."""

_NUMBERS = frozenset(
    (
        *("value", "xyz", "rpy", "rgba", "size", "radius", "length", "scale", "lower", "upper"),
        *("effort", "velocity", "ixx", "ixy", "ixz", "iyy", "iyz", "izz", "multiplier", "offset"),
    )
)
"""Attributes of URDF that are numbers."""

FEWEST = 2
"""Placeholders in numbers from which a file is a template. Chosen, so that a slip is none."""

_NAMES = 3
"""Number of words that a message names. Chosen, no source."""


def find_placeholders(root: Element) -> list[str]:
    """Find the words in capitals that are in place of numbers, such as ``MASS``, each once."""
    words = {
        text.strip(): None
        for element in root.walk()
        for name, text in element.attributes.items()
        if name in _NUMBERS and _WORD.fullmatch(text.strip())
    }
    return list(words)


def describe_template(words: Sequence[str]) -> str:
    """Describe a file that is not checked, because a program has to replace words in it."""
    shown = ", ".join(f"'{word}'" for word in words[:_NAMES])
    more = f" and {len(words) - _NAMES} more" if len(words) > _NAMES else ""
    return f"a template, in which a program replaces {shown}{more}; lint what it writes"
