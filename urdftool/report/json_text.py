"""Results as JSON."""

from __future__ import annotations

import json
import re

_SPECIAL = re.compile("[^ -~\n]")


def json_text(value: object, indent: int | None = None) -> str:
    """Write a value as JSON in which every control character is escaped.

    JSON itself escapes those below U+0020 alone; a terminal obeys those of U+0080 to U+009F and
    those that turn the direction of text too.
    """
    text = json.dumps(value, indent=indent, ensure_ascii=False)
    return _SPECIAL.sub(_escaped, text)


def _escaped(match: re.Match[str]) -> str:
    character = match[0]
    return character if character.isprintable() else json.dumps(character)[1:-1]
